@tool
extends RefCounted
## Adds the calibration panel and the label that states which node uses which device to the inspector, and the 3D view of
## SpidarG nodes to the scene editor.

const CalibrationInspector := preload("calibration/calibration_inspector.gd")
const ClaimsInspector := preload("claims/claims_inspector.gd")
const GizmoPlugin := preload("gizmo/gizmo_plugin.gd")
const ViewMenu := preload("gizmo/view_menu.gd")

var _plugin: EditorPlugin
var _calibration: CalibrationInspector = CalibrationInspector.new()
var _claims: ClaimsInspector = ClaimsInspector.new()
var _gizmos: GizmoPlugin = GizmoPlugin.new()
var _view_menu: ViewMenu = ViewMenu.new()


func _init(plugin: EditorPlugin) -> void:
	_plugin = plugin
	_calibration.history = plugin.get_undo_redo()
	plugin.add_inspector_plugin(_calibration)
	plugin.add_inspector_plugin(_claims)
	plugin.add_node_3d_gizmo_plugin(_gizmos)
	_gizmos.start()
	_view_menu.options = _gizmos.options
	plugin.add_control_to_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_MENU, _view_menu)


## Removes everything that this object has added to the editor. The object must not be used afterwards.
func remove() -> void:
	_calibration.close_all()
	_plugin.remove_inspector_plugin(_calibration)
	_plugin.remove_inspector_plugin(_claims)
	_plugin.remove_control_from_container(EditorPlugin.CONTAINER_SPATIAL_EDITOR_MENU, _view_menu)
	_view_menu.queue_free()
	_gizmos.stop()
	_plugin.remove_node_3d_gizmo_plugin(_gizmos)
