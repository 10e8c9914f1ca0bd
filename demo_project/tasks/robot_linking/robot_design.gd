extends RefCounted
## The robot: what its parts look like, where their sockets are and where each belongs. Metres, kilograms; the robot's
## frame has its origin on the table, y up and the front at +z. Plugs sit on the limbs, cups on what carries them.

const DemoPalette := preload("res://scene/demo_palette.gd")
const FeltRecord := preload("res://scene/felt_record.gd")
const LinkSocket := preload("res://scene/link_socket.gd")
const RobotPart := preload("res://tasks/robot_linking/robot_part.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")

const TORSO_M := Vector3(0.044, 0.048, 0.026)
const TORSO_Y_M := 0.0825
const LEG_M := Vector3(0.014, 0.044, 0.016)
const LEG_X_M := 0.0205
const ARM_M := Vector3(0.014, 0.048, 0.016)
const HEAD_M := Vector3(0.034, 0.030, 0.030)
## A stud between torso and arm leaves room for the fingers.
const STUD_M := 0.016
const STUD_RADIUS_M := 0.004
const NECK_M := 0.005
## Over the torso's middle.
const SHOULDER_Y_M := 0.016
## Linked faces do not quite touch.
const GAP_M := 0.0005
## From the front: the fingers stay clear of what they pass.
const FROM_FRONT_M := Vector3(0.0, 0.0, 0.036)
const POST_M := Vector3(0.010, 0.096, 0.010)
const POST_Z_M := -0.036
const BASE_M := Vector3(0.110, 0.005, 0.050)


## Everything but the torso, in no special order.
static func limbs() -> Array[RobotPart]:
	return [
		_head(), _arm("left_arm", -1.0), _arm("right_arm", 1.0), _leg("left_leg", -1.0),
		_leg("right_leg", 1.0),
	]


static func torso() -> RobotPart:
	var part := _part("torso", TORSO_M, 0.120, DemoPalette.BLUE)
	part.place.origin = Vector3(0.0, TORSO_Y_M, 0.0)
	part.grasp_offset_m = Vector3(0.0, -0.004, 0.0)
	part.approach_m = FROM_FRONT_M
	var stud := _cylinder(STUD_RADIUS_M, STUD_M)
	var stud_mesh := _cylinder_mesh(STUD_RADIUS_M, STUD_M)
	for side: float in [-1.0, 1.0]:
		var middle := Vector3(side * 0.5 * (TORSO_M.x + STUD_M), SHOULDER_Y_M, 0.0)
		part.add_piece(
			stud, stud_mesh, Transform3D(Basis(Vector3.BACK, 0.5 * PI), middle), DemoPalette.BONE
		)
		part.add_child(_cup(
			&"left_shoulder" if side < 0.0 else &"right_shoulder",
			Vector3(side * (0.5 * TORSO_M.x + STUD_M), SHOULDER_Y_M, 0.0)
		))
		part.add_child(_cup(
			&"left_hip" if side < 0.0 else &"right_hip", Vector3(side * LEG_X_M, -0.5 * TORSO_M.y, 0.0)
		))
	part.add_piece(
		_cylinder(STUD_RADIUS_M, NECK_M), _cylinder_mesh(STUD_RADIUS_M + 0.002, NECK_M),
		Transform3D(Basis(), Vector3(0.0, 0.5 * (TORSO_M.y + NECK_M), 0.0)), DemoPalette.BONE
	)
	part.add_child(_cup(&"neck", Vector3(0.0, 0.5 * TORSO_M.y + NECK_M, 0.0)))
	part.add_child(LinkSocket.make(&"back", true, _at(0.0, 0.0, -0.5 * TORSO_M.z - GAP_M)))
	_decorate(part, Vector3(0.020, 0.012, 0.0012), Vector3(0.0, 0.006, 0.5 * TORSO_M.z), DemoPalette.ACCENT)
	return part


## The stand: a base, a post, and a cup that carries the torso by its back. One convex body each.
static func build_stand(parent: Node3D) -> StaticBody3D:
	_add_block(parent, BASE_M, Vector3(0.0, 0.5 * BASE_M.y, POST_Z_M))
	_add_block(parent, POST_M, Vector3(0.0, 0.5 * POST_M.y, POST_Z_M))
	var depth := -0.5 * TORSO_M.z - GAP_M - (POST_Z_M + 0.5 * POST_M.z)
	var bracket := _add_block(
		parent, Vector3(0.012, 0.012, depth),
		Vector3(0.0, TORSO_Y_M, POST_Z_M + 0.5 * (POST_M.z + depth))
	)
	bracket.add_child(LinkSocket.make(&"back", false, _at(0.0, 0.0, 0.5 * depth)))
	return bracket


static func _head() -> RobotPart:
	var part := _part("head", HEAD_M, 0.080, DemoPalette.MUSTARD)
	var neck_top := TORSO_Y_M + 0.5 * TORSO_M.y + NECK_M
	part.place.origin = Vector3(0.0, neck_top + GAP_M + 0.5 * HEAD_M.y, 0.0)
	part.travel_m = 0.185
	part.add_child(LinkSocket.make(&"neck", true, _at(0.0, -0.5 * HEAD_M.y - GAP_M, 0.0)))
	for side: float in [-1.0, 1.0]:
		_decorate(
			part, Vector3(0.007, 0.007, 0.0012), Vector3(side * 0.008, 0.004, 0.5 * HEAD_M.z),
			DemoPalette.STAND
		)
	return part


static func _arm(label: String, side: float) -> RobotPart:
	var part := _part(label, ARM_M, 0.060, DemoPalette.CORAL)
	var x := 0.5 * TORSO_M.x + STUD_M + GAP_M + 0.5 * ARM_M.x
	part.place.origin = Vector3(side * x, TORSO_Y_M, 0.0)
	part.grasp_offset_m = Vector3(0.0, -0.006, 0.0)
	part.approach_m = FROM_FRONT_M
	part.add_child(LinkSocket.make(
		&"left_shoulder" if side < 0.0 else &"right_shoulder", true,
		_at(-side * (0.5 * ARM_M.x + GAP_M), SHOULDER_Y_M, 0.0)
	))
	return part


static func _leg(label: String, side: float) -> RobotPart:
	var part := _part(label, LEG_M, 0.070, DemoPalette.TEAL)
	part.place.origin = Vector3(
		side * LEG_X_M, TORSO_Y_M - 0.5 * TORSO_M.y - GAP_M - 0.5 * LEG_M.y, 0.0
	)
	part.grasp_offset_m = Vector3(0.0, -0.006, 0.0)
	part.approach_m = FROM_FRONT_M
	part.add_child(LinkSocket.make(
		&"left_hip" if side < 0.0 else &"right_hip", true, _at(0.0, 0.5 * LEG_M.y + GAP_M, 0.0)
	))
	_decorate(part, Vector3(0.016, 0.008, 0.020), Vector3(0.0, 0.004 - 0.5 * LEG_M.y, 0.0015), DemoPalette.BONE)
	return part


static func _part(label: String, size: Vector3, mass_kg: float, colour: Color) -> RobotPart:
	var part := RobotPart.new()
	part.label = label
	part.kind = label.get_slice("_", label.get_slice_count("_") - 1)
	part.name = label.to_pascal_case()
	part.mass = mass_kg
	part.width_m = size.x
	var shape := BoxShape3D.new()
	shape.size = size
	var mesh := BoxMesh.new()
	mesh.size = size
	part.add_piece(shape, mesh, Transform3D.IDENTITY, colour)
	part.felt.checks_detent = true
	if size.x <= ARM_M.x:
		part.felt.detent_tolerance = FeltRecord.DETENT_TOLERANCE_THIN
	return part


static func _decorate(part: RobotPart, size: Vector3, at: Vector3, colour: Color) -> void:
	var mesh := BoxMesh.new()
	mesh.size = size
	part.add_piece(null, mesh, Transform3D(Basis(), at), colour)


static func _add_block(parent: Node3D, size: Vector3, at: Vector3) -> StaticBody3D:
	var body := StaticBody3D.new()
	body.position = at
	parent.add_child(body)
	StandBuilder.add_block(body, size, Vector3.ZERO, DemoPalette.STAND)
	return body


static func _cup(key: StringName, at: Vector3) -> LinkSocket:
	return LinkSocket.make(key, false, Transform3D(Basis(), at))


static func _at(x: float, y: float, z: float) -> Transform3D:
	return Transform3D(Basis(), Vector3(x, y, z))


static func _cylinder(radius: float, height: float) -> CylinderShape3D:
	var shape := CylinderShape3D.new()
	shape.radius = radius
	shape.height = height
	return shape


static func _cylinder_mesh(radius: float, height: float) -> CylinderMesh:
	var mesh := CylinderMesh.new()
	mesh.top_radius = radius
	mesh.bottom_radius = radius
	mesh.height = height
	mesh.rings = 0
	return mesh
