extends "res://tasks/base/linking_task.gd"
## Nothing to achieve: one sample of everything that can be felt. Hard and soft blocks, a heavy and a light box of
## the same size, a rough and a smooth floor, a ball on a spring, a socket that snaps, and six blocks of air, one for each
## kind of force that the device gives by itself.

const DemoPalette := preload("res://scene/demo_palette.gd")
const FieldZone := preload("res://tasks/free_play/field_zone.gd")
const LinkSocket := preload("res://scene/link_socket.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")

const SPRING_N_M := 80.0
const SPRING_MOST_N := 4.0
const BOX_M := Vector3(0.032, 0.044, 0.032)
const FLOOR_M := Vector3(0.080, 0.006, 0.070)
## Text stands above the things at the back, and before the others.
const ABOVE_M := 0.016
const LOW_M := 0.006
const BEFORE_M := 0.014
## Rows from the back to the front.
const BACK_Z_M := -0.100
const ZONES_Z_M := -0.022
const FRONT_Z_M := 0.070
const ZONE_PITCH_M := 0.048
const ZONE_COLOURS: Array[Color] = [
	DemoPalette.MUSTARD, DemoPalette.CORAL, DemoPalette.PLUM, DemoPalette.SAGE, DemoPalette.BLUE, DemoPalette.TEAL
]

var zones: Array[FieldZone] = []

var _ball: TaskBody
var _ball_home := Vector3.ZERO


func _ready() -> void:
	super()
	_hud.show_free(title)
	tool_hand.carrying.connect(_on_carrying)


func _lay_out() -> void:
	linker.clear()
	_add_box("light, 40 g", -0.125, 0.040, DemoPalette.BLUE)
	_add_box("heavy, 300 g", -0.062, 0.300, DemoPalette.PLUM)
	var soft := _add_box("soft, 60 g", 0.0, 0.060, DemoPalette.CORAL)
	soft.set_meta(&"spidar_squeeze_nm_rad", 0.10)
	soft.set_meta(&"spidar_stiffness_n_m", 120.0)
	_add_ball(0.068)
	_add_post(0.125)
	_add_zones()
	_add_floor("rough floor", -0.085, 1.2, DemoPalette.MUSTARD)
	_add_floor("smooth floor", 0.005, 0.02, DemoPalette.TEAL)
	_add_peg(0.136)


func _add_box(
	text: String, x: float, mass_kg: float, colour: Color, z: float = BACK_Z_M
) -> TaskBody:
	var body := TaskBody.new()
	var shape := BoxShape3D.new()
	shape.size = BOX_M
	var mesh := BoxMesh.new()
	mesh.size = BOX_M
	body.mass = mass_kg
	body.width_m = BOX_M.x
	body.add_piece(shape, mesh, Transform3D.IDENTITY, colour)
	body.position = Vector3(x, 0.5 * BOX_M.y, z)
	_items.add_child(body)
	_say(text, Vector3(x, BOX_M.y + ABOVE_M, z) if z == BACK_Z_M else Vector3(x, LOW_M, z + 0.5 * BOX_M.z + BEFORE_M))
	return body


## Held, it pulls back to where it was.
func _add_ball(x: float) -> void:
	_ball = TaskBody.new()
	var shape := SphereShape3D.new()
	shape.radius = 0.018
	var mesh := SphereMesh.new()
	mesh.radius = shape.radius
	mesh.height = 2.0 * shape.radius
	_ball.mass = 0.05
	_ball.add_piece(shape, mesh, Transform3D.IDENTITY, DemoPalette.SAGE)
	_ball.position = Vector3(x, shape.radius, BACK_Z_M)
	_items.add_child(_ball)
	_ball_home = _ball.global_position
	_say("on a spring", Vector3(x, 2.0 * shape.radius + ABOVE_M, BACK_Z_M))


func _add_post(x: float) -> void:
	var post := StaticBody3D.new()
	post.position = Vector3(x, 0.0, BACK_Z_M)
	StandBuilder.add_block(
		post, Vector3(0.020, 0.060, 0.020), Vector3(0.0, 0.030, 0.0), DemoPalette.STAND
	)
	_items.add_child(post)
	_say("fixed post", Vector3(x, 0.060 + ABOVE_M, BACK_Z_M))


func _add_zones() -> void:
	zones.clear()
	for index in FieldZone.Kind.size():
		var x := (index - 0.5 * (FieldZone.Kind.size() - 1)) * ZONE_PITCH_M
		var zone := FieldZone.make(index as FieldZone.Kind, ZONE_COLOURS[index])
		zone.position = Vector3(x, 0.5 * FieldZone.SIZE_M.y + 0.001, ZONES_Z_M)
		_items.add_child(zone)
		zones.append(zone)
		_say(FieldZone.TEXTS[index], Vector3(x, LOW_M, ZONES_Z_M + 0.5 * FieldZone.SIZE_M.z + BEFORE_M))


func _physics_process(delta: float) -> void:
	super(delta)
	for zone in zones:
		zone.act(spidar, tool_hand.get_held_body() != null)


func _add_floor(text: String, x: float, friction: float, colour: Color) -> void:
	var floor_body := StaticBody3D.new()
	floor_body.position = Vector3(x, 0.0, FRONT_Z_M)
	floor_body.set_meta(&"spidar_friction", friction)
	StandBuilder.add_block(floor_body, FLOOR_M, Vector3(0.0, 0.5 * FLOOR_M.y, 0.0), colour)
	_items.add_child(floor_body)
	_say(text, Vector3(x, LOW_M, FRONT_Z_M + 0.5 * FLOOR_M.z + BEFORE_M))


## A peg and a cap that snaps onto it.
func _add_peg(x: float) -> void:
	var peg := StaticBody3D.new()
	peg.position = Vector3(x, 0.0, FRONT_Z_M - 0.020)
	StandBuilder.add_block(
		peg, Vector3(0.014, 0.030, 0.014), Vector3(0.0, 0.015, 0.0), DemoPalette.STAND
	)
	peg.add_child(LinkSocket.make(&"cap", false, Transform3D(Basis(), Vector3(0.0, 0.030, 0.0))))
	_items.add_child(peg)
	linker.add_carrier(peg)
	var cap := _add_box("snaps onto the peg", x, 0.060, DemoPalette.BONE, FRONT_Z_M + 0.030)
	cap.add_child(
		LinkSocket.make(&"cap", true, Transform3D(Basis(), Vector3(0.0, -0.5 * BOX_M.y - 0.0005, 0.0)))
	)
	linker.add_carrier(cap)


func _on_carrying(_delta: float) -> void:
	if tool_hand.get_held_body() != _ball:
		return
	var way := (_ball_home - tool_hand.get_wanted_pose().origin) / spidar.workspace_scale
	tool_hand.add_load((SPRING_N_M * way).limit_length(SPRING_MOST_N))


func _say(text: String, at: Vector3) -> void:
	var label := Label3D.new()
	label.text = text
	label.billboard = BaseMaterial3D.BILLBOARD_ENABLED
	label.position = at
	label.pixel_size = 0.0002
	label.font_size = 44
	label.outline_size = 8
	label.outline_modulate = DemoPalette.STAND
	label.modulate = DemoPalette.TEXT
	_items.add_child(label)
