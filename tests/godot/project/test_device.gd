## Which device a node opens, what it says of it, and the device's buttons.
extends "res://test_case.gd"

## No device has this name, whatever is plugged into the machine that runs the tests.
const NOBODY: String = "no such device"

var _refusals: PackedStringArray = []
var _buttons: Array[Array] = []


## Keeps what reaches the game as input.
class Listener:
	extends Node
	var events: Array[InputEventJoypadButton] = []

	func _input(event: InputEvent) -> void:
		if event is InputEventJoypadButton:
			events.append(event as InputEventJoypadButton)


func _device(transport: int) -> SpidarG:
	var config := SpidarGConfig.new()
	config.transport = transport
	config.device_product = NOBODY
	var device := SpidarG.new()
	device.config = config
	device.request_rejected.connect(_on_refused)
	device.button_changed.connect(_on_button)
	return device


func _on_refused(message: String) -> void:
	_refusals.append(message)


func _on_button(button: int, pressed: bool) -> void:
	_buttons.append([button, pressed])


func test_without_a_device_the_simulated_one_stands_in_and_says_so() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_AUTOMATIC)
	add(device)
	check(await until(is_open.bind(device)), "open")
	var info: Dictionary = device.get_device_info()
	check_equal(info["simulated"], true, "simulated")
	check((info["fallback_reason"] as String).length() > 20, "the reason is told: %s" % info["fallback_reason"])
	check(device.set_simulated_hand_target(Transform3D(), 0.0), "and it has a hand")
	device.free()


func test_simulated_looks_for_no_device() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_SIMULATED)
	add(device)
	check(await until(is_open.bind(device)), "open")
	check_equal(device.get_device_info()["fallback_reason"], "", "nothing was sought")
	device.free()


func test_a_device_that_must_be_real_stays_closed_without() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_DEVICE)
	add(device)
	await frames(3)
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed")
	check(device.get_fault_text().contains("plugged in"), "says why: %s" % device.get_fault_text())
	device.config.transport = SpidarGConfig.TRANSPORT_SIMULATED
	check(await until(is_open.bind(device)), "opens when the simulated one is chosen")
	device.free()


func test_a_device_that_does_not_open_is_told_once() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_DEVICE)
	var told: Array[String] = []
	var raised: Array[String] = []
	device.device_event.connect(func(event: Dictionary) -> void: told.append(event["name"]))
	device.fault_raised.connect(func(_code: int, message: String) -> void: raised.append(message))
	add(device)
	await frames(5)
	OS.delay_msec(1200) # it is tried again each second
	await frames(5)
	check_equal(told, ["open_failed"] as Array[String], "one event")
	check_equal(raised.size(), 1, "one fault")
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed")
	device.free()


func test_a_stepped_node_cannot_have_a_real_device() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_DEVICE)
	device.drive_mode = SpidarG.DRIVE_STEPPED
	add(device)
	await frames(2)
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed")
	check(device.get_fault_text().contains("drive_mode"), "says why: %s" % device.get_fault_text())
	device.free()


func test_settings_that_no_device_can_have_are_refused() -> void:
	var config := SpidarGConfig.new()
	config.device_vendor_id = 70000
	check(config.get_problem().contains("device_vendor_id = 70000"), config.get_problem())
	config.device_vendor_id = 0x1209
	check_equal(config.get_problem(), "", "a good number")
	config.device_product_id = -1
	check(config.get_problem().contains("device_product_id"), config.get_problem())
	config.device_product_id = 0
	config.transport = 4
	check(config.get_problem().contains("transport = 4"), config.get_problem())
	config.transport = SpidarGConfig.TRANSPORT_SERIAL
	check_equal(config.get_problem(), "", "serial boards")
	config.serial_motors = PackedInt32Array([1, 0, 1, 1])
	check(config.get_problem().contains("serial_motors has 4 numbers"), config.get_problem())
	var motors := PackedInt32Array()
	for string in 8:
		motors.append_array([1, string, 1, -1])
	config.serial_motors = motors
	check_equal(config.get_problem(), "", "a motor for each string")
	motors[2] = 0
	config.serial_motors = motors
	check(config.get_problem().contains("string 1"), config.get_problem())
	config.serial_motors = PackedInt32Array()
	config.serial_most_units = 5000
	check(config.get_problem().contains("serial_most_units"), config.get_problem())
	config.serial_most_units = 1024
	config.serial_units_per_ampere = -1.0
	check(config.get_problem().contains("serial_units_per_ampere"), config.get_problem())


func test_a_serial_port_that_is_not_there_is_told() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_SERIAL)
	device.config.serial_port = "/dev/spidar_no_such_port"
	add(device)
	await frames(3)
	check_equal(device.get_state(), SpidarG.STATE_CLOSED, "closed")
	check(device.get_fault_text().contains("/dev/spidar_no_such_port"), "names it: %s" % device.get_fault_text())
	device.free()


func test_zeroing_is_for_real_devices() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_SIMULATED)
	add(device)
	check(await until(is_open.bind(device)), "open")
	check_equal(device.zero_device(), false, "refused")
	check(_refusals.size() == 1 and _refusals[0].contains("zero_device"), "and told: %s" % [_refusals])
	device.free()


func test_buttons_arrive_as_input_events_and_as_a_signal() -> void:
	var device := _device(SpidarGConfig.TRANSPORT_SIMULATED)
	device.drive_mode = SpidarG.DRIVE_STEPPED
	device.config.button_device = 19
	var listener := Listener.new()
	add(listener)
	add(device)
	await physics_frames(3)
	check_equal(device.set_simulated_buttons(256), false, "more buttons than there are")
	check(device.set_simulated_buttons(0b101), "pressed")
	await physics_frames(4)
	check(device.set_simulated_buttons(0b100), "one let go")
	await physics_frames(4)
	await frames(2)
	check_equal(_buttons, [[0, true], [2, true], [0, false]], "signals")
	check_equal(listener.events.size(), 3, "input events")
	for i: int in listener.events.size():
		check_equal(listener.events[i].button_index, _buttons[i][0], "button of event %d" % i)
		check_equal(listener.events[i].pressed, _buttons[i][1], "state of event %d" % i)
		check_equal(listener.events[i].device, 19, "device of event %d" % i)
	device.free()
	listener.free()
