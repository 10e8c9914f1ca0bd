extends RefCounted
## Computes how deep a point is inside the collision shapes of an area. The depth is computed from the shapes and not by the
## physics server, so monitoring, layers and a move of the area in the same tick do not matter.

## A convex polygon with more points than this is ignored, because its faces would take too long to compute.
const MOST_HULL_POINTS: int = 128

# The points and the faces of each convex polygon that was seen.
var _points: Dictionary[Shape3D, PackedVector3Array] = {}
var _planes: Dictionary[Shape3D, Array] = {}


## Returns why the depth in a shape cannot be computed. Returns an empty string if it can.
static func problem(shape: Shape3D) -> String:
	if shape is ConvexPolygonShape3D:
		var count: int = (shape as ConvexPolygonShape3D).points.size()
		return "it has %d points, more than %d" % [count, MOST_HULL_POINTS] if count > MOST_HULL_POINTS else ""
	if shape is BoxShape3D or shape is SphereShape3D or shape is CapsuleShape3D or shape is CylinderShape3D:
		return ""
	return "" if shape is WorldBoundaryShape3D else "a %s has no inside" % shape.get_class()


## Returns the depth of `point`, in world coordinates, below the surface of the area's shapes, in meters of the scene. The
## depth is positive inside a shape. It is negative outside all shapes: minus the distance from the nearest one. Where shapes
## overlap, the largest depth counts. With an uneven scale, and outside a convex polygon, the depth is only an estimate.
## Disabled shapes are ignored. Returns -INF if there is no usable shape.
func of(area: CollisionObject3D, point: Vector3) -> float:
	var deepest: float = -INF
	for owner: int in area.get_shape_owners():
		if area.is_shape_owner_disabled(owner):
			continue
		var place: Transform3D = area.global_transform * area.shape_owner_get_transform(owner)
		if not place.is_finite() or is_zero_approx(place.basis.determinant()):
			continue
		var local: Vector3 = place.affine_inverse() * point
		var scale: Vector3 = place.basis.get_scale().abs()
		var unit: float = minf(scale.x, minf(scale.y, scale.z))
		for index: int in area.shape_owner_get_shape_count(owner):
			deepest = maxf(deepest, unit * _depth(area.shape_owner_get_shape(owner, index), local))
	return deepest


func _depth(shape: Shape3D, point: Vector3) -> float:
	if shape is BoxShape3D:
		return _in_box(point.abs() - 0.5 * (shape as BoxShape3D).size)
	if shape is SphereShape3D:
		return (shape as SphereShape3D).radius - point.length()
	if shape is CapsuleShape3D:
		var capsule := shape as CapsuleShape3D
		var half: float = maxf(0.0, 0.5 * capsule.height - capsule.radius)
		return capsule.radius - (point - Vector3(0.0, clampf(point.y, -half, half), 0.0)).length()
	if shape is CylinderShape3D:
		var cylinder := shape as CylinderShape3D
		var out: float = Vector2(point.x, point.z).length() - cylinder.radius
		return _in_box(Vector3(out, absf(point.y) - 0.5 * cylinder.height, -INF))
	if shape is WorldBoundaryShape3D:
		return -(shape as WorldBoundaryShape3D).plane.distance_to(point)
	if shape is ConvexPolygonShape3D:
		return _in_hull(shape as ConvexPolygonShape3D, point)
	return -INF


# beyond: how far the point is outside the faces along each axis; negative inside.
static func _in_box(beyond: Vector3) -> float:
	var most: float = maxf(beyond.x, maxf(beyond.y, beyond.z))
	return -most if most <= 0.0 else -beyond.max(Vector3.ZERO).length()


func _in_hull(shape: ConvexPolygonShape3D, point: Vector3) -> float:
	var points: PackedVector3Array = shape.points
	if not _points.has(shape) or _points[shape] != points:
		_points[shape] = points
		_planes[shape] = _faces(points)
	var most: float = -INF
	for face: Plane in _planes[shape]:
		most = maxf(most, face.distance_to(point))
	return -most if most > -INF else -INF


# Returns the faces of the hull of `points`. Each corner of the dual body, whose faces the points are, is a face of the
# hull.
static func _faces(points: PackedVector3Array) -> Array[Plane]:
	var faces: Array[Plane] = []
	if points.size() < 4 or points.size() > MOST_HULL_POINTS:
		return faces
	var middle := Vector3.ZERO
	for point: Vector3 in points:
		middle += point / points.size()
	var dual: Array[Plane] = []
	for point: Vector3 in points:
		var away: Vector3 = point - middle
		if away.length() > 1e-6:
			dual.append(Plane(away.normalized(), 1.0 / away.length()))
	for corner: Vector3 in Geometry3D.compute_convex_mesh_points(dual):
		var normal: Vector3 = corner.normalized()
		faces.append(Plane(normal, 1.0 / corner.length() + normal.dot(middle)))
	return faces
