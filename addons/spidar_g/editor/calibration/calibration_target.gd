@tool
extends RefCounted
## Represents what the panel calibrates: a SpidarG node, or a SpidarGCalibration alone. Each change of the scene or of the
## resource is one action that can be undone.

const NAMES: PackedStringArray = [
	"string_offsets", "string_scales", "zero_counts", "effective_radii", "torque_constants", "tension_gains", "max_currents"
]
## The standard deviation of the random errors of the string lengths in practice, in meters.
const PRACTICE_OFFSET_M: float = 0.005
const PRACTICE_COMMON_GAIN: float = 0.03
const PRACTICE_GAIN: float = 0.005
const PRACTICE_TENSION: float = 0.12

# The config of each node in practice, by the instance id of the node. The scene does not contain these configs.
static var _practice: Dictionary[int, SpidarGConfig] = {}

var node: SpidarG
## The calibration that is edited alone, or [code]null[/code] for a node.
var resource: SpidarGCalibration


func get_config() -> SpidarGConfig:
	return config_of(node)


## Returns the config to calibrate with. For a node in practice it is the config of the practice.
static func config_of(device: SpidarG) -> SpidarGConfig:
	if not is_instance_valid(device):
		return null
	return _practice.get(device.get_instance_id(), device.config)


func is_practice() -> bool:
	return is_instance_valid(node) and _practice.has(node.get_instance_id())


func end_practice() -> void:
	if is_instance_valid(node):
		_practice.erase(node.get_instance_id())


func get_calibration() -> SpidarGCalibration:
	return node.calibration if is_instance_valid(node) and resource == null else resource


## Applies the result `made`. A node gets it as its calibration. A calibration that is edited alone gets its values, so that
## all nodes that use this resource have them.
func accept(history: Object, made: SpidarGCalibration) -> void:
	history.call("create_action", "Calibrate SPIDAR-G")
	if resource == null:
		history.call("add_do_property", node, "calibration", made)
		history.call("add_undo_property", node, "calibration", node.calibration)
	else:
		for property: String in NAMES:
			# Copies: what the history holds must not change with the resource.
			history.call("add_do_property", resource, property, made.get(property).duplicate())
			history.call("add_undo_property", resource, property, resource.get(property).duplicate())
	history.call("commit_action")


func set_preset(history: Object, preset: int) -> void:
	_change_config(history, "Choose SPIDAR-G Preset", {"preset": preset})


## Gives the node a simulated device with unknown errors, for practice and for tests, until [method end_practice] is called.
## The node keeps its own config.
func draw_practice_errors(random: RandomNumberGenerator) -> void:
	if not is_instance_valid(node):
		return
	var offsets: PackedFloat64Array = []
	var gains: PackedFloat64Array = []
	var tensions: PackedFloat64Array = []
	var common: float = random.randf_range(-PRACTICE_COMMON_GAIN, PRACTICE_COMMON_GAIN)
	for _string: int in 8:
		offsets.append(clampf(random.randfn(0.0, PRACTICE_OFFSET_M), -4.0 * PRACTICE_OFFSET_M, 4.0 * PRACTICE_OFFSET_M))
		gains.append(common + clampf(random.randfn(0.0, PRACTICE_GAIN), -4.0 * PRACTICE_GAIN, 4.0 * PRACTICE_GAIN))
		tensions.append(1.0 + random.randf_range(-PRACTICE_TENSION, PRACTICE_TENSION))
	var config: SpidarGConfig = node.get_effective_config().duplicate()
	config.transport = SpidarGConfig.TRANSPORT_SIMULATED
	config.device_name = ""
	config.simulated_offset_errors = offsets
	config.simulated_gain_errors = gains
	config.simulated_tension_gains = tensions
	_practice[node.get_instance_id()] = config


func _change_config(history: Object, action: String, values: Dictionary[String, Variant]) -> void:
	if not is_instance_valid(node):
		return
	history.call("create_action", action)
	if node.config == null:
		var config: SpidarGConfig = SpidarGConfig.new()
		for property: String in values:
			config.set(property, values[property])
		history.call("add_do_property", node, "config", config)
		history.call("add_undo_property", node, "config", null)
	else:
		for property: String in values:
			history.call("add_do_property", node.config, property, values[property])
			history.call("add_undo_property", node.config, property, node.config.get(property))
	history.call("commit_action")
