extends RefCounted
## Small fixed stands: a ring that keeps a ball from rolling, a rack that carries a stick.

const DemoPalette := preload("res://scene/demo_palette.gd")
const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")

const RING_HEIGHT_M := 0.024
const RING_INNER_M := 0.016
const RING_OUTER_M := 0.022
const RING_SEGMENTS := 12
const RACK_HEIGHT_M := 0.038
const RACK_POST_M := Vector3(0.030, RACK_HEIGHT_M, 0.006)
const RACK_POST_Z_M := 0.024
const RACK_CHEEK_M := Vector3(0.004, 0.006, 0.006)
## Free width between the cheeks beside the stick, each side.
const RACK_PLAY_M := 0.004


## Centre height of a ball of this radius lying on the ring.
static func ring_rest_height_m(radius_m: float) -> float:
	var apothem := RING_INNER_M
	return RING_HEIGHT_M + sqrt(radius_m * radius_m - apothem * apothem)


## A static body for the spec's stand, origin on the table; null where it needs none.
static func build(spec: ObjectSpec, colour: Color) -> StaticBody3D:
	if spec.stand == ObjectSpec.Stand.TABLE:
		return null
	var body := StaticBody3D.new()
	if spec.stand == ObjectSpec.Stand.RING:
		_add_ring(body)
	else:
		_add_rack(body, spec.size_m.x)
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.roughness = 0.8
	for child in body.get_children():
		if child is MeshInstance3D:
			(child as MeshInstance3D).material_override = material
	return body


static func _add_ring(body: StaticBody3D) -> void:
	var thickness := RING_OUTER_M - RING_INNER_M
	var middle := (RING_OUTER_M + RING_INNER_M) * 0.5
	var length := 2.0 * RING_OUTER_M * tan(PI / RING_SEGMENTS)
	for segment in RING_SEGMENTS:
		var basis := Basis(Vector3.UP, TAU * segment / RING_SEGMENTS)
		var at := Transform3D(basis, basis * Vector3(middle, RING_HEIGHT_M * 0.5, 0.0))
		_add_shape(body, Vector3(thickness, RING_HEIGHT_M, length), at)
	var visible_ring := CylinderMesh.new()
	visible_ring.top_radius = RING_OUTER_M
	visible_ring.bottom_radius = RING_OUTER_M + 0.001
	visible_ring.height = RING_HEIGHT_M
	visible_ring.rings = 0
	_add_mesh(body, visible_ring, Transform3D(Basis(), Vector3(0, RING_HEIGHT_M * 0.5, 0)))


static func _add_rack(body: StaticBody3D, stick_width_m: float) -> void:
	var cheek_x := stick_width_m * 0.5 + RACK_PLAY_M + RACK_CHEEK_M.x * 0.5
	for side: float in [-1.0, 1.0]:
		var post := Transform3D(Basis(), Vector3(0, RACK_HEIGHT_M * 0.5, side * RACK_POST_Z_M))
		_add_block(body, RACK_POST_M, post)
		for cheek: float in [-1.0, 1.0]:
			var at := Vector3(
				cheek * cheek_x, RACK_HEIGHT_M + RACK_CHEEK_M.y * 0.5, side * RACK_POST_Z_M
			)
			_add_block(body, RACK_CHEEK_M, Transform3D(Basis(), at))


static func _add_block(body: StaticBody3D, size: Vector3, at: Transform3D) -> void:
	add_block(body, size, at.origin, DemoPalette.STAND)


## A solid box with its mesh.
static func add_block(body: StaticBody3D, size: Vector3, at: Vector3, colour: Color) -> void:
	var placed := Transform3D(Basis(), at)
	_add_shape(body, size, placed)
	var box := BoxMesh.new()
	box.size = size
	box.material = DemoPalette.matte(colour)
	_add_mesh(body, box, placed)


static func _add_shape(body: StaticBody3D, size: Vector3, at: Transform3D) -> void:
	var box := BoxShape3D.new()
	box.size = size
	var collision := CollisionShape3D.new()
	collision.shape = box
	collision.transform = at
	body.add_child(collision)


static func _add_mesh(body: StaticBody3D, mesh: Mesh, at: Transform3D) -> void:
	var instance := MeshInstance3D.new()
	instance.mesh = mesh
	instance.transform = at
	body.add_child(instance)
