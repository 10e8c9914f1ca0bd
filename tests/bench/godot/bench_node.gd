## Main-thread cost of SpidarG in a running Godot: a node a frame, and each call a game makes. Run by ./dev bench:
## godot --headless --path tests/godot/project --fixed-fps 60 -s bench_node.gd
extends SceneTree

const NODES: int = 8
const GROUPS: int = 150
## The clock reads whole microseconds and an empty frame takes five: frames are timed ten at a time.
const FRAMES_A_GROUP: int = 10
const ROUNDS: int = 3
const CALLS: int = 20000


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	if not ClassDB.class_exists("SpidarG"):
		printerr("The spidar_g library is not loaded.")
		quit(1)
		return
	print("main-thread cost (us)                            median       p99     p99.9")
	await _frame_cost()
	await _call_costs()
	quit(0)


## Frames with and without nodes, in turn, so that both see the same machine.
func _frame_cost() -> void:
	var without: PackedFloat64Array = []
	var threaded: PackedFloat64Array = []
	var stepped: PackedFloat64Array = []
	for _round: int in ROUNDS:
		without.append_array(await _frame_times(0, SpidarG.DRIVE_THREADED))
		threaded.append_array(await _frame_times(NODES, SpidarG.DRIVE_THREADED))
		stepped.append_array(await _frame_times(1, SpidarG.DRIVE_STEPPED))
	_row("an empty frame", without, 1.0)
	_row("a frame with %d threaded nodes" % NODES, threaded, 1.0)
	_row("a frame with 1 stepped node, 16 or 17 cycles", stepped, 1.0)
	var cost: float = (_quantile(threaded, 0.5) - _quantile(without, 0.5)) / NODES
	print("one threaded node a frame: %.2f us (difference of the medians / %d)" % [cost, NODES])


func _frame_times(node_count: int, mode: SpidarG.DriveMode) -> PackedFloat64Array:
	var nodes: Array[SpidarG] = []
	for _i: int in node_count:
		var node := SpidarG.new()
		node.drive_mode = mode
		node.forces_enabled = true
		root.add_child(node)
		nodes.append(node)
	await process_frame
	var times: PackedFloat64Array = []
	for _i: int in GROUPS:
		var start: int = Time.get_ticks_usec()
		for _j: int in FRAMES_A_GROUP:
			await process_frame
		times.append((Time.get_ticks_usec() - start) / float(FRAMES_A_GROUP))
	for node: SpidarG in nodes:
		node.free()
	return times


func _call_costs() -> void:
	var node := SpidarG.new()
	node.drive_mode = SpidarG.DRIVE_STEPPED
	root.add_child(node)
	await process_frame
	var contacts := PackedFloat64Array()
	for id: int in 8:
		contacts.append_array(PackedFloat64Array([0, 1, 0, -0.2, 0, 0, 0, 350, 2, 0.3, 0, id]))
	_time_calls("get_grip_transform", func() -> void: node.get_grip_transform())
	_time_calls("get_string_tensions", func() -> void: node.get_string_tensions())
	_time_calls("get_statistics", func() -> void: node.get_statistics())
	_time_calls("request_wrench", func() -> void: node.request_wrench(Vector3.UP, Vector3.ZERO, 0.0))
	_time_calls("set_contacts, 8 planes", func() -> void: node.set_contacts(contacts))
	node.free()


## Groups of calls, since the clock reads whole microseconds.
func _time_calls(name: String, call: Callable) -> void:
	const GROUP: int = 20
	var times: PackedFloat64Array = []
	for _i: int in CALLS / GROUP:
		var start: int = Time.get_ticks_usec()
		for _j: int in GROUP:
			call.call()
		times.append(Time.get_ticks_usec() - start)
	_row(name, times, 1.0 / GROUP)


func _row(name: String, times: PackedFloat64Array, factor: float) -> void:
	print("%-46s %9.2f %9.2f %9.2f" % [name, factor * _quantile(times, 0.5), factor * _quantile(times, 0.99),
		factor * _quantile(times, 0.999)])


func _quantile(times: PackedFloat64Array, share: float) -> float:
	var sorted: PackedFloat64Array = times.duplicate()
	sorted.sort()
	return sorted[roundi(share * (sorted.size() - 1))]
