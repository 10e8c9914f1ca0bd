## Base of every test script. Functions named test_* are run, each on an object of its own.
extends RefCounted

## Set by the runner.
var tree: SceneTree
var failures: PackedStringArray = []
var check_count: int = 0


func check(condition: bool, message: String) -> bool:
	check_count += 1
	if not condition:
		failures.append(message)
	return condition


func check_equal(actual: Variant, expected: Variant, message: String) -> bool:
	return check(actual == expected, "%s: got %s, expected %s" % [message, actual, expected])


func check_near(actual: float, expected: float, tolerance: float, message: String) -> bool:
	# Written so that NaN fails.
	return check(
		absf(actual - expected) <= tolerance,
		"%s: got %.9f, expected %.9f within %.9f" % [message, actual, expected, tolerance]
	)


func add(node: Node) -> void:
	tree.root.add_child(node)


func physics_frames(count: int) -> void:
	for _i: int in count:
		await tree.physics_frame


func frames(count: int) -> void:
	for _i: int in count:
		await tree.process_frame


## Waits in real time, which headless frames run ahead of: a thread needs some.
func until(condition: Callable, limit_ms: int = 5000) -> bool:
	var deadline: int = Time.get_ticks_msec() + limit_ms
	while not condition.call() and Time.get_ticks_msec() < deadline:
		OS.delay_msec(1)
		await tree.process_frame
	return condition.call()


func is_open(device: SpidarG) -> bool:
	return device.get_state() != SpidarG.STATE_CLOSED


## A stepped device of the ideal kind: no elasticity, no friction, no sensor noise but the counts.
func ideal_device() -> SpidarG:
	var config := SpidarGConfig.new()
	config.simulated_elastic = false
	config.simulated_friction = 0.0
	config.simulated_hand_firmness = SpidarG.HAND_NORMAL
	var device := SpidarG.new()
	device.config = config
	device.drive_mode = SpidarG.DRIVE_STEPPED
	return device
