## The pages of docs/how_to on touch and grasp: each example runs as it stands there, and what its page promises is felt.
extends "res://docs_case.gd"

## From the hinge to the handle of the page's door.
const HANDLE := Vector3(0.075, 0.0, 0.025)
## Radius of a pad at the default settings, m.
const PAD: float = 0.012


func test_wall() -> void:
	if await open_page("wall.md", "A body as a wall"):
		check_near(hand.get_pad_radius(), PAD, 1e-6, "the edge of a pad is that far from the grip's middle")
		await move_to(Vector3(0.0, 0.0, -0.06), 0.0, 60)
		await physics_frames(40)
		var felt: PackedFloat64Array = await mean_felt(20)
		var depth: float = -0.05 + PAD - device.get_grip_transform().origin.z
		check_near(felt[2] / depth, 720.0, 7.2, "stiffness of the body")
		await move_to(Vector3(0.0, 0.0, -0.08), 0.0, 60)
		await physics_frames(40)
		check_near((await mean_felt(20))[2], 8.0, 0.05, "the largest force")
		await close_page()
	if await open_page("wall.md", "A plane from a script"):
		await move_to(Vector3(-0.05, 0.0, 0.0), 0.0, 60)
		await physics_frames(40)
		var felt: PackedFloat64Array = await mean_felt(20)
		check_near(felt[0] / (-0.03 - device.get_grip_transform().origin.x), 350.0, 3.5, "stiffness of the plane")
		await close_page()


func test_weight() -> void:
	if not await open_page("weight.md", "A box that can be lifted"):
		return
	var box: RigidBody3D = scene.get("box")
	await grasp(box)
	check(hand.get_held_body() == box, "the box is held")
	await physics_frames(40)
	check_near((await mean_felt(30))[1], 0.0, 0.05, "on the table the table carries it")
	await move_to(box.global_position + Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 60)
	await physics_frames(60)
	check_near((await mean_felt(30))[1], -1.96, 0.0196, "its weight in the air")
	check_near(hand.get_held_weight(), 1.96, 0.001, "the weight that is reported")
	check_near(hand.get_held_width(), 0.04, 0.0001, "its width")
	check_near(hand.get_squeeze_torque(), 0.09, 0.005, "the squeeze")
	await close_page()


func test_material() -> void:
	if await open_page("material.md", "A table with a material"):
		check_near(await _stiffness_of_the_table(0.0), 150.0, 5.0, "soft, below open fingers")
		check_near(await _stiffness_of_the_table(0.9), 150.0, 3.0, "soft, below closed fingers")
		var surface: SpidarGSurface = scene.get("surface")
		check(surface.is_touched(), "the surface is touched")
		check_near(await _friction_of_the_table(), 0.2, 0.01, "friction")
		await close_page()
	if await open_page("material.md", "Ribs that are heard"):
		var surface: SpidarGSurface = scene.get("surface")
		check_equal(surface.get_warnings().size(), 0, "the table has ribs")
		await move_to(Vector3(-0.03, -0.075, 0.0), 0.9, 60)
		var least: float = INF
		var most: float = -INF
		var fastest: float = 0.0
		for step: int in 120:
			await move_to(at + Vector3(0.0005, 0.0, 0.0), 0.9, 1)
			var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
			fastest = maxf(fastest, device.get_linear_velocity().length())
			if step >= 60:
				least = minf(least, felt[0])
				most = maxf(most, felt[0])
		check(most - least > 0.1, "ribs are felt: %.3f to %.3f N" % [least, most])
		check(fastest > 0.01 and surface.get_touch_force() > 0.5, "and can be heard: %.3f m/s, %.2f N" % [fastest, surface.get_touch_force()])
		await close_page()


func test_door() -> void:
	if not await open_page("door.md", "A door with a spring"):
		return
	var door: RigidBody3D = scene.get("door")
	await move_to(door.to_global(HANDLE) + Vector3(0.0, 0.0, 0.05), 0.0, 60)
	await move_to(door.to_global(HANDLE), 0.0, 60)
	await move_to(door.to_global(HANDLE), SQUEEZE_ANGLE, 40)
	await physics_frames(40)
	check(hand.get_held_body() == door, "the handle is held")
	for angle_wanted: float in [0.3, 0.6]:
		await _swing(door, angle_wanted)
		var opened: float = -door.rotation.y
		check_near(opened, angle_wanted, 0.15 * angle_wanted, "the door follows the hand")
		check_near((await _torque_about(door.position)).y, 0.2 * opened, 0.01 * 0.2 * opened, "torque of its spring")
	await _swing(door, 0.95)
	check_near(-door.rotation.y, 0.7, 0.001, "its limit")
	check((await _torque_about(door.position)).y > 0.3, "which is felt")
	await close_page()


func test_two_hands() -> void:
	if await open_page("two_hands.md", "Two devices and a bar"):
		var bar: RigidBody3D = scene.get("bar")
		var right: SpidarG = scene.get("right")
		await physics_frames(180)
		var end: Vector3 = bar.to_global(Vector3(-0.06, 0.0, 0.0))
		await move_to(end, 0.0, 60)
		await move_to(end, SQUEEZE_ANGLE, 40)
		await physics_frames(40)
		for each: SpidarGHand in scene.find_children("*", "SpidarGHand", true, false):
			check(each.get_held_body() == bar, "both hands hold the bar")
		await move_to(end + Vector3(0.0, 0.02, 0.0), SQUEEZE_ANGLE, 60)
		await move_to(end + Vector3(-0.005, 0.02, 0.0), SQUEEZE_ANGLE, 60)
		await physics_frames(60)
		var felt: PackedFloat64Array = await mean_felt(20)
		var other: PackedFloat64Array = right.get_simulated_truth()["strings_wrench"]
		check_near(felt[0], 0.56, 0.03, "the left hand is pulled to the right")
		check_near(other[0], -0.58, 0.03, "the right hand to the left")
		await close_page()
	if await open_page("two_hands.md", "Which device is which"):
		var left: SpidarG = scene.get("left")
		check(left.config != (scene.get("right") as SpidarG).config, "each has a config of its own")
		check(is_open(left), "and is open")
		await close_page()


func _stiffness_of_the_table(closed: float) -> float:
	await move_to(Vector3(0.0, -0.05, 0.0), closed, 60)
	await move_to(Vector3(0.0, -0.08 + PAD - 0.01, 0.0), closed, 60)
	await physics_frames(40)
	return (await mean_felt(20))[1] / (-0.08 + PAD - device.get_grip_transform().origin.y)


func _friction_of_the_table() -> float:
	await move_to(at + Vector3(0.0, 0.0, 0.06), angle, 90)
	var felt: PackedFloat64Array = await mean_felt(1)
	return -felt[2] / felt[1]


## The hand goes round the hinge of the door to this angle, and turns with it.
func _swing(door: RigidBody3D, to: float) -> void:
	var from: float = Vector3.RIGHT.signed_angle_to(turn.x, Vector3.DOWN)
	for i: int in 90:
		turn = Basis(Vector3.DOWN, lerpf(from, to, (i + 1) / 90.0))
		await move_to(door.position + turn * HANDLE, SQUEEZE_ANGLE, 1)
	await physics_frames(60)


## Mean torque about a point of the world that the hand feels, N m.
func _torque_about(point: Vector3) -> Vector3:
	var felt: PackedFloat64Array = await mean_felt(20)
	var lever: Vector3 = device.get_grip_transform().origin - point
	return Vector3(felt[3], felt[4], felt[5]) + lever.cross(Vector3(felt[0], felt[1], felt[2]))
