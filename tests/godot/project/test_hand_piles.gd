## SpidarGHand in a heap: all that the pads touch is felt, found by a search of the physics engine through everything.
extends "res://hand_shapes_scene.gd"

const SEEDS: int = 3
## Where what is touched begins: the engine's own distances are this exact.
const TOUCH_M: float = 0.0003
## How far round the pads is searched: more than there is between the balls that stand for a pad.
const SEARCH_M: float = 0.0002
## Where the open pads stand at first, and as much beside them as a body is large.
const CLEAR := Vector3(0.062, 0.026, 0.026)

var _outer: SphereShape3D = PadDepth.ball(SEARCH_M)


func test_all_of_a_small_pile_that_is_touched_is_felt() -> void:
	await _piles(30, Vector3(0.08, 0.04, 0.04))


func test_all_of_a_large_pile_that_is_touched_is_felt() -> void:
	await _piles(300, Vector3(0.12, 0.08, 0.08))


func test_far_bodies_are_not_looked_at() -> void:
	await set_up_empty()
	for i: int in 500:
		add_box(Vector3.ONE * 0.03, Vector3(2.0 + 0.05 * i, 0.0, 0.0), 0.0)
	add_box(Vector3.ONE * 0.03, Vector3(0.08, 0.0, 0.0), 0.0)
	await physics_frames(5)
	var now: Dictionary = hand.get_touch_statistics()
	check_equal(now["bodies"], 1, "bodies that are read")
	check_equal(now["shapes"], 1, "shapes that are listed")
	check(now["queries"] <= 3, "queries: %d" % now["queries"])


## Bodies of all kinds in a box of these half extents; the hand is pushed and turned into them.
func _piles(count: int, half_m: Vector3) -> void:
	var checked: int = 0
	var pushing: int = 0
	var most_points: int = 0
	for seed_value: int in range(1, SEEDS + 1):
		var random := RandomNumberGenerator.new()
		random.seed = seed_value
		at = Vector3.ZERO
		turn = Basis.IDENTITY
		await set_up_empty()
		var pile := Node3D.new()
		add(pile)
		while pile.get_child_count() < count:
			var place: Vector3 = half_m * _anywhere(random)
			if absf(place.x) < CLEAR.x and absf(place.y) < CLEAR.y and absf(place.z) < CLEAR.z:
				continue
			pile.add_child(_anything(random, place))
		await until_felt()
		for _goal: int in 8:
			var goal: Vector3 = 0.04 * _anywhere(random)
			var axis := Vector3(random.randfn(), random.randfn(), random.randfn()).normalized()
			var to_turn := Basis(axis, random.randf_range(0.0, 0.6))
			await go(goal, 20, to_turn, random.randf_range(0.0, 0.8))
			# The points are of the last cycle of the device, the shown pads of the proxy there: at rest they agree.
			await physics_frames(10)
			var felt: Dictionary[Node, float] = _felt()
			most_points = maxi(most_points, hand.get_touch_points().size())
			var searched: Array = _touched_by_search()
			for point: Dictionary in hand.get_touch_points():
				if (point["force"] as Vector3).length() > 0.01:
					pushing += 1
					check(searched.has(point["collider"]), "%d bodies, seed %d: what pushes touches" % [count, seed_value])
			for body: Node in searched:
				checked += 1
				var text: String = "%d bodies, seed %d: %s is touched, gap %s" % [
					count, seed_value, body.get_child(0).shape, felt.get(body, "none")
				]
				check(felt.has(body) and felt[body] <= TOUCH_M, text)
		device.free()
		pile.free()
		await physics_frames(2)
	print("INFO %d bodies: %d touches and %d pushing points compared, at most %d points" % [count, checked, pushing, most_points])
	check(checked >= 7 * SEEDS, "enough is touched: %d" % checked)
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


func _anywhere(random: RandomNumberGenerator) -> Vector3:
	return Vector3(random.randf_range(-1.0, 1.0), random.randf_range(-1.0, 1.0), random.randf_range(-1.0, 1.0))


func _anything(random: RandomNumberGenerator, place: Vector3) -> StaticBody3D:
	var size: float = random.randf_range(0.008, 0.02)
	var shape: Shape3D = null
	match random.randi() % 5:
		0:
			shape = Solids.box(Vector3(size, 0.7 * size, 1.2 * size))
		1:
			var sphere := SphereShape3D.new()
			sphere.radius = 0.5 * size
			shape = sphere
		2:
			var capsule := CapsuleShape3D.new()
			capsule.radius = 0.3 * size
			capsule.height = 1.5 * size
			shape = capsule
		3:
			shape = Solids.hull(Solids.box_mesh(Vector3.ONE * size).get_faces())
		4:
			shape = Solids.faces(Solids.box_mesh(Vector3.ONE * size), true)
	shape.margin = 0.0  # Jolt rounds by it what it searches
	var body: StaticBody3D = Solids.static_body(shape)
	var axis := Vector3(random.randfn(), random.randfn(), random.randfn()).normalized()
	body.transform = Transform3D(Basis(axis, random.randf_range(0.0, PI)), place)
	return body


## The least gap to each body of which the hand knows a point.
func _felt() -> Dictionary[Node, float]:
	var found: Dictionary[Node, float] = {}
	for point: Dictionary in hand.get_touch_points():
		var body: Node = point["collider"]
		found[body] = minf(found.get(body, INF), point["gap"])
	return found


func _touched_by_search() -> Array:
	var space: PhysicsDirectSpaceState3D = hand.get_world_3d().direct_space_state
	var found: Dictionary[RID, Object] = {}
	for side: int in 2:
		found.merge(PadDepth.met(space, hand.get_pad_transform(side), _outer, 0.001))
	return found.values()
