@tool
extends EditorPlugin
## Writes five times a second what a user of the editor sees: where the controls of the calibration panel and of open
## dialogs are, what they say, and what the edited scene holds. Changes nothing.

const Target := preload("res://addons/spidar_g/editor/calibration/calibration_target.gd")

const INTERVAL_S: float = 0.2

var _path: String = ""
var _count: int = 0
var _since_s: float = 0.0


func _enter_tree() -> void:
	_path = OS.get_environment("SPIDAR_G_WATCH")


func _process(delta: float) -> void:
	_since_s += delta
	if _path.is_empty() or _since_s < INTERVAL_S:
		return
	_since_s = 0.0
	_count += 1
	var told: Dictionary = {"count": _count, "controls": {}, "scene": "", "nodes": {}, "selected": ""}
	_tell_controls(EditorInterface.get_base_control().get_tree().root, told["controls"], false)
	var root: Node = EditorInterface.get_edited_scene_root()
	if root != null:
		told["scene"] = root.scene_file_path
		_tell_nodes(root, told["nodes"])
	var selected: Array[Node] = EditorInterface.get_selection().get_selected_nodes()
	if selected.size() > 0:
		told["selected"] = selected[0].get_class()
	var edited: Object = EditorInterface.get_inspector().get_edited_object()
	told["inspected"] = edited.get_class() if edited != null else ""
	var file: FileAccess = FileAccess.open(_path + ".part", FileAccess.WRITE)
	file.store_string(JSON.stringify(told, "", true, true))
	file.close()
	DirAccess.rename_absolute(_path + ".part", _path)


## Everything of the panel by its name; of dialogs every line to type in and every button, as DIALOG/TEXT.
func _tell_controls(node: Node, into: Dictionary, in_panel: bool) -> void:
	for child: Node in node.get_children(true):
		var control: Control = child as Control
		var inside: bool = in_panel or String(child.name) == "SpidarGCalibrationPanel"
		if control != null and control.is_visible_in_tree():
			var window: Window = control.get_window()
			var title: String = window.title if window != null else ""
			if inside:
				into[String(child.name)] = _tell(control)
			elif control is Button and not (control as Button).text.is_empty():
				into["%s/%s" % [title, (control as Button).text]] = _tell(control)
			elif control is LineEdit and (control as LineEdit).editable:
				into["%s/edit %s" % [title, (control as LineEdit).placeholder_text]] = _tell(control)
		if child is PopupMenu and (child as PopupMenu).visible:
			_tell_menu(child as PopupMenu, into)
		_tell_controls(child, into, inside)


## The lines of an open menu, all of one height.
func _tell_menu(menu: PopupMenu, into: Dictionary) -> void:
	for item: int in menu.item_count:
		var y: float = menu.position.y + menu.size.y * (item + 0.5) / menu.item_count
		into["menu/" + menu.get_item_text(item)] = {
			"x": menu.position.x + 0.5 * menu.size.x, "y": y, "disabled": menu.is_item_disabled(item), "text": ""
		}


func _tell(control: Control) -> Dictionary:
	var rect: Rect2 = control.get_global_rect()
	var window: Window = control.get_window()
	var offset: Vector2 = Vector2(window.position) if window.is_embedded() else Vector2.ZERO
	var told: Dictionary = {"x": rect.get_center().x + offset.x, "y": rect.get_center().y + offset.y, "h": rect.size.y}
	var button: BaseButton = control as BaseButton
	told["disabled"] = button != null and button.disabled
	told["text"] = str(control.get("text")) if "text" in control else ""
	if control is Range:
		told["value"] = (control as Range).value
	return told


func _tell_nodes(node: Node, into: Dictionary) -> void:
	var device: SpidarG = node as SpidarG
	if device != null:
		var told: Dictionary = {"preset": -1, "calibrated": device.calibration != null}
		if device.config != null:
			told["preset"] = device.config.preset
			var config: SpidarGConfig = Target.config_of(device)
			told["offset_errors"] = Array(config.simulated_offset_errors)
			told["gain_errors"] = Array(config.simulated_gain_errors)
			told["tension_gains"] = Array(config.simulated_tension_gains)
		if device.calibration != null:
			told["path"] = device.calibration.resource_path
			told["offsets"] = Array(device.calibration.string_offsets)
			told["scales"] = Array(device.calibration.string_scales)
			told["zero_counts"] = Array(device.calibration.zero_counts)
			told["found_gains"] = Array(device.calibration.tension_gains)
		into[String(node.name)] = told
	for child: Node in node.get_children():
		_tell_nodes(child, into)
