@tool
extends "editor_case.gd"
## The claims of devices in the inspector: two nodes, two devices that this script says are plugged in.

const DeviceChooser := preload("res://addons/spidar_g/editor/claims/device_chooser.gd")

const LISTED: Array[Dictionary] = [
	{"kind": "hid", "product": "SPIDAR-G", "serial": "A1", "path": "/dev/hidraw0", "owner": ""},
	{"kind": "hid", "product": "SPIDAR-G", "serial": "B2", "path": "/dev/hidraw1", "owner": ""},
	{"kind": "serial", "product": "Bridge", "serial": "", "path": "/dev/ttyUSB0", "owner": ""},
]


func run(owner: EditorPlugin, _arguments: PackedStringArray) -> int:
	plugin = owner
	DeviceChooser.list_devices = func() -> Array: return LISTED
	var root: Node = await open("res://stage.tscn")
	var left: SpidarG = await _add(root, "Left", SpidarGTracker.Hand.LEFT)
	var right: SpidarG = await _add(root, "Right", SpidarGTracker.Hand.RIGHT)
	left.config.device_serial = "A1"
	await _node_says_its_hand(left)
	await _menu_says_who_uses_a_device(right)
	await _a_choice_is_made_and_undone(right)
	DeviceChooser.list_devices = SpidarG.list_devices
	select([])
	EditorInterface.inspect_object(null)
	await frames()
	EditorInterface.reload_scene_from_path("res://stage.tscn")
	await frames()
	print("%d passed, %d failed" % [passed, failed])
	return failed


func _add(root: Node, named: String, hand: SpidarGTracker.Hand) -> SpidarG:
	var device := SpidarG.new()
	device.name = named
	device.config = SpidarGConfig.new()
	device.config.transport = SpidarGConfig.TRANSPORT_DEVICE
	var tracker := SpidarGTracker.new()
	tracker.hand = hand
	device.add_child(tracker)
	root.add_child(device)
	device.owner = root
	tracker.owner = root
	await frames()
	return device


func _node_says_its_hand(left: SpidarG) -> void:
	EditorInterface.inspect_object(left)
	await frames(5)
	var label: Label = EditorInterface.get_inspector().find_child("SpidarGClaim", true, false) as Label
	if check(label != null, "the inspector of a SpidarG says its claim"):
		check(label.text == "Left Hand: device A1.", label.text)
		left.config.device_serial = "B2"
		var deadline_ms: int = Time.get_ticks_msec() + 5000
		while label.text.contains("A1") and Time.get_ticks_msec() < deadline_ms:
			await frames(1)
		check(label.text == "Left Hand: device B2.", "it follows a change: %s" % label.text)
		left.config.device_serial = "A1"


func _menu_says_who_uses_a_device(right: SpidarG) -> void:
	EditorInterface.inspect_object(right.config)
	await frames(5)
	var hid: DeviceChooser = _chooser("hid")
	var serial: DeviceChooser = _chooser("serial")
	if not check(hid != null and serial != null, "device_serial and serial_port have a chooser"):
		return
	check(_items(hid) == PackedStringArray([
		"(empty) the first that is free", "SPIDAR-G A1: in use by Left (left hand)", "SPIDAR-G B2",
	]), "HID devices: %s" % _items(hid))
	check(_items(serial) == PackedStringArray(["(empty) the only port", "Bridge /dev/ttyUSB0"]),
		"serial ports: %s" % _items(serial))


func _a_choice_is_made_and_undone(right: SpidarG) -> void:
	var chooser: DeviceChooser = _chooser("hid")
	if not check(chooser != null, "there is a chooser"):
		return
	_popup(chooser).index_pressed.emit(1)
	await frames(5)
	check(right.config.device_serial == "A1", "the menu sets device_serial: %s" % right.config.device_serial)
	var use: Label = chooser.find_child("Use", true, false) as Label
	check(use != null and use.visible and use.text == "in use by Left (left hand)", "a device in use is told below the field")
	_popup(chooser).index_pressed.emit(2)
	await frames(5)
	check(right.config.device_serial == "B2" and not use.visible, "a free one says nothing")
	press(KEY_Z, true)
	await frames(5)
	# The editor makes one action of what follows quickly on the same property.
	check(right.config.device_serial == "", "Ctrl+Z takes both choices back: %s" % right.config.device_serial)


func _chooser(kind: String) -> DeviceChooser:
	return EditorInterface.get_inspector().find_child("SpidarGChooser_" + kind, true, false) as DeviceChooser


func _items(chooser: DeviceChooser) -> PackedStringArray:
	chooser.fill_menu()
	var items: PackedStringArray = []
	for index: int in _popup(chooser).item_count:
		items.append(_popup(chooser).get_item_text(index))
	return items


func _popup(chooser: DeviceChooser) -> PopupMenu:
	var menu: MenuButton = chooser.find_child("Menu", true, false) as MenuButton
	chooser.fill_menu()
	return menu.get_popup()
