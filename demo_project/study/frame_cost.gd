extends RefCounted
## What the main thread spends in a frame, by the engine's own clocks: physics and scripts; nothing of drawing.

## Enough for the longest trial; more is not kept.
const MOST := 40000

var _physics_ms := PackedFloat32Array()
var _process_ms := PackedFloat32Array()


func sample() -> void:
	if _physics_ms.size() < MOST:
		_physics_ms.append(1000.0 * Performance.get_monitor(Performance.TIME_PHYSICS_PROCESS))
		_process_ms.append(1000.0 * Performance.get_monitor(Performance.TIME_PROCESS))


## By what was measured: [median, 99 %], ms.
func report() -> Dictionary:
	return {
		"physics tick: add-on, 16 servo cycles, task, Jolt": _quantiles(_physics_ms),
		"idle frame: display scripts": _quantiles(_process_ms),
	}


func _quantiles(times: PackedFloat32Array) -> Array[float]:
	if times.is_empty():
		return [NAN, NAN]
	var sorted := times.duplicate()
	sorted.sort()
	return [sorted[floori(0.5 * (sorted.size() - 1))], sorted[floori(0.99 * (sorted.size() - 1))]]
