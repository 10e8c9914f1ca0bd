@tool
extends EditorProperty
## Edits SpidarGConfig.device_serial or SpidarGConfig.serial_port: a text field, and a menu of the devices that are plugged
## in, with the nodes that use each device.

const SceneClaims := preload("scene_claims.gd")

## Returns the list of devices, as SpidarG.list_devices() does. Tests replace it.
static var list_devices: Callable = SpidarG.list_devices

var _kind: String
var _line: LineEdit = LineEdit.new()
var _menu: MenuButton = MenuButton.new()
var _use: Label = Label.new()


func _init(kind: String) -> void:
	_kind = kind
	name = "SpidarGChooser_" + kind
	var row: HBoxContainer = HBoxContainer.new()
	_line.name = "Line"
	_line.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_line.text_submitted.connect(func(_text: String) -> void: _submit(_line.text))
	_line.focus_exited.connect(func() -> void: _submit(_line.text))
	row.add_child(_line)
	_menu.name = "Menu"
	_menu.text = "Choose"
	_menu.flat = false
	_menu.tooltip_text = "The devices that are plugged in, and the nodes of this scene that use them."
	_menu.about_to_popup.connect(fill_menu)
	_menu.get_popup().index_pressed.connect(_choose)
	row.add_child(_menu)
	add_child(row)
	add_focusable(_line)
	_use.name = "Use"
	_use.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	_use.custom_minimum_size = Vector2(120, 0)
	add_child(_use)
	set_bottom_editor(_use)


## Fills the menu with the devices that are plugged in now. Called each time before the menu opens.
func fill_menu() -> void:
	var popup: PopupMenu = _menu.get_popup()
	popup.clear()
	popup.add_item("(empty) the first that is free" if _kind == SceneClaims.HID else "(empty) the only port")
	popup.set_item_metadata(0, "")
	for listed: Dictionary in list_devices.call():
		if listed["kind"] == _kind:
			var choice: String = SceneClaims.choice_of(listed)
			var use: String = SceneClaims.use_of(listed, _config(), EditorInterface.get_edited_scene_root())
			popup.add_item("%s %s%s" % [listed["product"], choice, "" if use.is_empty() else ": " + use])
			popup.set_item_metadata(-1, choice)
	if popup.item_count == 1:
		popup.add_item("no device is plugged in" if _kind == SceneClaims.HID else "no serial port of a USB bridge")
		popup.set_item_disabled(-1, true)


func _update_property() -> void:
	var value: String = get_edited_object().get(get_edited_property())
	if _line.text != value:
		_line.text = value
	var listed: Dictionary = {"kind": _kind, "serial": value, "path": value}
	_use.text = "" if value.is_empty() else SceneClaims.use_of(listed, _config(), EditorInterface.get_edited_scene_root())
	_use.visible = not _use.text.is_empty()


func _set_read_only(read_only: bool) -> void:
	_line.editable = not read_only
	_menu.disabled = read_only


func _choose(index: int) -> void:
	_submit(_menu.get_popup().get_item_metadata(index))


func _submit(value: String) -> void:
	if value != get_edited_object().get(get_edited_property()):
		emit_changed(get_edited_property(), value)


func _config() -> SpidarGConfig:
	return get_edited_object() as SpidarGConfig
