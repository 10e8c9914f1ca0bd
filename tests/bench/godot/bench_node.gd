## Main-thread cost of SpidarG in a running Godot: a node a frame, and each call a game makes. Run by ./dev bench:
## godot --headless --path tests/godot/project --fixed-fps 60 -s bench_node.gd
extends SceneTree

const NODES: int = 8
const FRAMES: int = 400
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
	var with_nodes: PackedFloat64Array = []
	for _round: int in ROUNDS:
		without.append_array(await _frame_times())
		var nodes: Array[SpidarG] = []
		for _i: int in NODES:
			var node := SpidarG.new()
			node.forces_enabled = true
			root.add_child(node)
			nodes.append(node)
		await process_frame
		with_nodes.append_array(await _frame_times())
		for node: SpidarG in nodes:
			node.free()
	_row("an empty frame", without, 1.0)
	_row("a frame with %d threaded nodes" % NODES, with_nodes, 1.0)
	var cost: float = (_quantile(with_nodes, 0.5) - _quantile(without, 0.5)) / NODES
	print("one node a frame: %.2f us (difference of the medians / %d)" % [cost, NODES])


func _frame_times() -> PackedFloat64Array:
	var times: PackedFloat64Array = []
	for _i: int in FRAMES:
		var start: int = Time.get_ticks_usec()
		await process_frame
		times.append(Time.get_ticks_usec() - start)
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
