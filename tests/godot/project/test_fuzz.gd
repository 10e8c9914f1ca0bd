## Wrong arguments: each setter and method of the library's classes is called with values of every type. Nothing pulls
## without being switched on, no number becomes NaN, and each refusal names what was refused.
## The quick run makes some thousand calls. User argument "calls=N" makes N (the stress stage gives a million).
extends "res://test_case.gd"

const QUICK_CALLS: int = 6000
## Calls between two looks at the device.
const LOOK_EVERY: int = 50
## Files, and simulated time by the minute: not by chance. Signals and lives of the node are the engine's.
const LEFT_OUT: PackedStringArray = [
	"start_recording", "start_replay", "arm", "advance_cycles", "compute", "get_force_capacity",
	"get_moment_capacity", "get_closure_margins", "check_geometry", "zero_device",
]

var _random := RandomNumberGenerator.new()
var _messages: PackedStringArray = []


func test_text_never_switches_forces_on() -> void:
	var device: SpidarG = await _open_device()
	for bad: Variant in ["off", "false", "", 1, 0.0, NAN, null, Vector3.ONE, [true], {}]:
		_messages.clear()
		device.set("forces_enabled", bad)
		check(not device.forces_enabled, "%s does not switch forces on" % [bad])
		_check_named("forces_enabled", bad)
		_messages.clear()
		device.set("release_on_focus_loss", bad)
		check(device.release_on_focus_loss, "%s keeps release_on_focus_loss" % [bad])
		_check_named("release_on_focus_loss", bad)
	device.advance_cycles(1600)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "never armed")
	device.set("forces_enabled", true)
	device.advance_cycles(1600)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "a bool arms it")
	device.set("forces_enabled", "on")
	check(device.forces_enabled, "a text does not switch them off either")
	device.free()


func test_properties_of_a_wrong_type_keep_their_value() -> void:
	var device: SpidarG = await _open_device()
	var config: SpidarGConfig = device.config
	var calibration := SpidarGCalibration.new()
	device.calibration = calibration
	for case: Array in [["config", Resource.new(), config], ["config", calibration, config], ["config", "res://x.tres", config],
			["calibration", SpidarGConfig.new(), calibration], ["calibration", 7, calibration],
			["workspace_scale", "big", 1.0], ["workspace_scale", NAN, 1.0], ["workspace_scale", -1.0, 1.0],
			["workspace_scale", 1e9, 1.0], ["workspace_scale", null, 1.0],
			["drive_mode", "Threaded", SpidarG.DRIVE_STEPPED], ["drive_mode", 7, SpidarG.DRIVE_STEPPED],
			["drive_mode", 1 << 32, SpidarG.DRIVE_STEPPED], ["drive_mode", 0.5, SpidarG.DRIVE_STEPPED],
			["enabled", "no", true], ["enabled", null, true]]:
		_messages.clear()
		device.set(case[0], case[1])
		check_equal(device.get(case[0]), case[2], "%s after %s" % [case[0], case[1]])
		_check_named(case[0], case[1])
	await physics_frames(2)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "the device stays open")
	device.config = null
	check(device.config == null, "null takes the config away")
	device.free()


func test_resources_refuse_values_of_a_wrong_type() -> void:
	var wrong: Array = ["soft", null, Vector2.ONE, [1, 2], {}, true, Resource.new(), &"x", ^"y"]
	for resource: Resource in [SpidarGConfig.new(), SpidarGCalibration.new()]:
		for property: Dictionary in resource.get_property_list():
			var name: String = property["name"]
			if not ClassDB.class_has_method(resource.get_class(), "set_" + name, true):
				continue
			var before: Variant = resource.get(name)
			for value: Variant in wrong:
				if typeof(value) == typeof(before) or (before is String and value is StringName):
					continue
				if value is Array and (before is PackedFloat64Array or before is PackedInt32Array):
					continue
				resource.set(name, value)
				check(resource.get(name) == before, "%s.%s after %s" % [resource.get_class(), name, value])
			if before is float:
				resource.set(name, 1)
				check_equal(resource.get(name), 1.0, "%s takes a whole number" % name)
			if before is int:
				resource.set(name, 1 << 40)
				check_equal(resource.get(name), before, "%s has 32 bits" % name)
	check_equal(SpidarGConfig.new().get_problem(), "", "the defaults are sound")


func test_a_transform_that_is_no_place_keeps_the_last_one() -> void:
	var device: SpidarG = await _open_device()
	device.position = Vector3(0, 1, 0)
	check_near(device.get_grip_transform().origin.y, 1.0, 0.01, "moved with the node")
	for bad: Transform3D in [Transform3D(Basis.IDENTITY, Vector3(NAN, 0, 0)), Transform3D(Basis.IDENTITY, Vector3(0, INF, 0)),
			Transform3D(Basis(Vector3.ZERO, Vector3.ZERO, Vector3.ZERO), Vector3.ZERO),
			Transform3D(Basis(Vector3(NAN, 0, 0), Vector3.UP, Vector3.BACK), Vector3.ZERO)]:
		_messages.clear()
		device.transform = bad
		check(device.get_grip_transform().is_finite(), "the grip stays finite at %s" % bad)
		check(_messages.size() == 1 and _messages[0].contains("transform"), "told once: %s" % [_messages])
		check(device.request_wrench(Vector3.UP, Vector3.ZERO, 0.0), "requests go on")
		device.advance_cycles(20)
		check(_all_finite(device.get_requested_wrench()), "in finite numbers")
		device.position = Vector3(0, 1, 0)
		device.basis = Basis.IDENTITY
		device.get_grip_transform()
	device.free()


func test_a_hand_refuses_numbers_that_make_no_sense() -> void:
	var hand := SpidarGHand.new()
	var checked: int = 0
	for property: Dictionary in ClassDB.class_get_property_list("SpidarGHand", true):
		if property["type"] != TYPE_FLOAT:
			continue
		if not (int(property["usage"]) & PROPERTY_USAGE_STORAGE):
			continue
		checked += 1
		var before: float = hand.get(property["name"])
		for bad: Variant in [NAN, INF, -INF, -1.0, 1e30, "soft", null, true, Vector3.ONE]:
			hand.set(property["name"], bad)
			check_equal(hand.get(property["name"]), before, "%s after %s" % [property["name"], bad])
		hand.set(property["name"], 0.5)
		check_equal(hand.get(property["name"]), 0.5, "%s takes a number" % property["name"])
	check_equal(checked, 8, "settings of the hand")
	hand.free()


func test_calls_with_values_of_every_type() -> void:
	_random.seed = 20240611
	var calls: int = QUICK_CALLS
	for argument: String in OS.get_cmdline_user_args():
		if argument.begins_with("calls="):
			calls = argument.trim_prefix("calls=").to_int()
	var device: SpidarG = await _open_device()
	var targets: Array[Object] = [device, device, device, SpidarGConfig.new(), SpidarGCalibration.new(), SpidarGWorkspace.new(), SpidarGCalibrator.new()]
	var methods: Array[Array] = []
	for target: Object in targets:
		methods.append(_methods_of(target))
		check(methods[-1].size() > 2, "%s has methods" % target.get_class())
	Engine.print_error_messages = false
	var look_every: int = maxi(LOOK_EVERY, calls / 8000)  # The runner bounds the frames of a test.
	var pulled: int = 0
	var bad_numbers: int = 0
	var refused: int = 0
	for i: int in calls:
		var which: int = _random.randi_range(0, targets.size() - 1)
		var method: Dictionary = methods[which][_random.randi_range(0, methods[which].size() - 1)]
		var arguments: Array = []
		for argument: Dictionary in method["args"]:
			arguments.append(_value(argument["type"]))
		var name: StringName = method["name"]
		if name == &"set_forces_enabled" and arguments[0] is bool:
			continue  # The one value that may switch them on.
		_messages.clear()
		var answer: Variant = targets[which].callv(name, arguments)
		refused += _messages.size()
		# A resource gives back what it was given; its get_problem() names it, and no device opens with it.
		if not targets[which] is Resource and not _is_sound(answer):
			bad_numbers += 1
			check(false, "%s%s answers %s" % [name, arguments, answer])
		if device.forces_enabled:
			pulled += 1
			device.forces_enabled = false
		if i % look_every == 0:
			device.enabled = true
			device.drive_mode = SpidarG.DRIVE_STEPPED
			await physics_frames(1)
			for tension: float in device.get_string_tensions():
				pulled += 0 if tension == 0.0 else 1
			if not _all_finite(device.get_requested_wrench()) or not device.get_grip_transform().is_finite():
				bad_numbers += 1
	Engine.print_error_messages = true
	print("INFO %d fuzzed calls, %d refusals of SpidarG" % [calls, refused])
	check_equal(pulled, 0, "nothing pulled")
	check_equal(bad_numbers, 0, "answers that are no numbers")
	check(refused > calls / 20, "refusals are told")
	device.free()


func _open_device() -> SpidarG:
	var device: SpidarG = ideal_device()
	device.request_rejected.connect(func(message: String) -> void: _messages.append(message))
	add(device)
	await physics_frames(2)
	check_equal(device.get_state(), SpidarG.STATE_CONNECTED, "open")
	return device


func _check_named(field: String, value: Variant) -> void:
	if not check(_messages.size() == 1, "%s = %s is told once: %s" % [field, value, _messages]):
		return
	check(_messages[0].contains(field) and _messages[0].contains("give "), "named with a remedy: %s" % _messages[0])


func _methods_of(target: Object) -> Array:
	var found: Array = []
	for method: Dictionary in ClassDB.class_get_method_list(target.get_class(), true):
		if not LEFT_OUT.has(method["name"]) and not str(method["name"]).begins_with("_"):
			found.append(method)
	for property: Dictionary in ClassDB.class_get_property_list(target.get_class(), true):
		var setter: StringName = ClassDB.class_get_property_setter(target.get_class(), property["name"])
		if setter != &"" and not found.any(func(m: Dictionary) -> bool: return m["name"] == setter):
			found.append({"name": setter, "args": [{"type": property["type"]}]})
	return found


## Mostly of the type that is asked for, so that the values behind the type are met too.
func _value(wanted: int) -> Variant:
	var type: int = wanted if _random.randf() < 0.6 else _random.randi_range(0, TYPE_MAX - 1)
	match type:
		TYPE_BOOL:
			return _random.randf() < 0.5
		TYPE_INT:
			return [0, 1, -1, 2, 3, 5, 7, 8, 127, 255, 1 << 31, -(1 << 40), _random.randi()][_random.randi_range(0, 12)]
		TYPE_FLOAT:
			return _real()
		TYPE_STRING:
			return ["", "off", "true", "1", "Gerät", "a".repeat(300)][_random.randi_range(0, 5)]
		TYPE_STRING_NAME:
			return &"off"
		TYPE_NODE_PATH:
			return ^"off/on"
		TYPE_VECTOR3:
			return Vector3(_real(), _real(), _real())
		TYPE_VECTOR2:
			return Vector2(_real(), _real())
		TYPE_BASIS:
			return Basis(Vector3(_real(), _real(), _real()), Vector3.UP, Vector3.BACK) if _random.randf() < 0.5 else Basis.IDENTITY
		TYPE_TRANSFORM3D:
			return Transform3D(_value(TYPE_BASIS) if _random.randf() < 0.3 else Basis.IDENTITY, Vector3(_real(), _real(), _real()))
		TYPE_QUATERNION:
			return Quaternion(_real(), _real(), _real(), _real())
		TYPE_ARRAY:
			return [[], [1.0, 2], ["x"], [null, NAN], [1, 2, 3, 4, 5, 6, 7, 8]][_random.randi_range(0, 4)]
		TYPE_DICTIONARY:
			return {"a": 1}
		TYPE_PACKED_FLOAT64_ARRAY:
			var reals := PackedFloat64Array()
			for _i: int in [0, 1, 7, 8, 12, 24, 96, 108][_random.randi_range(0, 7)]:
				reals.append(_real())
			return reals
		TYPE_PACKED_INT32_ARRAY:
			return PackedInt32Array([1, -1, 0x7fffffff])
		TYPE_PACKED_VECTOR3_ARRAY:
			return PackedVector3Array([Vector3.UP, Vector3(_real(), 0, 0)])
		TYPE_OBJECT:
			return [null, Resource.new(), SpidarGConfig.new(), SpidarGCalibration.new(), RefCounted.new(), tree][_random.randi_range(0, 5)]
		TYPE_CALLABLE:
			return Callable(self, "_real")
		TYPE_COLOR:
			return Color.RED
		_:
			return type_convert(null, type)


func _real() -> float:
	return [0.0, 1.0, -1.0, 0.05, 0.3, 60.0, NAN, INF, -INF, 1e30, -1e308, 1e-320, _random.randfn(0.0, 2.0)][_random.randi_range(0, 12)]


func _is_sound(answer: Variant) -> bool:
	match typeof(answer):
		TYPE_FLOAT:
			var number: float = answer
			return not is_nan(number)
		TYPE_VECTOR3:
			var vector: Vector3 = answer
			return vector.is_finite()
		TYPE_TRANSFORM3D:
			var transform: Transform3D = answer
			return transform.is_finite()
		TYPE_PACKED_FLOAT64_ARRAY:
			var reals: PackedFloat64Array = answer
			return _all_finite(reals)
	return true


func _all_finite(values: PackedFloat64Array) -> bool:
	for value: float in values:
		if not is_finite(value):
			return false
	return true
