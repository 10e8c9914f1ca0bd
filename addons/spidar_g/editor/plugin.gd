@tool
extends EditorPlugin
## Adds the calibration panel of the inspector, the 3-D view of SpidarG nodes, and a menu item: the physics settings that
## small held things need. The nodes work without this plugin.

const CalibrationInspector := preload("calibration/calibration_inspector.gd")
const GizmoPlugin := preload("gizmo/gizmo_plugin.gd")
const ViewMenu := preload("gizmo/view_menu.gd")

const MENU_ITEM: String = "SPIDAR-G: Apply Physics Settings"
## Jolt lets a squeezed 3 mm stick rest on a floor; its defaults of 20 mm for the other two are larger than the stick.
const SETTINGS: Dictionary[String, Variant] = {
	"physics/3d/physics_engine": "Jolt Physics",
	"physics/jolt_physics_3d/simulation/penetration_slop": 0.0005,
	"physics/jolt_physics_3d/simulation/speculative_contact_distance": 0.002,
}

var _calibration: CalibrationInspector = CalibrationInspector.new()
var _gizmos: GizmoPlugin = null
var _view_menu: ViewMenu = null


func _enter_tree() -> void:
	_calibration.history = get_undo_redo()
	add_inspector_plugin(_calibration)
	add_tool_menu_item(MENU_ITEM, _ask)
	_gizmos = GizmoPlugin.new()
	add_node_3d_gizmo_plugin(_gizmos)
	_gizmos.start()
	_view_menu = ViewMenu.new()
	_view_menu.options = _gizmos.options
	add_control_to_container(CONTAINER_SPATIAL_EDITOR_MENU, _view_menu)


func _exit_tree() -> void:
	_calibration.close_all()
	remove_inspector_plugin(_calibration)
	remove_control_from_container(CONTAINER_SPATIAL_EDITOR_MENU, _view_menu)
	_view_menu.queue_free()
	_gizmos.stop()
	remove_node_3d_gizmo_plugin(_gizmos)
	_gizmos = null
	remove_tool_menu_item(MENU_ITEM)


## Shows what would change; nothing is written before the answer.
func _ask() -> void:
	var changes: PackedStringArray = []
	for path: String in SETTINGS:
		var now: Variant = ProjectSettings.get_setting(path, "unset")
		if now != SETTINGS[path]:
			changes.append("%s: %s -> %s" % [path, now, SETTINGS[path]])
	var dialog: ConfirmationDialog = ConfirmationDialog.new()
	dialog.title = MENU_ITEM
	dialog.dialog_text = "\n".join(changes) if changes.size() > 0 else "All settings are in place already."
	dialog.confirmed.connect(_apply)
	dialog.visibility_changed.connect(
		func() -> void:
			if not dialog.visible:
				dialog.queue_free()
	)
	EditorInterface.popup_dialog_centered(dialog)


func _apply() -> void:
	for path: String in SETTINGS:
		ProjectSettings.set_setting(path, SETTINGS[path])
	var error: Error = ProjectSettings.save()
	if error != OK:
		push_error("SPIDAR-G: project.godot could not be saved: %s" % error_string(error))
		return
	print("SPIDAR-G: physics settings saved; the physics engine changes when the editor is started again.")
