extends Node3D
## Holds the meshes of SpidarGView. They are made once by code and then only moved. All positions are in world coordinates.

## The number of strings that a device has.
const STRINGS: int = 8
## The thickness of the edges of the frame, in meters of device motion, as all sizes below whose names end in _M.
const EDGE_M: float = 0.004
const STRING_RADIUS_M: float = 0.0009
const POLE_RADIUS_M: float = 0.0022
const KNOT_RADIUS_M: float = 0.0035
const HINGE_RADIUS_M: float = 0.005
const HEMISPHERE_RADIUS_M: float = 0.02
const RIGID_BALL_RADIUS_M: float = 0.011
const STOP_DISTANCE_M: float = 0.012
const STOP_RADIUS_M: float = 0.0015
const ARROW_RADIUS_M: float = 0.0022
## The radius of the rounded edge of a pad as a share of the pad's radius. It is half the thickness of the pad.
const PAD_EDGE: float = 0.25

const FRAME_COLOUR: Color = Color(0.45, 0.48, 0.53)
const POLE_COLOURS: Array[Color] = [Color(0.93, 0.55, 0.22), Color(0.25, 0.62, 0.70)]
const METAL_COLOUR: Color = Color(0.82, 0.83, 0.86)
const PAD_COLOUR: Color = Color(0.16, 0.18, 0.22)
const FORCE_COLOUR: Color = Color(0.85, 0.15, 0.55)
## The alpha of the hemispheres, which are translucent so that a held body inside the grip can be seen.
const GLASS_ALPHA: float = 0.22

var frame: MultiMeshInstance3D
var strings: MultiMeshInstance3D
var grip: Node3D
var pads: Node3D
var arrow: Node3D

var _scale: float = 1.0
var _rods: Array[MeshInstance3D] = []
var _knots: MultiMeshInstance3D
# The parts of a rigid grip: a ball, and a spoke to the end of each string.
var _ball: MeshInstance3D
var _spokes: MultiMeshInstance3D
var _poles: Array[Node3D] = []
var _stops: Array[MeshInstance3D] = []
var _pads: Array[Node3D] = []
var _shaft: MeshInstance3D
var _tip: MeshInstance3D


func _init() -> void:
	var unit_box: BoxMesh = BoxMesh.new()
	frame = _many(unit_box, 12, _matte(FRAME_COLOUR), false)
	strings = _many(_cylinder(1.0, 1.0, 1.0, 8), STRINGS, _by_instance_colour(), true)
	grip = Node3D.new()
	add_child(grip)
	_knots = _many(_sphere(1.0), STRINGS, _matte(METAL_COLOUR), false)
	_spokes = _many(_cylinder(1.0, 1.0, 1.0, 12), STRINGS, _matte(METAL_COLOUR), false)
	for part: MultiMeshInstance3D in [_knots, _spokes]:
		remove_child(part)
		grip.add_child(part)
	_ball = _one(_sphere(RIGID_BALL_RADIUS_M), POLE_COLOURS[0])
	_ball.material_override = _glass(POLE_COLOURS[0])
	_ball.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	grip.add_child(_ball)
	for pole: int in 2:
		_make_pole(pole)
	_make_pads()
	_make_arrow()
	for part: GeometryInstance3D in [frame, strings]:
		part.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF


## Sets the kind of the grip and the sizes. All parts must be placed again afterwards.
func size_for(workspace_scale: float, pole_half_length_m: float, is_rigid: bool) -> void:
	_scale = workspace_scale
	_ball.visible = is_rigid
	_spokes.visible = is_rigid
	_knots.multimesh.visible_instance_count = STRINGS if is_rigid else 4
	for part: Node3D in _poles + _stops:
		part.visible = not is_rigid
	for rod: MeshInstance3D in _rods:
		(rod.mesh as CylinderMesh).height = 2.0 * pole_half_length_m


func place_frame(at: Transform3D, size: Vector3) -> void:
	var index: int = 0
	for axis: int in 3:
		for corner: int in 4:
			var centre: Vector3 = 0.5 * size
			centre[axis] = 0.0
			centre[(axis + 1) % 3] *= 1.0 if corner & 1 else -1.0
			centre[(axis + 2) % 3] *= 1.0 if corner & 2 else -1.0
			var span: Vector3 = Vector3.ONE * (EDGE_M * _scale)
			span[axis] += size[axis]
			frame.multimesh.set_instance_transform(
				index, at * Transform3D(Basis.from_scale(span), centre)
			)
			index += 1


func place_string(string: int, from: Vector3, to: Vector3) -> void:
	var placed: Transform3D = _between(from, to, STRING_RADIUS_M * _scale)
	strings.multimesh.set_instance_transform(string, placed)


func colour_string(string: int, colour: Color) -> void:
	strings.multimesh.set_instance_color(string, colour)


func place_knot(end: int, at: Vector3) -> void:
	var size: Basis = Basis.from_scale(Vector3.ONE * (KNOT_RADIUS_M * _scale))
	_knots.multimesh.set_instance_transform(end, Transform3D(size, at))


## Places the ball and the spokes of a rigid grip. `ends` has [method SpidarG.get_string_end] of each string.
func place_rigid_grip(at: Transform3D, ends: PackedVector3Array) -> void:
	_ball.global_transform = Transform3D(at.basis * Basis.from_scale(Vector3.ONE * _scale), at.origin)
	for string: int in ends.size():
		place_knot(string, ends[string])
		_spokes.multimesh.set_instance_transform(
			string, _between(at.origin, ends[string], POLE_RADIUS_M * _scale)
		)


## Places the poles and the stops of a crossed grip. `pole1` and `pole2` are [method SpidarG.get_pole_transform]. The stops
## are on pole 2, where pole 1 meets them at `closed_angle`.
func place_grip(at: Transform3D, pole1: Transform3D, pole2: Transform3D, closed_angle: float) -> void:
	_poles[0].global_transform = pole1.scaled_local(Vector3.ONE * _scale)
	_poles[1].global_transform = pole2.scaled_local(Vector3.ONE * _scale)
	# The pin's middle is a rod's and a pin's radius before the line of pole 1.
	var crossing: float = 0.5 * PI - closed_angle - asin((POLE_RADIUS_M + STOP_RADIUS_M) / STOP_DISTANCE_M)
	for side: int in 2:
		var outward: float = -1.0 if side == 0 else 1.0
		var along: Vector3 = Vector3(cos(crossing), sin(crossing), 0.0) * (STOP_DISTANCE_M * outward)
		var pin: Basis = at.basis * Basis.from_scale(Vector3.ONE * _scale)
		_stops[side].global_transform = Transform3D(
			pin * Basis(Vector3.RIGHT, 0.5 * PI), pole2 * (along * _scale)
		)


## Places a pad. The origin of `at` is the middle of the pad's inner face, and its x axis points outward.
func place_pad(side: int, at: Transform3D, radius: float) -> void:
	# The disc's axis is Y.
	var size: Basis = Basis.from_scale(Vector3.ONE * radius)
	_pads[side].global_transform = Transform3D(
		at.basis * Basis(Vector3.BACK, -0.5 * PI) * size, at * Vector3(PAD_EDGE * radius, 0.0, 0.0)
	)


func place_arrow(from: Vector3, along: Vector3) -> void:
	var width: float = ARROW_RADIUS_M * _scale
	var head: Vector3 = along.limit_length(5.0 * width)
	_shaft.global_transform = _between(from, from + along - 0.5 * head, width)
	_tip.global_transform = _between(from + along - head, from + along, 2.5 * width)


func _make_pole(pole: int) -> void:
	var node: Node3D = Node3D.new()
	grip.add_child(node)
	_poles.append(node)
	var rod: MeshInstance3D = _one(_cylinder(POLE_RADIUS_M, POLE_RADIUS_M, 0.08, 12), POLE_COLOURS[pole])
	rod.rotation.z = 0.5 * PI
	node.add_child(rod)
	_rods.append(rod)
	var half: MeshInstance3D = _one(_hemisphere(HEMISPHERE_RADIUS_M), POLE_COLOURS[pole])
	half.material_override = _glass(POLE_COLOURS[pole])
	half.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	half.rotation.x = 0.5 * PI if pole == 0 else -0.5 * PI
	node.add_child(half)
	if pole == 0:
		var hinge: MeshInstance3D = _one(
			_cylinder(HINGE_RADIUS_M, HINGE_RADIUS_M, 0.01, 16), METAL_COLOUR
		)
		hinge.rotation.x = 0.5 * PI
		node.add_child(hinge)
	else:
		var plate: MeshInstance3D = _one(_cylinder(0.0145, 0.0145, 0.0012, 24), METAL_COLOUR)
		plate.rotation.x = 0.5 * PI
		plate.position.z = -0.004
		node.add_child(plate)
		for _side: int in 2:
			var pin: MeshInstance3D = _one(_cylinder(STOP_RADIUS_M, STOP_RADIUS_M, 0.008, 8), METAL_COLOUR)
			grip.add_child(pin)
			_stops.append(pin)


func _make_pads() -> void:
	pads = Node3D.new()
	add_child(pads)
	var edge: TorusMesh = TorusMesh.new()
	edge.outer_radius = 1.0
	edge.inner_radius = 1.0 - 2.0 * PAD_EDGE
	edge.ring_segments = 8
	edge.rings = 24
	for _side: int in 2:
		var pad: Node3D = Node3D.new()
		pad.add_child(_one(edge, PAD_COLOUR))
		pad.add_child(_one(_cylinder(1.0 - PAD_EDGE, 1.0 - PAD_EDGE, 2.0 * PAD_EDGE, 24), PAD_COLOUR))
		pads.add_child(pad)
		_pads.append(pad)


func _make_arrow() -> void:
	arrow = Node3D.new()
	add_child(arrow)
	_shaft = _one(_cylinder(1.0, 1.0, 1.0, 10), FORCE_COLOUR)
	_tip = _one(_cylinder(0.0, 1.0, 1.0, 12), FORCE_COLOUR)
	for part: MeshInstance3D in [_shaft, _tip]:
		part.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
		var material: StandardMaterial3D = part.material_override
		material.no_depth_test = true  # A force at the grip's centre would else hide in the held body.
		material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
		arrow.add_child(part)


# Returns the transform of a unit cylinder along Y that makes it a rod from `from` to `to`.
static func _between(from: Vector3, to: Vector3, radius: float) -> Transform3D:
	var along: Vector3 = to - from
	var length: float = along.length()
	if not (length > 1e-9):
		return Transform3D(Basis.from_scale(Vector3.ONE * 1e-9), from)
	var y: Vector3 = along / length
	var x: Vector3 = y.cross(Vector3.RIGHT if absf(y.x) < 0.9 else Vector3.UP).normalized()
	return Transform3D(Basis(x * radius, along, x.cross(y) * radius), 0.5 * (from + to))


func _many(mesh: Mesh, count: int, material: Material, coloured: bool) -> MultiMeshInstance3D:
	var instance: MultiMeshInstance3D = MultiMeshInstance3D.new()
	var multi: MultiMesh = MultiMesh.new()
	multi.transform_format = MultiMesh.TRANSFORM_3D
	multi.use_colors = coloured
	multi.mesh = mesh
	multi.instance_count = count
	instance.multimesh = multi
	instance.material_override = material
	add_child(instance)
	return instance


static func _one(mesh: Mesh, colour: Color) -> MeshInstance3D:
	var instance: MeshInstance3D = MeshInstance3D.new()
	instance.mesh = mesh
	instance.material_override = _matte(colour)
	return instance


static func _cylinder(top: float, bottom: float, height: float, sides: int) -> CylinderMesh:
	var mesh: CylinderMesh = CylinderMesh.new()
	mesh.top_radius = top
	mesh.bottom_radius = bottom
	mesh.height = height
	mesh.radial_segments = sides
	mesh.rings = 1
	return mesh


static func _sphere(radius: float) -> SphereMesh:
	var mesh: SphereMesh = SphereMesh.new()
	mesh.radius = radius
	mesh.height = 2.0 * radius
	mesh.radial_segments = 16
	mesh.rings = 8
	return mesh


static func _hemisphere(radius: float) -> SphereMesh:
	var mesh: SphereMesh = SphereMesh.new()
	mesh.radius = radius
	mesh.height = radius
	mesh.is_hemisphere = true
	mesh.radial_segments = 24
	mesh.rings = 8
	return mesh


static func _matte(colour: Color) -> StandardMaterial3D:
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.albedo_color = colour
	material.roughness = 0.6
	material.cull_mode = BaseMaterial3D.CULL_DISABLED  # Hemispheres are open shells.
	return material


static func _glass(colour: Color) -> StandardMaterial3D:
	var material: StandardMaterial3D = _matte(Color(colour, GLASS_ALPHA))
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	return material


static func _by_instance_colour() -> StandardMaterial3D:
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.vertex_color_use_as_albedo = true
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	return material
