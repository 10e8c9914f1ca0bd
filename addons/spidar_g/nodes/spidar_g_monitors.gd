@tool
class_name SpidarGMonitors
extends Node
## Adds measurements of a [SpidarG] to the Monitors tab of the debugger.
##
## Add this node as a child of a [SpidarG]. The monitors are the servo rate in hertz, the 99th percentiles of lateness and of
## computing time in microseconds, the number of missed deadlines, the percentage of cycles in which strings were at a limit,
## and the number of faults. If a simulated device is open when the node enters the tree, there is also the energy that the
## hand has received, in millijoules. The monitors exist while the node is in the tree, in debug builds only, and take no time
## unless the debugger reads them.
## [codeblock]
## var device: SpidarG = $SpidarG
## var monitors := SpidarGMonitors.new()
## device.add_child(monitors)
## print(monitors.get_monitor_names())
## [/codeblock]

## The first part of the names of all monitors, as in [code]spidar_g/servo_rate_hz[/code]. If a monitor of this name exists
## already, the name of the [SpidarG] is added, as in [code]spidar_g SpidarG2/servo_rate_hz[/code].
const GROUP: String = "spidar_g"

var _device: SpidarG = null
var _names: Array[StringName] = []
var _faults: int = 0
var _ticks_before: int = 0
var _saturated_before: int = 0


func _enter_tree() -> void:
	_device = get_parent() as SpidarG
	update_configuration_warnings()
	if _device == null and not Engine.is_editor_hint():
		push_warning("SpidarGMonitors shows nothing: make it a child of a SpidarG node.")
	if _device == null or not OS.is_debug_build() or Engine.is_editor_hint():
		return
	if not ClassDB.class_exists(&"SpidarG"):
		return # Without the add-on's library a SpidarG is a stand-in, which has nothing to measure.
	_device.fault_raised.connect(_count_fault)
	_add("servo_rate_hz", _statistic.bind("servo_rate_hz"))
	_add("lateness_p99_us", _statistic.bind("lateness_p99_us"))
	_add("step_p99_us", _statistic.bind("step_p99_us"))
	_add("missed_deadlines", _statistic.bind("missed_deadlines"))
	_add("saturated_percent", _saturated_percent)
	_add("faults", func() -> int: return _faults)
	if not _device.get_simulated_truth().is_empty():
		_add("energy_to_hand_mj", _energy_mj)


func _exit_tree() -> void:
	for monitor: StringName in _names:
		Performance.remove_custom_monitor(monitor)
	_names.clear()
	if _device != null and _device.fault_raised.is_connected(_count_fault):
		_device.fault_raised.disconnect(_count_fault)
	_device = null


func _get_configuration_warnings() -> PackedStringArray:
	if get_parent() is SpidarG:
		return []
	return ["SpidarGMonitors shows nothing here: make it a child of a SpidarG node."]


## Returns the names of the monitors that this node has added, as [method Performance.get_custom_monitor] takes them.
func get_monitor_names() -> Array[StringName]:
	return _names


func _add(quantity: String, reader: Callable) -> void:
	var monitor := StringName("%s/%s" % [GROUP, quantity])
	if Performance.has_custom_monitor(monitor):
		monitor = StringName("%s %s/%s" % [GROUP, _device.name, quantity])
	# Devices of one name in several places of the tree.
	var number: int = 2
	while Performance.has_custom_monitor(monitor):
		monitor = StringName("%s %s %d/%s" % [GROUP, _device.name, number, quantity])
		number += 1
	Performance.add_custom_monitor(monitor, reader)
	_names.append(monitor)


func _count_fault(_status: int, _message: String) -> void:
	_faults += 1


func _statistic(key: String) -> float:
	return _device.get_statistics()[key]


# Returns the percentage of saturated cycles since the last call.
func _saturated_percent() -> float:
	var numbers: Dictionary = _device.get_statistics()
	var ticks: int = numbers["ticks"] - _ticks_before
	var saturated: int = numbers["saturated_ticks"] - _saturated_before
	_ticks_before = numbers["ticks"]
	_saturated_before = numbers["saturated_ticks"]
	return clampf(100.0 * saturated / ticks, 0.0, 100.0) if ticks > 0 else 0.0


func _energy_mj() -> float:
	return 1000.0 * float(_device.get_simulated_truth().get("energy_to_hand_j", 0.0))
