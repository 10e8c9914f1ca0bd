## Base of what is done in an example: the simulated hand moved as a user with a mouse moves it, and what it feels. A play
## ends where a picture shows best what the scene is for.
extends RefCounted

const SETTLE_TICKS: int = 40

## Of the runner.
var tree: SceneTree
var scene: Node
var failures: PackedStringArray = []
var check_count: int = 0

## Of the scene: the first of each. A scene of several devices sets others.
var device: SpidarG
var hand: SpidarGHand
var mouse: SpidarGMouseHand
## Why the hand did not take the last body that it did not take.
var refused: String = ""


## To be overridden.
func play() -> void:
	await presses(Vector3.ZERO, Vector3(0.0, -0.1, 0.0))


## The hand goes from one place to another (device metres) where something stops it, and feels it. Returns the force that it
## feels there beyond what it felt at first, N.
func presses(from_m: Vector3, to_m: Vector3, least_n: float = 0.5) -> Vector3:
	await move_to(from_m)
	var before: Vector3 = await felt_n()
	await move_to(to_m)
	var pressed: Vector3 = await felt_n() - before
	print("INFO pressed from %s m to %s m: felt %s N more" % [from_m, to_m, pressed])
	check(pressed.length() >= least_n, "from %s m to %s m something is felt: %s N" % [from_m, to_m, pressed])
	return pressed


## The hand reaches round a body from above, closes on it and lifts it by 5 cm.
func lifts(body: RigidBody3D) -> void:
	var above: Vector3 = in_device(body.global_position + Vector3(0.0, 0.06 * device.workspace_scale, 0.0))
	await move_to(above)
	await move_to(in_device(body.global_position))
	press(mouse.grasp_action, true)
	await ticks(100)
	var height: float = body.global_position.y
	if not check(hand.get_held_body() == body, "%s is held; %s" % [body.name, refused]):
		return
	await move_to(mouse.position_m + Vector3(0.0, 0.05, 0.0))
	var lifted_m: float = (body.global_position.y - height) / device.workspace_scale
	print("INFO %s of %.3f kg lifted by %.1f mm (device)" % [body.name, body.mass, 1e3 * lifted_m])
	check(lifted_m > 0.04, "%s is lifted: %.4f m" % [body.name, lifted_m])


func lets_go() -> void:
	press(mouse.grasp_action, false)
	await ticks(60)
	check(hand.get_held_body() == null, "nothing is held any more")


## The hand goes there in a straight line and stays; device metres.
func move_to(to_m: Vector3, count: int = 60) -> void:
	var from_m: Vector3 = mouse.position_m
	for tick: int in count:
		mouse.position_m = from_m.lerp(to_m, float(tick + 1) / count)
		await ticks(1)
	await ticks(SETTLE_TICKS)


## An action of the mouse hand, by its first key or button.
func press(action: StringName, pressed: bool) -> void:
	var event: InputEvent = InputMap.action_get_events(action)[0].duplicate()
	event.set("pressed", pressed)
	event.device = 0
	Input.parse_input_event(event)
	Input.flush_buffered_events()


## Mean force on the hand, world, N.
func felt_n(count: int = 20) -> Vector3:
	var sum: Vector3 = Vector3.ZERO
	for _i: int in count:
		await ticks(1)
		var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
		sum += Vector3(felt[0], felt[1], felt[2])
	return sum / count


## A point of the world in device metres.
func in_device(world: Vector3) -> Vector3:
	return device.global_transform.orthonormalized().affine_inverse() * world / device.workspace_scale


func ticks(count: int) -> void:
	for _i: int in count:
		await tree.physics_frame


func check(condition: bool, message: String) -> bool:
	check_count += 1
	if not condition:
		failures.append(message)
	return condition


func check_equal(actual: Variant, expected: Variant, message: String) -> bool:
	return check(actual == expected, "%s: got %s, expected %s" % [message, actual, expected])


## `what` names the quantity and its unit. What was measured is printed.
func check_near(actual: float, expected: float, tolerance: float, what: String) -> bool:
	print("INFO %s: %.4f, expected %.4f" % [what, actual, expected])
	return check(absf(actual - expected) <= tolerance, "%s: %.4f, expected %.4f +- %.4f" % [what, actual, expected, tolerance])


func take(runner: SceneTree, example: Node) -> void:
	tree = runner
	scene = example
	for node: Node in example.find_children("*", "", true, false):
		device = node if device == null and node is SpidarG else device
		hand = node if hand == null and node is SpidarGHand else hand
		mouse = node if mouse == null and node is SpidarGMouseHand else mouse
	if hand != null:
		hand.grasp_refused.connect(func(body: RigidBody3D, reason: String) -> void:
			refused = "%s: %s" % [body.name, reason])
