extends Node3D
## Where the hand is in depth, whatever moves it: a soft round shadow on the first surface straight below the grip, and a thin
## line down to it. The nearer the surface, the smaller and darker the shadow. It costs one ray a physics tick, and no light
## has to cast shadows.

## Nothing is looked for farther below than this, in device metres.
const RANGE_M := 0.4
## So far above the surface, so that the two do not flicker. Device metres.
const LIFT_M := 0.0006
## Of the shadow at the surface, and at RANGE_M above it; device metres.
const RADIUS_M := Vector2(0.014, 0.060)
const OPACITY := Vector2(0.75, 0.30)
## Half of its thickness. The plain picture in a window 640 pixels wide has a pixel for each 1.6 mm: a thinner line has gaps.
const LINE_RADIUS_M := 0.0011
const LINE_COLOR := Color(0.949, 0.722, 0.294, 0.8)
## A surface steeper than this (cosine of its slope) gets a level shadow.
const STEEPEST := 0.2

var _spidar: SpidarG
var _hand: SpidarGHand
var _blob: MeshInstance3D
var _line: MeshInstance3D


func setup(spidar: SpidarG, hand: SpidarGHand) -> void:
	_spidar = spidar
	_hand = hand
	top_level = true
	process_physics_priority = 11 # after the device, the tool and the task have stepped
	_blob = _add_part(_blob_mesh(), _material(_soft_disc(), Color.BLACK))
	_line = _add_part(_rod_mesh(), _material(null, LINE_COLOR))


## Where the shadow lies, world; only while is_shown().
func foot() -> Vector3:
	return _blob.global_position


## Whether there is a surface below.
func is_shown() -> bool:
	return _blob.is_visible_in_tree()


func _physics_process(_delta: float) -> void:
	if _spidar == null:
		return
	var scale_m := _spidar.workspace_scale
	var from := _spidar.get_grip_transform().origin
	var query := PhysicsRayQueryParameters3D.create(from, from + Vector3.DOWN * RANGE_M * scale_m)
	query.hit_from_inside = false
	# What is held moves with the hand and is no surface below it.
	if _hand.get_held_body() != null:
		query.exclude = [_hand.get_held_body().get_rid()]
	var hit := get_world_3d().direct_space_state.intersect_ray(query)
	_blob.visible = not hit.is_empty()
	_line.visible = _blob.visible
	if _blob.visible:
		_place(from, hit["position"], hit["normal"], scale_m)


func _place(from: Vector3, on: Vector3, normal: Vector3, scale_m: float) -> void:
	var up := normal if normal.y > STEEPEST else Vector3.UP
	var foot_at := on + up * LIFT_M * scale_m
	var height := maxf(from.y - foot_at.y, LIFT_M * scale_m)
	var far := clampf(height / (RANGE_M * scale_m), 0.0, 1.0)
	var radius := lerpf(RADIUS_M.x, RADIUS_M.y, far) * scale_m
	var along := Vector3.RIGHT.slide(up).normalized()
	_blob.global_transform = Transform3D(Basis(along * radius, up, along.cross(up) * radius), foot_at)
	(_blob.material_override as StandardMaterial3D).albedo_color.a = lerpf(OPACITY.x, OPACITY.y, far)
	var thick := LINE_RADIUS_M * scale_m
	_line.global_transform = Transform3D(
		Basis.from_scale(Vector3(thick, 0.5 * height, thick)), foot_at + Vector3.UP * 0.5 * height
	)


func _add_part(mesh: Mesh, material: Material) -> MeshInstance3D:
	var part := MeshInstance3D.new()
	part.mesh = mesh
	part.material_override = material
	part.cast_shadow = GeometryInstance3D.SHADOW_CASTING_SETTING_OFF
	part.visible = false
	add_child(part)
	return part


## Two metres wide, so that its scale is a radius.
func _blob_mesh() -> PlaneMesh:
	var plane := PlaneMesh.new()
	plane.size = Vector2(2.0, 2.0)
	return plane


## Two metres in each direction, so that its scale is half a thickness and half a height.
func _rod_mesh() -> BoxMesh:
	var rod := BoxMesh.new()
	rod.size = Vector3(2.0, 2.0, 2.0)
	return rod


func _material(texture: Texture2D, color: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.albedo_color = color
	material.albedo_texture = texture
	return material


## White, opaque in the middle and clear at the rim.
func _soft_disc() -> Texture2D:
	var gradient := Gradient.new()
	gradient.set_color(0, Color.WHITE)
	gradient.set_color(1, Color(1, 1, 1, 0))
	gradient.add_point(0.35, Color(1, 1, 1, 0.85))
	var texture := GradientTexture2D.new()
	texture.gradient = gradient
	texture.fill = GradientTexture2D.FILL_RADIAL
	texture.fill_from = Vector2(0.5, 0.5)
	texture.fill_to = Vector2(1.0, 0.5)
	return texture
