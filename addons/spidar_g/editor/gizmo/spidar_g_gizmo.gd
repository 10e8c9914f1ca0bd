@tool
extends EditorNode3DGizmo
## Draws one SpidarG in the editor: frame, strings and grip. While the node is selected, the numbers at the corners, the
## workspace box, the closure map and the force capacity at the probe are drawn too, as far as the options select them. The
## probe is the grip itself, which a handle drags. Handles on the frame change its size.
##
## The gizmo is redrawn only if the node reports a change or the selection or the options change. SpidarGWorkspace computes
## the strings, the map, the box and the capacity.

const Shapes := preload("workspace_shapes.gd")
const View := preload("../../nodes/spidar_g_view.gd")
const ViewOptions := preload("view_options.gd")

enum Handle { SIZE_X, SIZE_Y, SIZE_Z, PROBE }

# Made by the plugin.
const LINE_MATERIAL: String = "spidar_g_lines"
const HANDLE_MATERIAL: String = "spidar_g_handles"
const SOLID_MATERIAL: String = "spidar_g_solid"
const GLASS_MATERIAL: String = "spidar_g_glass"
const TEXT_MATERIAL: String = "spidar_g_text"

const FRAME_COLOUR: Color = Color(0.62, 0.66, 0.72)
const BOX_COLOUR: Color = Color(0.35, 0.60, 0.95, 0.55)
const CAPACITY_COLOUR: Color = Color(0.35, 0.65, 1.00, 0.16)
const CAPACITY_EDGE_COLOUR: Color = Color(0.45, 0.72, 1.00, 0.45)
const POLE_RADIUS_M: float = 0.0022
const KNOT_RADIUS_M: float = 0.004
const MAP_CELLS: int = 24
## The number of cells along each side of the map for a rigid grip. It is smaller, because the closure of a rigid grip takes
## forty times as long to compute.
const RIGID_MAP_CELLS: int = 10
## The TextMesh.pixel_size of the texts. Their material has a fixed size, so they look equally large at any distance.
const TEXT_PIXEL: float = 0.0013
const NUMBER_SIZE: int = 22
const REPORT_SIZE: int = 18
## The smallest size to which a handle can drag the frame, in meters.
const LEAST_SIZE_M: float = 0.1
const LARGEST_SIZE_M: float = 5.0
const SIZE_STEP_M: float = 0.001
const FAR_M: float = 1000.0
## The position of the probe's handle relative to the grip's center, in meters. There it does not cover the arrows with which
## the editor moves the node.
const PROBE_HANDLE_M: Vector3 = Vector3(-0.05, -0.05, 0.0)
## The height of the report above the frame, in meters. There it does not cover the numbers at the corners.
const REPORT_HEIGHT_M: float = 0.09

var options: ViewOptions
var shapes: Shapes
## The position in the device frame at which the grip is probed, in meters.
var probe_m: Vector3 = Vector3.ZERO
## The number of times that the gizmo was drawn. Tests check that it does not grow in an idle editor.
var draw_count: int = 0

var _workspace := SpidarGWorkspace.new()
var _rod := CylinderMesh.new()
var _knot := SphereMesh.new()


func _init() -> void:
	_rod.top_radius = 1.0
	_rod.bottom_radius = 1.0
	_rod.height = 1.0
	_rod.radial_segments = 8
	_rod.rings = 1
	_knot.radius = 1.0
	_knot.height = 2.0
	_knot.radial_segments = 12
	_knot.rings = 6


func _redraw() -> void:
	clear()
	draw_count += 1
	var device: SpidarG = get_node_3d() as SpidarG
	_workspace.config = device.get_effective_config()
	if _workspace.get_problem() != "":
		return  # The node's configuration warning says what.
	var scale: float = device.workspace_scale
	var selected: bool = EditorInterface.get_selection().get_selected_nodes().has(device)
	if not selected:
		probe_m = Vector3.ZERO
	var motors: PackedVector3Array = _workspace.get_motor_positions()
	_draw_frame(motors, scale)
	_draw_grip(motors, scale)
	if not selected:
		return
	var box: PackedVector3Array = _workspace.get_box()
	if options.box:
		_lines(Shapes.box_lines(box[0], box[1]), scale, BOX_COLOUR)
	if options.numbers:
		_draw_numbers(motors, scale)
	if options.map != ViewOptions.Map.NONE:
		_draw_map(box, scale)
	if options.capacity:
		_draw_capacity(_above(motors), scale)
	_draw_handles(device, scale)


func _get_handle_name(id: int, _secondary: bool) -> String:
	return "Probe" if id == Handle.PROBE else "Frame size %s" % "xyz"[id]


func _get_handle_value(id: int, _secondary: bool) -> Variant:
	if id == Handle.PROBE:
		return probe_m
	return (get_node_3d() as SpidarG).config.frame_size


func _set_handle(id: int, _secondary: bool, camera: Camera3D, point: Vector2) -> void:
	var device: SpidarG = get_node_3d() as SpidarG
	var placed: Transform3D = device.global_transform
	placed.basis = placed.basis.orthonormalized().scaled(Vector3.ONE * device.workspace_scale)
	var to_device: Transform3D = placed.affine_inverse()
	var from: Vector3 = to_device * camera.project_ray_origin(point)
	var along: Vector3 = (to_device.basis * camera.project_ray_normal(point)).normalized()
	if id == Handle.PROBE:
		drag_probe(from, along, (to_device.basis * camera.global_basis.z).normalized())
	else:
		drag_size(id, from, along)


func _commit_handle(id: int, _secondary: bool, restore: Variant, cancel: bool) -> void:
	if id == Handle.PROBE:
		if cancel:
			probe_m = restore
			get_node_3d().update_gizmos()
		return
	var config: SpidarGConfig = (get_node_3d() as SpidarG).config
	if cancel:
		config.frame_size = restore
		return
	var undo: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	undo.create_action("Set SPIDAR-G Frame Size")
	undo.add_do_property(config, &"frame_size", config.frame_size)
	undo.add_undo_property(config, &"frame_size", restore)
	undo.commit_action()


## Moves the probe so that its handle is where the ray from `from` along `along` meets the plane through the handle with the
## normal `facing`. The probe stays inside the frame. All vectors are in the device frame.
func drag_probe(from: Vector3, along: Vector3, facing: Vector3) -> void:
	var met: Variant = Plane(facing, probe_m + PROBE_HANDLE_M).intersects_ray(from, along)
	if met == null:
		return
	var motors: PackedVector3Array = _workspace.get_motor_positions()
	probe_m = ((met as Vector3) - PROBE_HANDLE_M).clamp(_low(motors), _high(motors))
	get_node_3d().update_gizmos()


## Sets the size of the frame along `axis` (0 to 2), so that the middle of the frame's side is at the point of this axis that
## is nearest to the ray from `from` along `along`. The ray is in the device frame.
func drag_size(axis: int, from: Vector3, along: Vector3) -> void:
	var config: SpidarGConfig = (get_node_3d() as SpidarG).config
	var unit: Vector3 = Vector3.ZERO
	unit[axis] = 1.0
	var nearest: PackedVector3Array = Geometry3D.get_closest_points_between_segments(
		Vector3.ZERO, unit * FAR_M, from, from + along * FAR_M
	)
	var size: Vector3 = config.frame_size
	size[axis] = clampf(snappedf(2.0 * nearest[0][axis], SIZE_STEP_M), LEAST_SIZE_M, LARGEST_SIZE_M)
	config.frame_size = size


## Returns a text with the position of the probe, and the closure margin and the capacities of the strings there.
func report() -> String:
	if _workspace.get_problem() != "":
		return _workspace.get_problem()
	var pose := Transform3D(Basis.IDENTITY, probe_m)
	var forces: PackedFloat64Array = _workspace.get_force_capacity(pose, 0.0, shapes.few_directions())
	var moments: PackedFloat64Array = _workspace.get_moment_capacity(pose, 0.0, shapes.few_directions())
	var margin: float = _workspace.get_closure_margin(pose, 0.0)
	var place: String = "x %.0f  y %.0f  z %.0f mm" % [1e3 * probe_m.x, 1e3 * probe_m.y, 1e3 * probe_m.z]
	if not (margin > 0.0):
		return place + "\nno closure: the strings\ncannot hold the grip here"
	var lines: PackedStringArray = [
		place,
		"closure %.2f" % margin,
		"every way %.1f N, %.2f N m" % [_least(forces), _least(moments)],
		"at best %.1f N, %.2f N m" % [_most(forces), _most(moments)],
	]
	var grasp: Vector2 = _workspace.get_grasp_capacity(pose, 0.0)
	if grasp != Vector2.ZERO:
		lines.append("grasp closes %.2f, opens %.2f N m" % [grasp.x, grasp.y])
	return "\n".join(lines)


func _draw_frame(motors: PackedVector3Array, scale: float) -> void:
	var edges: PackedVector3Array = Shapes.box_lines(_low(motors), _high(motors))
	_lines(edges, scale, FRAME_COLOUR)
	add_collision_segments(_scaled(edges, scale))
	for motor: Vector3 in motors:
		_solid(_knot, Transform3D(Basis.from_scale(Vector3.ONE * KNOT_RADIUS_M), motor), scale)


func _draw_grip(motors: PackedVector3Array, scale: float) -> void:
	var pose := Transform3D(Basis.IDENTITY, probe_m)
	var ends: PackedVector3Array = _workspace.get_attachment_points(pose, 0.0)
	var tensions: PackedFloat64Array = _workspace.get_tensions(pose, 0.0, Vector3.ZERO, Vector3.ZERO, 0.0)
	var largest_n: float = _max_tension_n()
	var drawn: PackedVector3Array = []
	for string: int in motors.size():
		_lines([motors[string], ends[string]], scale, View.tension_colour(tensions[string], largest_n))
		if not drawn.has(ends[string]):
			drawn.append(ends[string])
			_solid(_rod, Shapes.rod(probe_m, ends[string], POLE_RADIUS_M), scale)
			_solid(_knot, Transform3D(Basis.from_scale(Vector3.ONE * KNOT_RADIUS_M), ends[string]), scale)


func _draw_numbers(motors: PackedVector3Array, scale: float) -> void:
	var middle: Vector3 = 0.5 * (_low(motors) + _high(motors))
	for string: int in motors.size():
		var outward: Vector3 = 0.03 * (motors[string] - middle).normalized()
		_text(str(string + 1), NUMBER_SIZE, scale * (motors[string] + outward))


func _draw_map(box: PackedVector3Array, scale: float) -> void:
	var axis: int = {ViewOptions.Map.XY: 2, ViewOptions.Map.YZ: 0, ViewOptions.Map.XZ: 1}[options.map]
	var cells: int = RIGID_MAP_CELLS if _is_rigid() else MAP_CELLS
	var points: PackedVector3Array = Shapes.map_points(box[0], box[1], probe_m, axis, cells)
	var margins: PackedFloat64Array = _workspace.get_closure_margins(points, Basis.IDENTITY, 0.0)
	_glass(Shapes.map_mesh(points, margins, cells), Vector3.ZERO, scale)


# Draws the force capacity at the probe, and the report at `above`.
func _draw_capacity(above: Vector3, scale: float) -> void:
	var pose := Transform3D(Basis.IDENTITY, probe_m)
	var directions: PackedVector3Array = shapes.directions
	var forces: PackedFloat64Array = _workspace.get_force_capacity(pose, 0.0, directions)
	_glass(shapes.capacity_mesh(forces, CAPACITY_COLOUR), probe_m, scale)
	var edges: PackedVector3Array = Transform3D(Basis.IDENTITY, probe_m) * shapes.capacity_lines(forces)
	_lines(edges, scale, CAPACITY_EDGE_COLOUR)
	_text(report(), REPORT_SIZE, scale * above)


func _draw_handles(device: SpidarG, scale: float) -> void:
	var handles: PackedVector3Array = []
	var ids: PackedInt32Array = []
	if device.config != null and device.config.preset == 0:
		for axis: int in 3:
			var face: Vector3 = Vector3.ZERO
			face[axis] = 0.5 * scale * device.config.frame_size[axis]
			handles.append(face)
			ids.append(axis)
	handles.append(scale * (probe_m + PROBE_HANDLE_M))
	ids.append(Handle.PROBE)
	add_handles(handles, get_plugin().get_material(HANDLE_MATERIAL, self), ids)


func _lines(lines: PackedVector3Array, scale: float, colour: Color) -> void:
	var material: StandardMaterial3D = get_plugin().get_material(LINE_MATERIAL, self)
	add_lines(_scaled(lines, scale), material, false, colour)


func _solid(mesh: Mesh, at: Transform3D, scale: float) -> void:
	add_mesh(mesh, get_plugin().get_material(SOLID_MATERIAL, self), _scaled_transform(at, scale))


func _glass(mesh: Mesh, at: Vector3, scale: float) -> void:
	var material: StandardMaterial3D = get_plugin().get_material(GLASS_MATERIAL, self)
	add_mesh(mesh, material, _scaled_transform(Transform3D(Basis.IDENTITY, at), scale))


func _text(text: String, size: int, at: Vector3) -> void:
	var mesh := TextMesh.new()
	mesh.text = text
	mesh.font_size = size
	mesh.pixel_size = TEXT_PIXEL
	mesh.depth = 0.0
	mesh.vertical_alignment = VERTICAL_ALIGNMENT_BOTTOM
	add_mesh(mesh, get_plugin().get_material(TEXT_MATERIAL, self), Transform3D(Basis.IDENTITY, at))


func _is_rigid() -> bool:
	return _workspace.config != null and _workspace.config.preset > 1


func _max_tension_n() -> float:
	return _workspace.config.tension_max if _workspace.config != null else 10.0


static func _scaled(points: PackedVector3Array, scale: float) -> PackedVector3Array:
	return Transform3D(Basis.from_scale(Vector3.ONE * scale), Vector3.ZERO) * points


static func _scaled_transform(at: Transform3D, scale: float) -> Transform3D:
	return Transform3D(Basis.from_scale(Vector3.ONE * scale) * at.basis, scale * at.origin)


# Returns a point above the middle of the frame's top.
static func _above(motors: PackedVector3Array) -> Vector3:
	var middle: Vector3 = 0.5 * (_low(motors) + _high(motors))
	return Vector3(middle.x, _high(motors).y + REPORT_HEIGHT_M, middle.z)


static func _low(points: PackedVector3Array) -> Vector3:
	var low: Vector3 = points[0]
	for point: Vector3 in points:
		low = low.min(point)
	return low


static func _high(points: PackedVector3Array) -> Vector3:
	var high: Vector3 = points[0]
	for point: Vector3 in points:
		high = high.max(point)
	return high


static func _least(values: PackedFloat64Array) -> float:
	var least: float = INF
	for value: float in values:
		least = minf(least, value)
	return least


static func _most(values: PackedFloat64Array) -> float:
	var most: float = 0.0
	for value: float in values:
		most = maxf(most, value)
	return most
