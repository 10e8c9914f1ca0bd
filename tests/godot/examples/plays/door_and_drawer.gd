extends "res://plays/play.gd"

## Where the fingers take each body, in its own frame, m.
const BAR := Vector3(0.08, 0.0, 0.025)
const PULL := Vector3(0.0, 0.0, 0.02)
const DISC := Vector3.ZERO
const HANDLE := Vector3(0.0, 0.0, 0.085)

const SHARE: float = 0.05 # that a torque may be off
const LIMIT_RAD: float = deg_to_rad(1.0)
const END_M: float = 0.0005
const STOP_N: float = 0.8 # that is felt at least of an end
const GRAVITY_M_S2: float = 9.8
## Beyond each end, and beyond what a hand's wrist holds against a spring.
const TOO_FAR_RAD: float = 0.95


func play() -> void:
	# Friction and stretch of the strings would be measured with the joints.
	device.config.simulated_friction = 0.0
	device.config.simulated_elastic = false
	await ticks(150)
	await _lifts_the_lever()
	await _turns_the_knob()
	await _pulls_the_drawer()
	await _opens_the_door()


func _lifts_the_lever() -> void:
	var lever: RigidBody3D = scene.get_node(^"Lever")
	var hinge: HingeJoint3D = scene.get_node(^"LeverHinge")
	await _grasps(lever, HANDLE, Vector3.UP)
	for angle: float in [0.2, 0.5]:
		await _swings(lever, HANDLE, Vector3.LEFT, angle)
		var arm: Vector3 = lever.global_basis * lever.center_of_mass
		var weight_nm: float = arm.cross(lever.mass * GRAVITY_M_S2 * Vector3.DOWN).x
		check_near(-lever.rotation.x, angle, 0.06, "lever lifted to, rad")
		check_near((await _torque_nm(lever)).x, weight_nm, SHARE * weight_nm, "its weight about the hinge, N m")
	await _swings(lever, HANDLE, Vector3.LEFT, TOO_FAR_RAD)
	check_near(-lever.rotation.x, hinge.get_param(HingeJoint3D.PARAM_LIMIT_UPPER), LIMIT_RAD, "its end, rad")
	check((await felt_n()).y < -STOP_N - lever.mass * GRAVITY_M_S2, "the lever's end is felt")
	await _swings(lever, HANDLE, Vector3.LEFT, 0.3)
	await _leaves(Vector3.UP)
	check_near(lever.rotation.x, 0.0, LIMIT_RAD, "let go, the lever falls to, rad")


func _turns_the_knob() -> void:
	var knob: RigidBody3D = scene.get_node(^"Knob")
	var axle: Generic6DOFJoint3D = scene.get_node(^"KnobAxle")
	var stiffness: float = axle.get_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_STIFFNESS)
	await _grasps(knob, DISC, Vector3.UP)
	for angle: float in [0.3, 0.6, -0.5]:
		await _swings(knob, DISC, Vector3.UP, angle)
		var turned: float = knob.rotation.y
		check_near(turned, angle, 0.25 * absf(angle), "knob turned to, rad")
		check_near((await _torque_nm(knob)).y, -stiffness * turned, SHARE * stiffness * absf(turned), "its spring, N m")
	var from: Vector3 = mouse.position_m
	await move_to(from + Vector3(0.004, 0.0, 0.0))
	check((await felt_n()).x < -0.5, "the knob stays in its place")
	await _leaves(Vector3.UP)
	check_near(knob.rotation.y, 0.0, LIMIT_RAD, "let go, the knob turns back to, rad")


func _pulls_the_drawer() -> void:
	var drawer: RigidBody3D = scene.get_node(^"Drawer")
	var shut: Vector3 = drawer.position
	var end_m: float = (scene.get_node(^"DrawerRail") as SliderJoint3D).get_param(SliderJoint3D.PARAM_LINEAR_LIMIT_UPPER)
	await _grasps(drawer, PULL, Vector3.BACK)
	var from: Vector3 = mouse.position_m
	for way: float in [0.02, 0.045]:
		await move_to(from + Vector3(0.0, 0.0, way))
		check_near(drawer.position.z - shut.z, way, 0.05 * way, "drawer pulled out by, m")
		check_near((await felt_n()).z, 0.0, 0.05, "what holds it on the way, N")
	await move_to(from + Vector3(0.0, 0.006, 0.045))
	check((await felt_n()).y < -STOP_N, "lifted, the drawer stays on its rail")
	check_near(drawer.position.y, shut.y, END_M, "its height, m")
	await move_to(from + Vector3(0.0, 0.0, end_m + 0.012))
	check_near(drawer.position.z - shut.z, end_m, END_M, "the drawer's end, m")
	check((await felt_n()).z < -STOP_N, "the drawer's end is felt")
	await move_to(from + Vector3(0.0, 0.0, -0.012))
	check_near(drawer.position.z, shut.z, END_M, "shut, m")
	check((await felt_n()).z > STOP_N, "that it is shut is felt")
	await move_to(from + Vector3(0.0, 0.0, 0.03))
	await _leaves(Vector3.BACK)


func _opens_the_door() -> void:
	var door: RigidBody3D = scene.get_node(^"Door")
	var hinge: Generic6DOFJoint3D = scene.get_node(^"DoorHinge")
	var stiffness: float = hinge.get_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_SPRING_STIFFNESS)
	await _grasps(door, BAR, Vector3.BACK)
	for angle: float in [0.25, 0.5]:
		await _swings(door, BAR, Vector3.DOWN, angle)
		var opened: float = -door.rotation.y
		check_near(opened, angle, 0.15 * angle, "door opened to, rad")
		check_near((await _torque_nm(door)).y, stiffness * opened, SHARE * stiffness * opened, "its spring about the hinge, N m")
	await _swings(door, BAR, Vector3.DOWN, TOO_FAR_RAD)
	check_near(-door.rotation.y, hinge.get_param_y(Generic6DOFJoint3D.PARAM_ANGULAR_UPPER_LIMIT), LIMIT_RAD, "its end, rad")
	check((await felt_n()).z < -STOP_N, "the door's end is felt")
	await _leaves(Vector3.BACK)
	check_near(door.rotation.y, 0.0, LIMIT_RAD, "let go, the door closes to, rad")
	await _grasps(door, BAR, Vector3.BACK)
	await move_to(mouse.position_m + Vector3(-0.01, 0.0, 0.06))
	check(door.rotation.y < -0.3, "it opens too when the hand is pulled straight: %.3f rad" % door.rotation.y)


## The fingers reach for a handle from a side, and close on it.
func _grasps(body: RigidBody3D, handle: Vector3, from: Vector3) -> void:
	var at: Vector3 = in_device(body.to_global(handle))
	await move_to(at + 0.06 * from)
	await move_to(at)
	press(mouse.grasp_action, true)
	await ticks(100)
	check(hand.get_held_body() == body, "%s is held; %s" % [body.name, refused])
	var width_m: float = hand.get_held_width()
	check(width_m > 0.02 and width_m < 0.04, "%s is %.4f m wide between the fingers" % [body.name, width_m])


## The hand opens and goes away. What it held has its time.
func _leaves(to: Vector3) -> void:
	await lets_go()
	mouse.turn_rad = Vector3.ZERO
	await move_to(mouse.position_m + 0.06 * to)
	await ticks(120)


## The hand goes on round the axis of the body from where that is, and turns with it.
func _swings(body: RigidBody3D, handle: Vector3, axis: Vector3, to: float) -> void:
	var from: float = Basis.from_euler(mouse.turn_rad).get_rotation_quaternion().get_angle()
	from *= signf(mouse.turn_rad.dot(axis))
	for tick: int in 90:
		var turn := Basis(axis, lerpf(from, to, (tick + 1) / 90.0))
		mouse.position_m = in_device(body.position + turn * handle)
		mouse.turn_rad = turn.get_euler()
		await ticks(1)
	await ticks(SETTLE_TICKS)


## Mean of the torque that the hand feels about the body's origin, N m.
func _torque_nm(body: RigidBody3D) -> Vector3:
	var sum := Vector3.ZERO
	for _i: int in 30:
		await ticks(1)
		var truth: Dictionary = device.get_simulated_truth()
		var felt: PackedFloat64Array = truth["strings_wrench"]
		var lever: Vector3 = (truth["grip_transform"] as Transform3D).origin - body.global_position
		sum += (Vector3(felt[3], felt[4], felt[5]) + lever.cross(Vector3(felt[0], felt[1], felt[2]))) / 30.0
	return sum
