## SpidarGHand: whatever a surface is made of, it feels the same, at rest and when the hand slides over it.
extends "res://hand_shapes_scene.gd"

const DEPTH_M: float = 0.01
## Away from the vertices and the edges of the meshes.
const BESIDE := Vector3(0.005, 0.0, 0.003)
const SAME: float = 0.05
const RIPPLE_N: float = 0.05
const SIDEWAYS: float = 0.02
## Of the device's servo loop, nearly: a tick a cycle, so that no cycle goes unseen.
const SLIDING_TICKS: int = 960
## The faces of a ball of 80 segments lean by this from the ball.
const FACET_SLOPE: float = 0.5 * TAU / 80.0
## What the strings' own noise leaves of a moment, N m.
const MOMENT_NOISE_NM: float = 0.001
## A wall behind: the plates' top looks to -z. And one at the right, that looks to -x.
const BEHIND := Basis(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.0, -1.0), Vector3(0.0, 1.0, 0.0))
const RIGHT := Basis(Vector3(0.0, 1.0, 0.0), Vector3(-1.0, 0.0, 0.0), Vector3(0.0, 0.0, 1.0))


func test_a_floor_feels_the_same_whatever_it_is_made_of() -> void:
	await set_up_empty()
	var place := Transform3D(Basis.IDENTITY, Vector3(0.0, FLOOR_Y, 0.0))
	await _compare(Solids.PLATES, Solids.plate, place, BESIDE + Vector3(0.0, FLOOR_Y + PAD_RADIUS, 0.0), Vector3.DOWN)


func test_a_wall_feels_the_same_whatever_it_is_made_of() -> void:
	await set_up_empty()
	var place := Transform3D(BEHIND, Vector3(0.0, 0.0, 0.06))
	await _compare(Solids.PLATES, Solids.plate, place, Vector3(0.003, 0.005, 0.06 - PAD_RADIUS), Vector3.BACK)
	# A pad's back is pressed on: the finger gives way before the surface does.
	place = Transform3D(RIGHT, Vector3(0.1, 0.0, 0.0))
	await _compare(Solids.PLATES, Solids.plate, place, Vector3(0.1 - REACH_M, 0.005, 0.003), Vector3.RIGHT, 0.3)


func test_a_ball_feels_the_same_whatever_it_is_made_of() -> void:
	await set_up_empty()
	var place := Transform3D(RIGHT, Vector3(0.1, 0.0, 0.0))
	await _compare(Solids.BALLS, Solids.ball, place, Vector3(0.1 - REACH_M, 0.0, 0.0), Vector3.RIGHT, 0.3)
	# Under one pad's rim, and so with a lever.
	place = Transform3D(Basis.IDENTITY, Vector3(0.043, FLOOR_Y, 0.0))
	var touch := Vector3(0.0, FLOOR_Y + PAD_RADIUS, 0.0)
	await _compare(Solids.BALLS, Solids.ball, place, touch, Vector3.DOWN, 0.8, FACET_SLOPE)


## More than are made a hull of at once: the outermost stand for all.
func test_a_hull_of_ten_thousand_points_has_its_shape() -> void:
	await set_up_empty()
	var touch := Vector3(0.0, FLOOR_Y + PAD_RADIUS, 0.0)
	await go(touch + Vector3(0.0, 0.02, 0.0), 15)
	var ball: Node3D = Solids.ball("large hull")
	ball.position = Vector3(0.043, FLOOR_Y, 0.0)
	add(ball)
	await until_felt()
	check_equal(hand.get_shapes_in_reach()[0]["type"], "hull", "kind")
	await go(touch - Vector3(0.0, DEPTH_M, 0.0), 30)
	await physics_frames(25)
	check(force_of(await mean_felt(5)).y > 0.8, "pushes the pad up: %s" % force_of(await mean_felt(5)))
	check_shown_outside()


func test_sliding_over_seams_is_smooth() -> void:
	await set_up_empty()
	for speed: float in [0.1, 0.4]:
		var smooth: Array[Vector3] = await _slide("box", speed)
		for kind: String in ["trimesh 25", "two-sided 25", "height map", "tiles"]:
			var trace: Array[Vector3] = await _slide(kind, speed)
			var own: float = _ripple(smooth)
			var ripple: float = _ripple(trace)
			var normal: float = 0.0
			var sideways: float = 0.0
			for i: int in trace.size():
				normal += trace[i].y / trace.size()
				var beside: Vector3 = trace[i] - smooth[i]
				sideways = maxf(sideways, Vector2(beside.x, beside.z).length())
			print("INFO %s at %.1f m/s: %.3f N, ripple %.4f N (box %.4f N), sideways %.4f N" % [kind, speed, normal, ripple, own, sideways])
			check(normal > 1.0, "%s is felt: %f N" % [kind, normal])
			check(ripple <= own + RIPPLE_N, "%s at %.1f m/s ripples by %f N, a box by %f N" % [kind, speed, ripple, own])
			check(sideways <= SIDEWAYS * normal, "%s at %.1f m/s: %f N sideways of %f N" % [kind, speed, sideways, normal])
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


## Presses from `touch` by DEPTH_M along `inward`; the first kind is what the others are compared with.
func _compare(
	kinds: PackedStringArray, make: Callable, place: Transform3D, touch: Vector3, inward: Vector3, least_n: float = 1.5,
	slope: float = 0.0
) -> void:
	var first: PackedFloat64Array = []
	var lines: PackedStringArray = []
	for kind: String in kinds:
		await go(touch - 0.02 * inward, 15)
		var node: Node3D = make.call(kind)
		node.transform = place
		add(node)
		await until_felt()
		await go(touch + DEPTH_M * inward, 30)
		await physics_frames(25)
		note_depth()
		var felt: PackedFloat64Array = await mean_felt(5)
		first = felt if first.is_empty() else first
		var expected: Vector3 = force_of(first)
		var apart: float = force_of(felt).distance_to(expected)
		lines.append("%s %.3f" % [kind, force_of(felt).length()])
		check(-inward.dot(force_of(felt)) > least_n, "%s pushes out: %s N" % [kind, force_of(felt)])
		check(apart <= (SAME + slope) * expected.length(), "%s: %s N, %s N is due" % [kind, force_of(felt), expected])
		var turned: float = moment_of(felt).distance_to(moment_of(first))
		check(turned <= (SAME + slope) * moment_of(first).length() + MOMENT_NOISE_NM, "%s: %s N m, %s N m is due" % [kind, moment_of(felt), moment_of(first)])
		await go(touch - 0.02 * inward, 15)
		node.free()
	print("INFO N: ", ", ".join(lines))
	check_equal(shakes, 0, "nothing shakes")
	check_shown_outside()


## The force that is asked for in each cycle of a way across the seams, 10 mm deep.
func _slide(kind: String, speed: float) -> Array[Vector3]:
	var from := Vector3(-0.08, FLOOR_Y + PAD_RADIUS - DEPTH_M, -0.05)
	var way := Vector3(0.16, 0.0, 0.09)
	await go(from + Vector3(0.0, 0.03, 0.0), 20)
	var node: Node3D = Solids.plate(kind)
	node.position.y = FLOOR_Y
	add(node)
	await until_felt()
	await go(from, 20)
	await physics_frames(20)
	Engine.max_physics_steps_per_frame = 100
	Engine.physics_ticks_per_second = SLIDING_TICKS
	await physics_frames(40)
	var trace: Array[Vector3] = []
	var tick_count: int = roundi(SLIDING_TICKS * way.length() / speed)
	for i: int in tick_count:
		at = from + way * (float(i + 1) / tick_count)
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), 0.0)
		await physics_frames(1)
		trace.append(force_of(device.get_requested_wrench()))
		if i % 16 == 0:
			note_depth()
	Engine.physics_ticks_per_second = 60
	Engine.max_physics_steps_per_frame = 8
	await go(at + Vector3(0.0, 0.03, 0.0), 10)
	node.free()
	return trace


func _ripple(trace: Array[Vector3]) -> float:
	var least: float = INF
	var most: float = -INF
	for force: Vector3 in trace:
		least = minf(least, force.y)
		most = maxf(most, force.y)
	return most - least
