## SpidarGZone: what is inside of which shape, against the physics server's own answer.
extends "res://test_case.gd"

const Zone := preload("res://addons/spidar_g/nodes/spidar_g_zone.gd")
## Nearer to a surface than this the two may differ, m: physics rounds the edges of shapes.
const MARGIN_M: float = 0.006


func test_inside_is_where_physics_says_so() -> void:
	var random := RandomNumberGenerator.new()
	random.seed = 7
	for shape: Shape3D in _shapes():
		for scale: float in [1.0, 1.7]:
			var zone := Zone.new()
			var holder := CollisionShape3D.new()
			holder.shape = shape
			holder.transform = Transform3D(Basis.from_euler(Vector3(0.3, 0.5, -0.2)), Vector3(0.02, -0.01, 0.03))
			zone.add_child(holder)
			zone.transform = Transform3D(Basis.from_euler(Vector3(-0.4, 0.1, 0.6)).scaled(Vector3.ONE * scale), Vector3(0.1, 0.2, 0.3))
			add(zone)
			await physics_frames(3)
			var inside: int = 0
			var differing: int = 0
			for _i: int in 300:
				var point: Vector3 = zone.position + Vector3(random.randfn(), random.randfn(), random.randfn()) * 0.05 * scale
				var depth: float = zone.get_depth(point)
				inside += int(depth > 0.0)
				if absf(depth) > MARGIN_M:
					differing += int((depth > 0.0) != _physics_says(zone, point))
			check(inside > 10 and inside < 290, "%s: %d of 300 points inside" % [shape.get_class(), inside])
			check_equal(differing, 0, "%s, scale %s: as physics says" % [shape.get_class(), scale])
			zone.free()


func test_depth_is_the_distance_to_the_surface() -> void:
	var zone := Zone.new()
	var holder := CollisionShape3D.new()
	zone.add_child(holder)
	add(zone)
	check_equal(zone.get_depth(Vector3.ZERO), -INF, "no shape")
	for told: Array in [
		[_box(Vector3(0.2, 0.4, 0.6)), Vector3(0.09, 0, 0), 0.01], [_box(Vector3(0.2, 0.4, 0.6)), Vector3(0.13, 0.24, 0), -0.05],
		[_sphere(0.1), Vector3(0, 0.06, 0), 0.04], [_capsule(0.05, 0.3), Vector3(0.02, 0.1, 0), 0.03],
		[_capsule(0.05, 0.3), Vector3(0, 0.14, 0), 0.01], [_cylinder(0.1, 0.2), Vector3(0.07, 0, 0), 0.03],
		[_cylinder(0.1, 0.2), Vector3(0, 0.08, 0), 0.02], [WorldBoundaryShape3D.new(), Vector3(3, -0.5, 2), 0.5],
		[_hull(), Vector3(0.03, 0, 0), 0.02], [_hull(), Vector3(0.01, 0, 0.045), 0.005],
	]:
		holder.shape = told[0]
		check_near(zone.get_depth(told[1]), told[2], 1e-5, "%s at %s" % [told[0].get_class(), told[1]])
	holder.disabled = true
	check_equal(zone.get_depth(Vector3.ZERO), -INF, "a disabled shape does not count")
	holder.disabled = false
	holder.shape = ConcavePolygonShape3D.new()
	check_equal(zone.get_depth(Vector3.ZERO), -INF, "a shape without an inside does not count")
	check(zone._get_configuration_warnings()[0].contains("ConcavePolygonShape3D"), "and is named")
	zone.free()


func test_a_hull_that_changes_is_taken_anew() -> void:
	var zone := Zone.new()
	var holder := CollisionShape3D.new()
	var hull: ConvexPolygonShape3D = _hull()
	holder.shape = hull
	zone.add_child(holder)
	add(zone)
	for size: float in [1.0, 2.0, 3.0]:
		var points: PackedVector3Array = []
		for point: Vector3 in _hull().points:
			points.append(point * size)
		hull.points = points
		check_near(zone.get_depth(Vector3.ZERO), 0.05 * size, 1e-5, "%s times as large" % size)
	zone.free()


func _physics_says(zone: Zone, point: Vector3) -> bool:
	var query := PhysicsPointQueryParameters3D.new()
	query.position = point
	query.collide_with_areas = true
	query.collide_with_bodies = false
	for hit: Dictionary in zone.get_world_3d().direct_space_state.intersect_point(query):
		if hit["rid"] == zone.get_rid():
			return true
	return false


func _shapes() -> Array[Shape3D]:
	return [_box(Vector3(0.1, 0.15, 0.08)), _sphere(0.07), _capsule(0.04, 0.18), _cylinder(0.06, 0.12), _hull()]


func _box(size: Vector3) -> BoxShape3D:
	var shape := BoxShape3D.new()
	shape.size = size
	return shape


func _sphere(radius: float) -> SphereShape3D:
	var shape := SphereShape3D.new()
	shape.radius = radius
	return shape


func _capsule(radius: float, height: float) -> CapsuleShape3D:
	var shape := CapsuleShape3D.new()
	shape.radius = radius
	shape.height = height
	return shape


func _cylinder(radius: float, height: float) -> CylinderShape3D:
	var shape := CylinderShape3D.new()
	shape.radius = radius
	shape.height = height
	return shape


## A box of 10 cm with two points inside of it, which are no corners.
func _hull() -> ConvexPolygonShape3D:
	var shape := ConvexPolygonShape3D.new()
	var points: PackedVector3Array = [Vector3(0.01, 0.02, 0.0), Vector3(0.02, -0.03, 0.01)]
	for corner: int in 8:
		points.append(0.05 * Vector3(1 - 2 * (corner & 1), 1 - (corner & 2), 1 - (corner & 4) / 2.0))
	shape.points = points
	return shape
