extends MeshInstance3D
## Draws the depth cue of SpidarGMouseHand: a line from the grip straight down, and a ring on the surface that it meets. The
## mesh is made once and then only moved. Its x and z axes are the plane of the ring, and its y axis is the line.

## The mean radius of the ring is this long, in meters of device motion.
const RING_RADIUS_M: float = 0.008
## The ring lies this far above the surface, in meters of device motion, so that the two do not flicker.
const LIFT_M: float = 0.0005
## Surfaces further down than this are ignored, in meters of device motion.
const RANGE_M: float = 1.0
## The strips of the ring end at these radii, in radii of the ring. Dark edges keep the ring visible on bright surfaces.
const RING_STEPS: PackedFloat32Array = [0.74, 0.84, 1.06, 1.16]
## The strips of the line end at these positions, in radii of the ring. Dark edges keep the line visible on bright surfaces.
const LINE_STEPS: PackedFloat32Array = [-0.10, -0.05, 0.05, 0.10]
const SEGMENTS: int = 40
const EDGE_COLOR: Color = Color(0.05, 0.06, 0.08, 0.55)
const MIDDLE_COLOR: Color = Color(1.0, 1.0, 1.0, 0.95)
## A surface that is steeper than this gets a level ring. The value is the cosine of its slope.
const STEEPEST: float = 0.2

var _hand: SpidarGHand = null


func _init() -> void:
	mesh = _make_mesh()
	cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	gi_mode = GeometryInstance3D.GI_MODE_DISABLED
	# It is placed at the newest pose in each physics tick: there is nothing to interpolate.
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF
	top_level = true
	visible = false


## Sets the color of the line and the ring of the cue.
func set_color(color: Color) -> void:
	(material_override as StandardMaterial3D).albedo_color = color


## Draws the cue below the grip of the device, or hides it if no surface of the layers `mask` is below. Its flat side faces
## `camera`, which may be [code]null[/code].
func show_below(device: SpidarG, mask: int, camera: Camera3D) -> void:
	var workspace_scale: float = device.workspace_scale
	var from: Vector3 = device.get_grip_transform().origin
	var query: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(
		from, from + Vector3.DOWN * (RANGE_M * workspace_scale), mask, _held_by(device)
	)
	# From inside a shape, as between the fingers, the surface below that shape is shown.
	query.hit_from_inside = false
	var hit: Dictionary = get_world_3d().direct_space_state.intersect_ray(query)
	visible = not hit.is_empty()
	if visible:
		var right: Vector3 = camera.global_basis.x if camera != null else Vector3.RIGHT
		_place(from, hit["position"], hit["normal"], workspace_scale, right)


# Returns the body that a SpidarGHand of the device holds. It moves with the grip, so the ray must ignore it.
func _held_by(device: SpidarG) -> Array[RID]:
	if not is_instance_valid(_hand) or _hand.get_parent() != device:
		_hand = null
		for child: Node in device.get_children():
			if child is SpidarGHand:
				_hand = child as SpidarGHand
	var bodies: Array[RID] = []
	if _hand != null and _hand.get_held_body() != null:
		bodies.append(_hand.get_held_body().get_rid())
	return bodies


func _place(from: Vector3, on: Vector3, normal: Vector3, workspace_scale: float, right: Vector3) -> void:
	var up: Vector3 = normal if normal.dot(Vector3.UP) > STEEPEST else Vector3.UP
	var along: Vector3 = right.slide(up).normalized()
	if along.is_zero_approx():
		along = up.cross(Vector3.FORWARD).normalized()
	var radius: float = RING_RADIUS_M * workspace_scale
	var foot: Vector3 = on + up * (LIFT_M * workspace_scale)
	var line: Vector3 = Vector3.UP * maxf(from.y - foot.y, LIFT_M * workspace_scale)
	global_transform = Transform3D(Basis(along * radius, line, along.cross(up) * radius), foot)


func _make_mesh() -> ArrayMesh:
	var tool: SurfaceTool = SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	for strip: int in 3:
		var color: Color = MIDDLE_COLOR if strip == 1 else EDGE_COLOR
		for segment: int in SEGMENTS:
			_add_quad(tool, color, [
				_on_ring(RING_STEPS[strip], segment), _on_ring(RING_STEPS[strip + 1], segment),
				_on_ring(RING_STEPS[strip + 1], segment + 1), _on_ring(RING_STEPS[strip], segment + 1),
			])
		_add_quad(tool, color, [
			Vector3(LINE_STEPS[strip], 0.0, 0.0), Vector3(LINE_STEPS[strip + 1], 0.0, 0.0),
			Vector3(LINE_STEPS[strip + 1], 1.0, 0.0), Vector3(LINE_STEPS[strip], 1.0, 0.0),
		])
	var material: StandardMaterial3D = StandardMaterial3D.new()
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.cull_mode = BaseMaterial3D.CULL_DISABLED
	material.vertex_color_use_as_albedo = true
	material.disable_fog = true
	material_override = material
	return tool.commit()


func _on_ring(radius: float, segment: int) -> Vector3:
	var angle: float = TAU * segment / SEGMENTS
	return Vector3(radius * cos(angle), 0.0, radius * sin(angle))


func _add_quad(tool: SurfaceTool, color: Color, corners: PackedVector3Array) -> void:
	for corner: int in [0, 1, 2, 0, 2, 3]:
		tool.set_color(color)
		tool.add_vertex(corners[corner])
