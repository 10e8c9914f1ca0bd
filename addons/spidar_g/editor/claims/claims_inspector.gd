@tool
extends EditorInspectorPlugin
## Shows in the inspector which device a SpidarG node selects and which hand the node is. For a SpidarGConfig, it offers the
## devices that are plugged in.

const DeviceChooser := preload("device_chooser.gd")
const SceneClaims := preload("scene_claims.gd")

const REFRESH_S: float = 1.0
const KINDS: Dictionary[String, String] = {"device_serial": SceneClaims.HID, "serial_port": SceneClaims.SERIAL}


func _can_handle(object: Object) -> bool:
	return object is SpidarG or object is SpidarGConfig


func _parse_begin(object: Object) -> void:
	var device: SpidarG = object as SpidarG
	var root: Node = EditorInterface.get_edited_scene_root()
	if device == null or root == null:
		return
	var label: Label = Label.new()
	label.name = "SpidarGClaim"
	label.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	label.custom_minimum_size = Vector2(120, 0)
	# The config may be edited below the node, and other nodes elsewhere.
	var timer: Timer = Timer.new()
	timer.autostart = true
	timer.wait_time = REFRESH_S
	timer.timeout.connect(_show_claim.bind(label, device.get_instance_id()))
	label.add_child(timer)
	_show_claim(label, device.get_instance_id())
	add_custom_control(label)


# Takes the id of the node, because the label may exist for a moment after the node was freed.
func _show_claim(label: Label, id: int) -> void:
	var device: SpidarG = instance_from_id(id) as SpidarG
	var root: Node = EditorInterface.get_edited_scene_root()
	if device != null and root != null:
		label.text = SceneClaims.summary(device, root)


func _parse_property(
	object: Object, _type: Variant.Type, name: String, _hint: PropertyHint, _text: String, _usage: int, _wide: bool
) -> bool:
	if not object is SpidarGConfig or not KINDS.has(name):
		return false
	add_property_editor(name, DeviceChooser.new(KINDS[name]))
	return true
