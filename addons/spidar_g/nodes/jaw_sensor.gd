extends RefCounted
## Finds the body between the finger pads and its width along the jaw axis, by rays from beyond the open jaws inward.

const ContactFinder := preload("contact_finder.gd")
const ContactPlane := preload("contact_plane.gd")

## Rays per side: the pad's middle and four points round it, so that thin and turned bodies are not missed.
const RAY_PATTERN: Array[Vector2] = [
	Vector2(0.0, 0.0), Vector2(0.7, 0.0), Vector2(-0.7, 0.0), Vector2(0.0, 0.7), Vector2(0.0, -0.7)
]
## Between those, for what is thin enough to lie there unseen; looked at only when they meet nothing. In all no gap along
## the pads' axes is wider than 2.8 mm of a device's pad: a match is 3 mm thick.
const FINE_PATTERN: Array[Vector2] = [
	Vector2(0.233, 0.0), Vector2(-0.233, 0.0), Vector2(0.467, 0.0), Vector2(-0.467, 0.0),
	Vector2(0.0, 0.233), Vector2(0.0, -0.233), Vector2(0.0, 0.467), Vector2(0.0, -0.467),
]
## For centring_m where no forces centre the grip on the body: the pads take it along. Device metres.
const CENTRING_M: float = 0.006
## For entry_tolerance_m, device metres.
const ENTRY_TOLERANCE_M: float = 0.003
## Play of the pads round a body that is not held, device metres: keeps the two side planes feasible together.
const SIDE_SLACK_M: float = 0.002

## The body between the pads, or null. All else is valid only when it is not.
var body: CollisionObject3D = null
var rid: RID
## Scene metres along the jaw axis.
var width_m: float = 0.0
## Of the middle of the two faces, from the grip's centre along the jaw axis, scene metres.
var centre_offset_m: float = 0.0
## Outward normals of the faces at pads 0 and 1 (world), and the points that the pads meet first.
var normals: PackedVector3Array = PackedVector3Array([Vector3.LEFT, Vector3.RIGHT])
var points: PackedVector3Array = PackedVector3Array([Vector3.ZERO, Vector3.ZERO])

var collision_mask: int = 1
## A body that the jaws have already closed through by more than this (scene metres) did not come in between them.
var entry_tolerance_m: float = 0.003
## How far beside the middle of the closing pads a body that came between them may lie, scene metres.
var centring_m: float = 0.0
var _box: BoxShape3D = BoxShape3D.new()
var _query: PhysicsShapeQueryParameters3D = PhysicsShapeQueryParameters3D.new()
var _found_points: PackedVector3Array = PackedVector3Array([Vector3.ZERO, Vector3.ZERO])
var _found_normals: PackedVector3Array = PackedVector3Array([Vector3.ZERO, Vector3.ZERO])
var _ray: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.new()


## Looks along the grip's x axis. reach_m: half the ray's span; pad_radius_m and gap_m: scene metres.
func look(
	space: PhysicsDirectSpaceState3D,
	grip: Transform3D,
	gap_m: float,
	reach_m: float,
	pad_radius_m: float,
	exclude: Array[RID]
) -> void:
	var before: RID = rid if body != null else RID()
	body = null
	_box.size = Vector3(2.0 * reach_m, 1.4 * pad_radius_m, 1.4 * pad_radius_m)
	_query.shape = _box
	_query.transform = grip
	_query.collision_mask = collision_mask
	_query.exclude = exclude
	var hits: Array[Dictionary] = space.intersect_shape(_query, 2 * ContactFinder.MAX_BODIES)
	var rids: Array[RID] = ContactFinder.unique_rids(hits)
	_ray.collision_mask = collision_mask
	for candidate: RID in rids:
		_ray.exclude = exclude + rids.filter(func(other: RID) -> bool: return other != candidate)
		var faces: PackedFloat64Array = _measure(space, grip, reach_m, pad_radius_m)
		if faces.is_empty():
			continue
		var width: float = faces[1] - faces[0]
		var offset: float = 0.5 * (faces[0] + faces[1])
		# Between the pads, not beside one of them.
		var centring: float = centring_m if candidate == before else 0.0
		if absf(offset) > 0.5 * maxf(gap_m, width) - 0.25 * width + centring:
			continue
		if candidate != before and gap_m < width - entry_tolerance_m:
			continue
		if body != null and width <= width_m:
			continue
		rid = candidate
		body = ContactFinder.object_of(hits, candidate) as CollisionObject3D
		width_m = width
		centre_offset_m = offset
		points = _found_points.duplicate()
		normals = _found_normals.duplicate()


## Degrees between the faces' normals: 180 for a box held square.
func opposition_deg() -> float:
	return rad_to_deg(normals[0].angle_to(normals[1]))


## The pads' inner faces against the body: two planes that centre the tool on it, never tighter than its width.
func side_planes(
	finder: ContactFinder,
	grip: Transform3D,
	gap_m: float,
	closing_m_s: float,
	slack_m: float,
	found: Array[ContactPlane]
) -> void:
	var gap: float = maxf(gap_m, width_m + slack_m)
	var axis: Vector3 = grip.basis.x
	for side: int in 2:
		var plane: ContactPlane = ContactPlane.new()
		var outward: float = -1.0 if side == 0 else 1.0
		plane.normal = axis * outward
		plane.separation_m = 0.5 * gap - 0.5 * width_m - centre_offset_m * outward
		plane.point = points[side]
		plane.rid = rid
		finder.set_material(plane, body)
		var velocity: Vector3 = PhysicsServer3D.body_get_state(rid, PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY)
		plane.velocity = Engine.time_scale * velocity
		if gap_m > width_m + slack_m:
			plane.closing = 0.5 * closing_m_s * plane.normal
		found.append(plane)


## [left face, right face] along the jaw axis from the grip's centre, or empty when a side has no face.
func _measure(
	space: PhysicsDirectSpaceState3D, grip: Transform3D, reach_m: float, pad_radius_m: float
) -> PackedFloat64Array:
	var faces: PackedFloat64Array = PackedFloat64Array([INF, -INF])
	for side: int in 2:
		if not _meet(space, grip, reach_m, pad_radius_m, side, RAY_PATTERN, faces):
			_meet(space, grip, reach_m, pad_radius_m, side, FINE_PATTERN, faces)
	if not (faces[1] > faces[0]):
		return PackedFloat64Array()
	return faces


## The outermost of what the rays of one side meet; false when they meet nothing.
func _meet(
	space: PhysicsDirectSpaceState3D, grip: Transform3D, reach_m: float, pad_radius_m: float,
	side: int, pattern: Array[Vector2], faces: PackedFloat64Array
) -> bool:
	var outward: float = -1.0 if side == 0 else 1.0
	for spot: Vector2 in pattern:
		var off_axis: Vector3 = Vector3(0.0, spot.x, spot.y) * pad_radius_m
		_ray.from = grip * (off_axis + Vector3(outward * reach_m, 0.0, 0.0))
		_ray.to = grip * (off_axis - Vector3(outward * reach_m, 0.0, 0.0))
		var hit: Dictionary = space.intersect_ray(_ray)
		if hit.is_empty():
			continue
		var point: Vector3 = hit["position"]
		var x: float = grip.basis.x.dot(point - grip.origin)
		if x * outward > faces[side] * outward:
			faces[side] = x
			_found_points[side] = point
			_found_normals[side] = hit["normal"]
	return is_finite(faces[side])
