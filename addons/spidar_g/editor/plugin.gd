@tool
extends EditorPlugin
## Adds the calibration panel of the inspector, the 3D view of SpidarG nodes, and a menu item for the physics settings that
## small held bodies need. It also puts stand-in classes into exports for systems without a library. The nodes work without
## this plugin.
##
## Scripts that name the classes of the library do not load if the library is missing, so the plugin loads these scripts only
## if the library exists.

const ExportPlugin := preload("export_plugin.gd")

const MENU_ITEM: String = "SPIDAR-G: Apply Physics Settings"
## The project settings that the menu item proposes. With these settings, Jolt lets a squeezed stick of 3 mm rest on a floor.
## The default of both lengths is 20 mm, which is more than the thickness of the stick.
const SETTINGS: Dictionary[String, Variant] = {
	"physics/3d/physics_engine": "Jolt Physics",
	"physics/jolt_physics_3d/simulation/penetration_slop": 0.0005,
	"physics/jolt_physics_3d/simulation/speculative_contact_distance": 0.002,
}

# The tools of the scene editor, or null without the library.
var _tools: RefCounted = null
var _export: ExportPlugin = null


func _enter_tree() -> void:
	_export = ExportPlugin.new()
	add_export_plugin(_export)
	add_tool_menu_item(MENU_ITEM, _ask)
	if not ClassDB.class_exists(&"SpidarG"):
		push_warning(
			"The SPIDAR-G add-on has no library for this system (%s on %s): its nodes do not exist. "
			% [OS.get_name(), Engine.get_architecture_name()]
			+ "Delete addons/spidar_g/stand_in/.gdignore to load scripts that name them."
		)
		return
	_tools = (load("res://addons/spidar_g/editor/scene_tools.gd") as Script).call(&"new", self)


func _exit_tree() -> void:
	if _tools != null:
		_tools.call(&"remove")
		_tools = null
	remove_tool_menu_item(MENU_ITEM)
	remove_export_plugin(_export)
	_export = null


# Shows what would change. Nothing is written before the user confirms.
func _ask() -> void:
	var changes: PackedStringArray = []
	for path: String in SETTINGS:
		var now: Variant = ProjectSettings.get_setting(path, "unset")
		if now != SETTINGS[path]:
			changes.append("%s: %s -> %s" % [path, _shown(now), _shown(SETTINGS[path])])
	var dialog: ConfirmationDialog = ConfirmationDialog.new()
	dialog.title = MENU_ITEM
	dialog.dialog_text = "\n".join(changes) if changes.size() > 0 else "All settings already have the proposed values."
	dialog.confirmed.connect(_apply)
	dialog.visibility_changed.connect(
		func() -> void:
			if not dialog.visible:
				dialog.queue_free()
	)
	EditorInterface.popup_dialog_centered(dialog)


# A float of the project settings has single precision: 0.02 would be shown as 0.01999999955297.
func _shown(value: Variant) -> String:
	return String.num(value, 6) if value is float else str(value)


func _apply() -> void:
	for path: String in SETTINGS:
		ProjectSettings.set_setting(path, SETTINGS[path])
	var error: Error = ProjectSettings.save()
	if error != OK:
		push_error("SPIDAR-G: project.godot could not be saved: %s" % error_string(error))
		return
	print("SPIDAR-G: physics settings saved; the physics engine changes when the editor is started again.")
