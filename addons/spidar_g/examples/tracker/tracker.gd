extends Node3D
## Uses an XR controller alone: the aim is shown on the wall, the grip shrinks the ball, and the trigger changes its color.

@onready var _controller: XRController3D = $XROrigin3D/XRController3D
@onready var _aim: XRController3D = $XROrigin3D/Aim
@onready var _ball: MeshInstance3D = $Ball
@onready var _dot: MeshInstance3D = $Dot


func _ready() -> void:
	_controller.input_float_changed.connect(_on_float_changed)
	_controller.button_pressed.connect(func(input: String) -> void: $Label3D.text = "%s pressed" % input)
	_controller.button_released.connect(func(input: String) -> void: $Label3D.text = "%s released" % input)


func _on_float_changed(input: String, value: float) -> void:
	if input == "grip":
		_ball.scale = Vector3.ONE * lerpf(1.0, 0.6, value)
	elif input == "trigger":
		(_ball.mesh.surface_get_material(0) as StandardMaterial3D).albedo_color = Color.STEEL_BLUE.lerp(Color.TOMATO, value)


func _process(_delta: float) -> void:
	var wall := Plane(Vector3.BACK, $Wall.position + Vector3(0.0, 0.0, 0.011))
	var hit: Variant = wall.intersects_ray(_aim.global_position, -_aim.global_basis.z)
	_dot.visible = _controller.get_is_active() and hit != null
	if _dot.visible:
		_dot.position = hit
