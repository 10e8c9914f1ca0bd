## Draws what SpidarGHand.debug_draw shows, and saves it: -s hand_picture.gd -- SCENE FILE [WORKSPACE_SCALE]. SCENE: a pad
## on a box ("pad"), a held bar on an edge ("bar"), the pads on a wavy mesh ("wave"). Needs a display; with --fixed-fps 60
## it is ready sooner. The picture of docs/why/contact_engine.md is made so.
extends SceneTree

const Solids := preload("res://solids.gd")
const FLOOR_Y: float = -0.08
const SQUEEZE_ANGLE: float = 1.4
const ARMING_FRAMES: int = 70

var device := SpidarG.new()
var hand := SpidarGHand.new()
var stage := Node3D.new()
var camera := Camera3D.new()
var at := Vector3.ZERO
var turn := Basis.IDENTITY
var angle: float = 0.0


func _initialize() -> void:
	_run()


func _run() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() < 2 or not arguments[0] in ["pad", "bar", "wave"]:
		push_error("hand_picture.gd: give pad, bar or wave, and one file to save.")
		quit(2)
		return
	var scale: float = arguments[2].to_float() if arguments.size() > 2 else 1.0
	device.config = SpidarGConfig.new()
	device.config.simulated_hand_firmness = SpidarG.HAND_NORMAL
	device.drive_mode = SpidarG.DRIVE_STEPPED
	device.forces_enabled = true
	device.workspace_scale = scale
	hand.debug_draw = true
	device.add_child(hand)
	root.add_child(device)
	stage.scale = Vector3.ONE * scale
	root.add_child(stage)
	_light()
	match arguments[0]:
		"pad":
			await _press_a_pad()
		"bar":
			await _lean_a_bar()
		"wave":
			await _lie_on_a_wave()
	await RenderingServer.frame_post_draw
	var error: Error = root.get_texture().get_image().save_png(arguments[1])
	quit(0 if error == OK else 1)


func _press_a_pad() -> void:
	_add_box(Vector3(0.3, 0.02, 0.3), Vector3(0.0, FLOOR_Y - 0.01, 0.0))
	_add_box(Vector3(0.06, 0.05, 0.06), Vector3(0.08, FLOOR_Y + 0.025, 0.0))
	_look(Vector3(-0.06, 0.04, 0.17), Vector3(0.03, FLOOR_Y + 0.02, 0.0))
	await _move(Vector3.ZERO, 10)
	await _frames(ARMING_FRAMES)
	await _move(Vector3(0.025, FLOOR_Y + 0.025, 0.0), 60)
	await _move(at + Vector3(0.0, 0.008, 0.0), 10)
	await _frames(60)


func _lean_a_bar() -> void:
	_add_box(Vector3(0.3, 0.02, 0.3), Vector3(0.0, FLOOR_Y - 0.01, 0.0))
	_add_box(Vector3(0.08, 0.025, 0.05), Vector3(0.0, FLOOR_Y + 0.0125, 0.08))
	_look(Vector3(0.15, 0.03, 0.17), Vector3(0.0, FLOOR_Y + 0.025, 0.03))
	var bar := RigidBody3D.new()
	bar.mass = 0.05
	bar.gravity_scale = 0.0 # it waits in the air for the fingers
	var size := Vector3(0.025, 0.02, 0.14)
	Solids.add_shape(bar, Solids.box(size))
	bar.add_child(_mesh(Solids.box_mesh(size), Color(0.55, 0.4, 0.3)))
	bar.position = Vector3(0.0, FLOOR_Y + 0.04, 0.02)
	stage.add_child(bar)
	await _move(Vector3(0.0, FLOOR_Y + 0.04, -0.02), 40)
	await _frames(ARMING_FRAMES)
	await _move(at, 60, turn, SQUEEZE_ANGLE)
	await _frames(40)
	await _move(at, 40, Basis(Vector3.RIGHT, 0.15), SQUEEZE_ANGLE)
	await _move(at + Vector3(0.0, -0.03, 0.0), 40, turn, SQUEEZE_ANGLE)
	await _frames(40)


func _lie_on_a_wave() -> void:
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	var count: int = 50
	var cell: float = 0.3 / count
	for x: int in count:
		for z: int in count:
			for corner: Vector2i in [
				Vector2i(0, 0), Vector2i(1, 0), Vector2i(1, 1), Vector2i(0, 0), Vector2i(1, 1), Vector2i(0, 1)
			]:
				var place: Vector2 = cell * Vector2(x + corner.x, z + corner.y) - Vector2(0.15, 0.15)
				var height: float = 0.012 * sin(60.0 * place.x) * cos(50.0 * place.y)
				tool.add_vertex(Vector3(place.x, FLOOR_Y + height, place.y))
	tool.generate_normals()
	var mesh: ArrayMesh = tool.commit()
	var body: StaticBody3D = Solids.static_body(Solids.faces(mesh))
	body.add_child(_mesh(mesh, Color(0.45, 0.5, 0.45)))
	stage.add_child(body)
	_look(Vector3(0.08, 0.02, 0.15), Vector3(0.02, FLOOR_Y + 0.01, 0.0))
	await _move(Vector3.ZERO, 10)
	await _frames(ARMING_FRAMES)
	await _move(Vector3(0.02, FLOOR_Y - 0.01, 0.01), 60)
	await _frames(60)


func _add_box(size: Vector3, middle: Vector3) -> void:
	var body: StaticBody3D = Solids.static_body(Solids.box(size))
	body.add_child(_mesh(Solids.box_mesh(size), Color(0.45, 0.45, 0.5)))
	body.position = middle
	stage.add_child(body)


func _mesh(mesh: Mesh, color: Color) -> MeshInstance3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = color
	var instance := MeshInstance3D.new()
	instance.mesh = mesh
	instance.material_override = material
	return instance


func _look(from: Vector3, to: Vector3) -> void:
	camera.look_at_from_position(device.workspace_scale * from, device.workspace_scale * to)


func _light() -> void:
	camera.near = 0.01
	camera.fov = 40.0
	root.add_child(camera)
	var sun := DirectionalLight3D.new()
	root.add_child(sun)
	sun.look_at_from_position(Vector3(0.4, 1.0, 0.5), Vector3.ZERO)
	var sky := WorldEnvironment.new()
	sky.environment = Environment.new()
	sky.environment.background_mode = Environment.BG_COLOR
	sky.environment.background_color = Color(0.16, 0.17, 0.2)
	sky.environment.ambient_light_source = Environment.AMBIENT_SOURCE_COLOR
	sky.environment.ambient_light_color = Color(0.5, 0.5, 0.55)
	root.add_child(sky)


func _move(to: Vector3, count: int, to_turn: Basis = Basis.IDENTITY, to_angle: float = 0.0) -> void:
	var from: Vector3 = at
	var from_turn: Basis = turn
	var from_angle: float = angle
	for i: int in count:
		var part: float = float(i + 1) / count
		at = from.lerp(to, part)
		turn = from_turn.slerp(to_turn, part)
		angle = lerpf(from_angle, to_angle, part)
		device.set_simulated_hand_target(Transform3D(turn, device.workspace_scale * at), angle)
		await physics_frame


func _frames(count: int) -> void:
	for _i: int in count:
		await physics_frame
