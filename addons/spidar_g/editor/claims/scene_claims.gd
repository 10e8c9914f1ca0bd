@tool
extends RefCounted
## Finds which SpidarG node of a scene selects which device, and which hand each node is. No node of an edited scene opens its
## device, so the configs are read. The key owner of SpidarG.list_devices() names what has a device open in the process of the
## editor, such as a calibration.

const Finder := preload("res://addons/spidar_g/nodes/follow/spidar_finder.gd")

const HID: String = "hid"
const SERIAL: String = "serial"
const SIMULATED: String = "simulated"


## Returns the kind of device that a node with this config selects: SERIAL, SIMULATED or HID. Returns HID for a node without a
## config.
static func kind_of(config: SpidarGConfig) -> String:
	if config == null:
		return HID
	match config.transport:
		SpidarGConfig.TRANSPORT_SERIAL:
			return SERIAL
		SpidarGConfig.TRANSPORT_SIMULATED:
			return SIMULATED
	return HID


## Returns the name of the device that the config selects. Returns an empty string if the config leaves the choice open: the
## node then opens the first free device, the only serial port, or a simulated device of its own.
static func name_of(config: SpidarGConfig) -> String:
	if config == null:
		return ""
	match kind_of(config):
		SERIAL:
			return config.serial_port
		SIMULATED:
			return config.device_name
	return config.device_serial


## Returns the value of device_serial or serial_port that selects this element of SpidarG.list_devices().
static func choice_of(listed: Dictionary) -> String:
	return listed["path"] if listed["kind"] == SERIAL or String(listed["serial"]).is_empty() else listed["serial"]


## Returns the SpidarG nodes at and below `root` that select the device of this kind and name.
static func claimants(kind: String, name: String, root: Node) -> Array[SpidarG]:
	var found: Array[SpidarG] = []
	for device: SpidarG in devices_in(root):
		if kind_of(device.config) == kind and name_of(device.config) == name:
			found.append(device)
	return found


static func devices_in(root: Node) -> Array[SpidarG]:
	var found: Array[SpidarG] = []
	if root is SpidarG:
		found.append(root)
	for node: Node in root.find_children("*", "SpidarG", true, false) if root != null else ([] as Array[Node]):
		found.append(node)
	return found


## Returns which hand a device is, by the first SpidarGTracker below `root` that follows it: "left hand", "right hand", or
## "tracker" and its custom name. Returns an empty string if no tracker follows the device.
static func hand_of(device: SpidarG, root: Node) -> String:
	for node: Node in root.find_children("*", "Node", true, false):
		var tracker := node as SpidarGTracker
		if tracker == null or Finder.find(tracker, tracker.spidar_path) != device:
			continue
		match tracker.hand:
			SpidarGTracker.Hand.LEFT:
				return "left hand"
			SpidarGTracker.Hand.RIGHT:
				return "right hand"
		return "tracker %s" % tracker.custom_name
	return ""


## Returns the name of a node and its hand, such as "Left (left hand)". Without a hand, returns the name alone.
static func title_of(device: SpidarG, root: Node) -> String:
	var hand: String = hand_of(device, root)
	return String(device.name) if hand.is_empty() else "%s (%s)" % [device.name, hand]


## Returns a text that names the users of this element of SpidarG.list_devices(): the nodes that select it, except those with
## `config`, or else what has the device open. Returns an empty string if there are none.
static func use_of(listed: Dictionary, config: SpidarGConfig, root: Node) -> String:
	var titles: PackedStringArray = []
	for device: SpidarG in claimants(listed["kind"], choice_of(listed), root):
		if device.config != config:
			titles.append(title_of(device, root))
	if not titles.is_empty():
		return "in use by %s" % " and ".join(titles)
	var open_in: String = listed.get("owner", "")
	return "" if open_in.is_empty() else "open now in %s" % open_in


## Returns the text that the inspector shows for a node: its hand, its device, and which other nodes select the same device.
static func summary(device: SpidarG, root: Node) -> String:
	var kind: String = kind_of(device.config)
	var name: String = name_of(device.config)
	var hand: String = hand_of(device, root)
	var text: String = "%s: " % (hand.capitalize() if hand.contains("hand") else "No hand" if hand.is_empty() else hand)
	var others: PackedStringArray = []
	for other: SpidarG in claimants(kind, name, root):
		if other != device:
			others.append(title_of(other, root))
	var rivals: String = " and ".join(others)
	if kind == SIMULATED:
		text += "simulated device" + ("." if name.is_empty() else " %s." % name)
		return text if name.is_empty() or others.is_empty() else text + " In use by %s, too: give each its own device_name." % rivals
	var field: String = "serial_port" if kind == SERIAL else "device_serial"
	if not name.is_empty():
		text += "device %s." % name
		return text if others.is_empty() else text + " In use by %s, too: give each its own %s." % [rivals, field]
	text += "the only serial port." if kind == SERIAL else "the first free device."
	if not others.is_empty():
		text += " So does %s: which node gets which device is left to chance. Choose %s in each config." % [rivals, field]
	return text
