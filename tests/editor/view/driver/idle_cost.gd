@tool
extends "editor_case.gd"
## What a SpidarG in an open scene costs an editor that nobody touches: time a frame, frames drawn, threads. Scenes with and
## without devices take turns, so that both see the same machine.

const DEVICES: int = 8
const ROUNDS: int = 6
const GROUPS: int = 40
## The clock reads whole microseconds: frames are timed ten at a time.
const FRAMES_A_GROUP: int = 10
## Frames that an editor draws by itself, a blinking cursor, say.
const OWN_FRAMES: int = 3


func run(owner: EditorPlugin, _arguments: PackedStringArray) -> int:
	plugin = owner
	var root: Node = await open("res://stage.tscn")
	OS.low_processor_usage_mode_sleep_usec = 0
	var without: PackedFloat64Array = []
	var with_devices: PackedFloat64Array = []
	var drawn_without: int = 0
	var drawn_with: int = 0
	var threads_without: int = 0
	var threads_with: int = 0
	for _round: int in ROUNDS:
		await frames(20)
		var before: int = Engine.get_frames_drawn()
		without.append_array(await _frame_times())
		drawn_without += Engine.get_frames_drawn() - before
		threads_without = maxi(threads_without, _thread_count())
		var devices: Array[SpidarG] = []
		for _i: int in DEVICES:
			var device := SpidarG.new()
			root.add_child(device)
			device.owner = root
			devices.append(device)
		await frames(20)
		var gizmos_drawn: int = _gizmo_draws(devices)
		before = Engine.get_frames_drawn()
		with_devices.append_array(await _frame_times())
		drawn_with += Engine.get_frames_drawn() - before
		threads_with = maxi(threads_with, _thread_count())
		check(gizmos_drawn >= DEVICES, "each device is drawn when it comes")
		check(_gizmo_draws(devices) == gizmos_drawn, "and not again")
		for device: SpidarG in devices:
			check(not device.is_processing_internal() and not device.is_physics_processing_internal(), "none runs")
			device.free()
		await frames(5)
	check(threads_with <= threads_without, "threads: %d with devices, %d without" % [threads_with, threads_without])
	check(drawn_with <= drawn_without + OWN_FRAMES, "frames drawn: %d with, %d without" % [drawn_with, drawn_without])
	var cost_us: float = (_median(with_devices) - _median(without)) / DEVICES
	var told: String = "idle editor: one SpidarG costs %.4f ms a frame (median frame %.3f ms with %d, %.3f ms without)"
	print(told % [1e-3 * cost_us, 1e-3 * _median(with_devices), DEVICES, 1e-3 * _median(without)])
	told = "idle editor: %d of %d frames drawn with devices, %d without; %d more threads"
	print(told % [drawn_with, ROUNDS * GROUPS * FRAMES_A_GROUP, drawn_without, threads_with - threads_without])
	print("%d passed, %d failed" % [passed, failed])
	return failed


func _frame_times() -> PackedFloat64Array:
	var times: PackedFloat64Array = []
	for _i: int in GROUPS:
		var start: int = Time.get_ticks_usec()
		await frames(FRAMES_A_GROUP)
		times.append((Time.get_ticks_usec() - start) / float(FRAMES_A_GROUP))
	return times


func _gizmo_draws(devices: Array[SpidarG]) -> int:
	var count: int = 0
	for device: SpidarG in devices:
		count += gizmo_of(device).draw_count
	return count


func _thread_count() -> int:
	return DirAccess.get_directories_at("/proc/self/task").size()


func _median(times: PackedFloat64Array) -> float:
	var sorted: PackedFloat64Array = times.duplicate()
	sorted.sort()
	return sorted[sorted.size() / 2]
