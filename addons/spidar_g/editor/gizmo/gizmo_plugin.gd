@tool
extends EditorNode3DGizmoPlugin
## Draws every SpidarG of the edited scene in the 3D view, with one gizmo for each node.

const Gizmo := preload("spidar_g_gizmo.gd")
const Shapes := preload("workspace_shapes.gd")
const ViewOptions := preload("view_options.gd")

const NAME: String = "SpidarG"

var options := ViewOptions.new()
var shapes := Shapes.new()

var _selected: Array[int] = []  # instance ids


func _init() -> void:
	create_material(Gizmo.LINE_MATERIAL, Color.WHITE, false, false, true)
	create_handle_material(Gizmo.HANDLE_MATERIAL)
	add_material(Gizmo.SOLID_MATERIAL, _plain(Color.WHITE))
	var glass: StandardMaterial3D = _plain(Color.WHITE)
	glass.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	glass.cull_mode = BaseMaterial3D.CULL_DISABLED
	glass.vertex_color_use_as_albedo = true
	glass.vertex_color_is_srgb = true
	glass.render_priority = -1
	add_material(Gizmo.GLASS_MATERIAL, glass)
	var text: StandardMaterial3D = _plain(Color(0.95, 0.95, 0.95))
	text.billboard_mode = BaseMaterial3D.BILLBOARD_ENABLED
	text.billboard_keep_scale = true
	text.fixed_size = true
	text.no_depth_test = true
	add_material(Gizmo.TEXT_MATERIAL, text)
	options.changed.connect(redraw_selected)


## Reads the options, and starts to follow the selection: a device shows more than its frame, strings and grip only while it
## is selected.
func start() -> void:
	options.load_from(EditorInterface.get_editor_settings())
	EditorInterface.get_selection().selection_changed.connect(redraw_selected)


## Stops following the selection, and saves the options.
func stop() -> void:
	options.save_to(EditorInterface.get_editor_settings())
	EditorInterface.get_selection().selection_changed.disconnect(redraw_selected)


## Redraws the selected devices, and those that were selected at the last call.
func redraw_selected() -> void:
	var now: Array[int] = []
	for node: Node in EditorInterface.get_selection().get_selected_nodes():
		if node is SpidarG:
			now.append(node.get_instance_id())
	for id: int in now + _selected:
		var device: SpidarG = instance_from_id(id) as SpidarG if is_instance_id_valid(id) else null
		if device != null:
			device.update_gizmos()
	_selected = now


func _get_gizmo_name() -> String:
	return NAME


func _has_gizmo(node: Node3D) -> bool:
	return node is SpidarG


func _create_gizmo(node: Node3D) -> EditorNode3DGizmo:
	if not _has_gizmo(node):
		return null
	var gizmo := Gizmo.new()
	gizmo.options = options
	gizmo.shapes = shapes
	return gizmo


func _plain(colour: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	material.albedo_color = colour
	material.disable_fog = true
	return material
