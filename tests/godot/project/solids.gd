extends RefCounted
## The same solid made of every collider that Godot has. Each has its own middle or top at the node's origin.

## Of a plate, m.
const SIDE_M: float = 0.4
const TILE_M: float = 0.04
const BALL_RADIUS_M: float = 0.06

const PLATES: PackedStringArray = [
	"box", "cylinder", "hull", "trimesh 5", "trimesh 25", "trimesh 100", "two-sided 25", "height map", "csg", "tiles",
	"boundary", "server"
]
const BALLS: PackedStringArray = ["sphere", "hull", "trimesh", "two-sided", "csg", "server"]


## A body of the physics server alone, behind a node that places and frees it.
class ServerBody:
	extends Node3D
	var shape: Shape3D
	var at: Transform3D
	var body: RID

	func _enter_tree() -> void:
		body = PhysicsServer3D.body_create()
		PhysicsServer3D.body_set_mode(body, PhysicsServer3D.BODY_MODE_STATIC)
		PhysicsServer3D.body_add_shape(body, shape.get_rid(), at)
		PhysicsServer3D.body_set_space(body, get_world_3d().space)
		PhysicsServer3D.body_set_state(body, PhysicsServer3D.BODY_STATE_TRANSFORM, global_transform)

	func _exit_tree() -> void:
		PhysicsServer3D.free_rid(body)


static func static_body(shape: Shape3D, at: Transform3D = Transform3D.IDENTITY) -> StaticBody3D:
	var body := StaticBody3D.new()
	add_shape(body, shape, at)
	return body


static func add_shape(body: CollisionObject3D, shape: Shape3D, at: Transform3D = Transform3D.IDENTITY) -> void:
	var holder := CollisionShape3D.new()
	holder.shape = shape
	holder.transform = at
	body.add_child(holder)


static func server_body(shape: Shape3D, at: Transform3D) -> Node3D:
	var node := ServerBody.new()
	node.shape = shape
	node.at = at
	return node


static func box(size: Vector3) -> BoxShape3D:
	var shape := BoxShape3D.new()
	shape.size = size
	return shape


static func hull(points: PackedVector3Array) -> ConvexPolygonShape3D:
	var shape := ConvexPolygonShape3D.new()
	shape.points = points
	return shape


static func faces(mesh: Mesh, two_sided: bool = false) -> ConcavePolygonShape3D:
	var shape: ConcavePolygonShape3D = mesh.create_trimesh_shape()
	shape.backface_collision = two_sided
	return shape


static func box_mesh(size: Vector3) -> BoxMesh:
	var mesh := BoxMesh.new()
	mesh.size = size
	return mesh


static func flat(triangle_mm: int) -> PlaneMesh:
	var mesh := PlaneMesh.new()
	mesh.size = Vector2(SIDE_M, SIDE_M)
	mesh.subdivide_width = maxi(0, roundi(1e3 * SIDE_M / triangle_mm) - 1)
	mesh.subdivide_depth = mesh.subdivide_width
	return mesh


static func height_map(cell_m: float) -> Node3D:
	var shape := HeightMapShape3D.new()
	shape.map_width = roundi(SIDE_M / cell_m) + 1
	shape.map_depth = shape.map_width
	return static_body(shape, Transform3D(Basis.from_scale(Vector3.ONE * cell_m), Vector3.ZERO))


static func tiles(tile: Vector3, count: int, top_at: float) -> GridMap:
	var library := MeshLibrary.new()
	library.create_item(0)
	library.set_item_shapes(0, [box(tile), Transform3D(Basis.IDENTITY, Vector3(0.0, top_at - 0.5 * tile.y, 0.0))])
	var grid := GridMap.new()
	grid.mesh_library = library
	grid.cell_size = tile
	grid.cell_center_x = false
	grid.cell_center_y = false
	grid.cell_center_z = false
	for x: int in count:
		for z: int in count:
			grid.set_cell_item(Vector3i(x - count / 2, 0, z - count / 2), 0)
	return grid


## A plate whose top is the node's plane y = 0.
static func plate(kind: String, thickness_m: float = 0.1) -> Node3D:
	var size := Vector3(SIDE_M, thickness_m, SIDE_M)
	var down := Transform3D(Basis.IDENTITY, Vector3(0.0, -0.5 * thickness_m, 0.0))
	match kind:
		"box":
			return static_body(box(size), down)
		"cylinder":
			var shape := CylinderShape3D.new()
			shape.radius = 0.5 * SIDE_M
			shape.height = thickness_m
			return static_body(shape, down)
		"hull":
			return static_body(hull(box_mesh(size).get_faces()), down)
		"two-sided 25":
			return static_body(faces(flat(25), true))
		"height map":
			return height_map(0.02)
		"csg":
			var csg := CSGBox3D.new()
			csg.size = size
			csg.position = down.origin
			csg.use_collision = true
			var holder := Node3D.new()
			holder.add_child(csg)
			return holder
		"tiles":
			return tiles(Vector3(TILE_M, thickness_m, TILE_M), roundi(SIDE_M / TILE_M), 0.0)
		"boundary":
			return static_body(WorldBoundaryShape3D.new())
		"server":
			return server_body(box(size), down)
	return static_body(faces(flat(kind.get_slice(" ", 1).to_int())))


static func ball_mesh(around: int = 80) -> SphereMesh:
	var mesh := SphereMesh.new()
	mesh.radius = BALL_RADIUS_M
	mesh.height = 2.0 * BALL_RADIUS_M
	mesh.radial_segments = around
	mesh.rings = around / 2
	return mesh


## A ball whose top is the node's origin.
static func ball(kind: String) -> Node3D:
	var down := Transform3D(Basis.IDENTITY, Vector3(0.0, -BALL_RADIUS_M, 0.0))
	match kind:
		"hull":
			return static_body(hull(ball_mesh().get_mesh_arrays()[Mesh.ARRAY_VERTEX]), down)
		"large hull":  # of 10,000 points
			return static_body(hull(ball_mesh(140).get_mesh_arrays()[Mesh.ARRAY_VERTEX]), down)
		"trimesh":
			return static_body(faces(ball_mesh()), down)
		"two-sided":
			return static_body(faces(ball_mesh(), true), down)
		"csg":
			var csg := CSGSphere3D.new()
			csg.radius = BALL_RADIUS_M
			csg.radial_segments = 80
			csg.rings = 40
			csg.position = down.origin
			csg.use_collision = true
			var holder := Node3D.new()
			holder.add_child(csg)
			return holder
	var sphere := SphereShape3D.new()
	sphere.radius = BALL_RADIUS_M
	return server_body(sphere, down) if kind == "server" else static_body(sphere, down)


## Mesh.create_trimesh_shape() moves every corner to the next tenth of a millimetre; here each stays.
static func exact_faces(mesh: Mesh, two_sided: bool = false) -> ConcavePolygonShape3D:
	var corners: PackedVector3Array = []
	var arrays: Array = mesh.surface_get_arrays(0)
	var points: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	for index: int in arrays[Mesh.ARRAY_INDEX] as PackedInt32Array:
		corners.append(points[index])
	var shape := ConcavePolygonShape3D.new()
	shape.set_faces(corners)
	shape.backface_collision = two_sided
	return shape


## A ring about the y axis. Kinds: "trimesh N", whose triangles' edges are about N mm long at the outer rim, "two-sided N",
## and "csg N".
static func torus(kind: String, middle_radius_m: float, tube_radius_m: float) -> Node3D:
	var around: int = edges_around(middle_radius_m + tube_radius_m, kind)
	var of_tube: int = edges_around(tube_radius_m, kind)
	if kind.begins_with("csg"):
		var csg := CSGTorus3D.new()
		csg.inner_radius = middle_radius_m - tube_radius_m
		csg.outer_radius = middle_radius_m + tube_radius_m
		csg.sides = around
		csg.ring_sides = of_tube
		csg.use_collision = true
		return csg
	var mesh := TorusMesh.new()
	mesh.inner_radius = middle_radius_m - tube_radius_m
	mesh.outer_radius = middle_radius_m + tube_radius_m
	mesh.rings = around
	mesh.ring_segments = of_tube
	return static_body(exact_faces(mesh, kind.begins_with("two-sided")))


## Edges of a circle; a multiple of four, so that a torus has corners on both rims.
static func edges_around(radius_m: float, kind: String) -> int:
	return maxi(8, 4 * roundi(0.25 * TAU * radius_m / (1e-3 * kind.get_slice(" ", 1).to_int())))
