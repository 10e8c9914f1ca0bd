## What the inspector says of the devices that the nodes of an edited scene ask for, and of their hands.
extends "res://test_case.gd"

const Claims := preload("res://addons/spidar_g/editor/claims/scene_claims.gd")
const Tracker := preload("res://addons/spidar_g/nodes/spidar_g_tracker.gd")

const ONE: Dictionary = {"kind": "hid", "product": "SPIDAR-G", "serial": "A1", "path": "/dev/hidraw0", "owner": ""}
const OTHER: Dictionary = {"kind": "hid", "product": "SPIDAR-G", "serial": "", "path": "/dev/hidraw1", "owner": ""}
const PORT: Dictionary = {"kind": "serial", "product": "Bridge", "serial": "77", "path": "/dev/ttyUSB0", "owner": ""}

var root: Node3D
var left: SpidarG
var right: SpidarG


func test_a_device_in_use_names_node_and_hand() -> void:
	_set_up(SpidarGConfig.TRANSPORT_DEVICE)
	left.config.device_serial = "A1"
	check_equal(Claims.use_of(ONE, right.config, root), "in use by Left (left hand)", "seen from the other node")
	check_equal(Claims.use_of(ONE, left.config, root), "", "seen from itself")
	check_equal(Claims.use_of(OTHER, right.config, root), "", "a free one")
	right.config.device_serial = "/dev/hidraw1"
	check_equal(Claims.use_of(OTHER, left.config, root), "in use by Right (right hand)", "one without a serial, by its path")
	check_equal(Claims.summary(left, root), "Left Hand: device A1.", "the node says hand and device")
	root.free()


func test_two_nodes_on_one_device_are_told() -> void:
	_set_up(SpidarGConfig.TRANSPORT_DEVICE)
	left.config.device_serial = "A1"
	right.config.device_serial = "A1"
	check_equal(Claims.use_of(ONE, null, root), "in use by Left (left hand) and Right (right hand)", "both are named")
	var told: String = Claims.summary(right, root)
	check(told.contains("In use by Left (left hand), too") and told.contains("device_serial"), told)
	root.free()


func test_two_nodes_that_choose_nothing_are_told() -> void:
	_set_up(SpidarGConfig.TRANSPORT_AUTOMATIC)
	var told: String = Claims.summary(left, root)
	check(told.contains("first free") and told.contains("Right (right hand)") and told.contains("device_serial"), told)
	left.config = null
	check(Claims.summary(left, root).contains("first free"), "a node without a config is automatic: %s" % Claims.summary(left, root))
	right.free()
	check_equal(Claims.summary(left, root), "Left Hand: the first free device.", "alone")
	root.free()


func test_serial_ports_and_simulated_devices_have_claims_of_their_own() -> void:
	_set_up(SpidarGConfig.TRANSPORT_SERIAL)
	left.config.serial_port = "/dev/ttyUSB0"
	check_equal(Claims.use_of(PORT, right.config, root), "in use by Left (left hand)", "a port goes by its path")
	check_equal(Claims.use_of(ONE, right.config, root), "", "and is no HID device")
	for device: SpidarG in [left, right] as Array[SpidarG]:
		device.config.transport = SpidarGConfig.TRANSPORT_SIMULATED
	check_equal(Claims.summary(left, root), "Left Hand: simulated device.", "private ones share nothing")
	left.config.device_name = "desk"
	right.config.device_name = "desk"
	check(Claims.summary(left, root).contains("In use by Right (right hand), too"), Claims.summary(left, root))
	root.free()


func test_what_is_open_in_the_editor_is_told() -> void:
	_set_up(SpidarGConfig.TRANSPORT_DEVICE)
	var open_now: Dictionary = ONE.duplicate()
	open_now["owner"] = "the calibration"
	check_equal(Claims.use_of(open_now, left.config, root), "open now in the calibration", "an owner of this process")
	root.free()


func test_hands_by_path_and_by_a_name_of_their_own() -> void:
	_set_up(SpidarGConfig.TRANSPORT_DEVICE)
	var third := SpidarG.new()
	third.name = "Third"
	root.add_child(third)
	check_equal(Claims.title_of(third, root), "Third", "without a tracker there is no hand")
	check(Claims.summary(third, root).begins_with("No hand: "), Claims.summary(third, root))
	var tracker: Tracker = Tracker.new()
	tracker.hand = Tracker.Hand.OTHER
	tracker.custom_name = &"pen"
	tracker.spidar_path = ^"../Third"
	root.add_child(tracker)
	check_equal(Claims.title_of(third, root), "Third (tracker pen)", "a tracker elsewhere that means it")
	root.free()


## Two nodes with a tracker each. Not in the tree: as in an edited scene no device is opened.
func _set_up(transport: SpidarGConfig.Transport) -> void:
	root = Node3D.new()
	left = _device("Left", Tracker.Hand.LEFT, transport)
	right = _device("Right", Tracker.Hand.RIGHT, transport)


func _device(named: String, hand: Tracker.Hand, transport: SpidarGConfig.Transport) -> SpidarG:
	var device := SpidarG.new()
	device.name = named
	device.config = SpidarGConfig.new()
	device.config.transport = transport
	var tracker: Tracker = Tracker.new()
	tracker.hand = hand
	device.add_child(tracker)
	root.add_child(device)
	return device
