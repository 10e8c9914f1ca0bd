extends RefCounted
## Finds the surfaces near a convex shape: one plane per body, published before contact.
##
## A shape query with a margin reports, for convex shapes A (ours) and B, the points of the shape grown by the
## margin; the separation is therefore dot(n, a - b) + margin. The plane through the nearest point of a convex body with
## the normal of shortest separation holds the whole body behind it, so it never stops what the body would not stop.

const ContactPlane := preload("contact_plane.gd")

## Bodies looked at per shape and frame: bounds the frame's cost.
const MAX_BODIES: int = 6
## Contact points asked per body: a face on a face gives four.
const MAX_POINTS: int = 4

## A plane that the shape would be nearer to than this (scene metres) after its way ahead is looked at from there too.
const LOOK_AHEAD_BELOW_M: float = 0.005

## A body with this metadata (N/m per device metre) feels softer than the rest.
const STIFFNESS_META: StringName = &"spidar_stiffness_n_m"
## A body with this metadata (coefficient) is rougher or smoother than the rest.
const FRICTION_META: StringName = &"spidar_friction"
## The reaction on a pushed body comes one game frame late; a stiffness above this many times mass / frame^2 would
## let a light body bounce between the tool's push and its own answer. In fast motion a frame is long in the game's time.
const PUSHED_STIFFNESS_RATIO: float = 1.0

var collision_mask: int = 1
## The motion of the device since the last physics step. Bodies that physics steps move still stand where that step left them.
var gone_on: Transform3D = Transform3D.IDENTITY
## Scene metres.
var margin_m: float = 0.04
var workspace_scale: float = 1.0
var stiffness_n_m: float = 350.0
var damping_n_s_m: float = 2.0
var friction: float = 0.4
var _query: PhysicsShapeQueryParameters3D = PhysicsShapeQueryParameters3D.new()


## Appends to `found` the planes near `shape`, which stood at `transform` at the last physics step. Bodies in `exclude` are not
## seen. The shape moves on by `ahead` (scene metres) before the next planes come: of the planes that touch a body now and then, the one
## is taken that the shape stays clear of longest. Both hold the whole convex body behind them, so neither is passed unfelt.
func find(
	space: PhysicsDirectSpaceState3D,
	shape: Shape3D,
	transform: Transform3D,
	exclude: Array[RID],
	found: Array[ContactPlane],
	ahead: Vector3 = Vector3.ZERO
) -> void:
	_query.shape = shape
	_query.transform = transform
	_query.margin = margin_m
	_query.collision_mask = collision_mask
	_query.exclude = exclude
	var now: Transform3D = gone_on * transform
	var hits: Array[Dictionary] = space.intersect_shape(_query, 2 * MAX_BODIES)
	if now != transform:
		_query.transform = now
		hits.append_array(space.intersect_shape(_query, 2 * MAX_BODIES))
	var bodies: Array[RID] = unique_rids(hits)
	for rid: RID in bodies:
		_query.exclude = exclude + bodies.filter(func(other: RID) -> bool: return other != rid)
		var at: Transform3D = transform
		if _is_static(rid):
			at = now
			var node: Node3D = object_of(hits, rid)
			if node != null:
				# The space learns of a node's move only at the end of a tick.
				node.force_update_transform()
		_query.transform = at
		var plane: ContactPlane = _nearest_plane(space)
		if plane == null:
			continue
		plane = _clearest_plane(space, plane, at, ahead)
		if at != now:
			plane.normal = gone_on.basis * plane.normal
		found.append(plane)


## The same for every shape of `body`, as if it were at `at`.
func find_round_body(
	space: PhysicsDirectSpaceState3D,
	body: CollisionObject3D,
	at: Transform3D,
	exclude: Array[RID],
	found: Array[ContactPlane]
) -> void:
	for shape_owner: int in body.get_shape_owners():
		if body.is_shape_owner_disabled(shape_owner):
			continue
		var placed: Transform3D = at * body.shape_owner_get_transform(shape_owner)
		for index: int in body.shape_owner_get_shape_count(shape_owner):
			find(space, body.shape_owner_get_shape(shape_owner, index), placed, exclude, found)


## Each body once, in the order met.
static func unique_rids(hits: Array[Dictionary]) -> Array[RID]:
	var rids: Array[RID] = []
	for hit: Dictionary in hits:
		var rid: RID = hit["rid"]
		if not rids.has(rid) and rids.size() < MAX_BODIES:
			rids.append(rid)
	return rids


## The node of the body `wanted` among the hits of a query.
static func object_of(hits: Array[Dictionary], wanted: RID) -> Node3D:
	for hit: Dictionary in hits:
		var hit_rid: RID = hit["rid"]
		if hit_rid == wanted:
			return hit["collider"] as Node3D
	return null


## `now`, or the plane of the same body as seen from the end of the way, whichever the shape keeps clear of better.
func _clearest_plane(
	space: PhysicsDirectSpaceState3D, now: ContactPlane, transform: Transform3D, ahead: Vector3
) -> ContactPlane:
	var soonest: float = now.separation_m + now.normal.dot(ahead)
	if soonest >= minf(LOOK_AHEAD_BELOW_M, now.separation_m):
		return now
	_query.transform = transform.translated(ahead)
	var later: ContactPlane = _nearest_plane(space)
	_query.transform = transform
	# A normal that turned over belongs to the body's far side: the shape went through.
	if later == null or later.rid != now.rid or later.normal.dot(now.normal) <= 0.0:
		return now
	var at_end: float = later.separation_m
	later.separation_m -= later.normal.dot(ahead)
	return later if minf(later.separation_m, at_end) > minf(now.separation_m, soonest) else now


func _nearest_plane(space: PhysicsDirectSpaceState3D) -> ContactPlane:
	var rest: Dictionary = space.get_rest_info(_query)
	if rest.is_empty():
		return null
	var normal: Vector3 = rest["normal"]
	if not normal.is_finite() or absf(normal.length_squared() - 1.0) > 1e-3:
		return null  # Engines give a zero normal for exactly concentric shapes: there is no side to push to.
	normal = normal.normalized()
	var separation: float = INF
	var pairs: PackedVector3Array = space.collide_shape(_query, MAX_POINTS)
	for i: int in range(0, pairs.size() - 1, 2):
		separation = minf(separation, normal.dot(pairs[i] - pairs[i + 1]) + margin_m)
	if not is_finite(separation):
		return null
	var plane: ContactPlane = ContactPlane.new()
	plane.normal = normal
	plane.separation_m = separation
	plane.point = rest["point"]
	var game_velocity: Vector3 = rest["linear_velocity"]
	plane.velocity = Engine.time_scale * game_velocity
	plane.rid = rest["rid"]
	var collider_id: int = rest["collider_id"]
	set_material(plane, instance_from_id(collider_id))
	return plane


## Gives `plane` the feel of the body `collider`, and the body itself when a push moves it.
func set_material(plane: ContactPlane, collider: Object) -> void:
	plane.stiffness_n_m = float_meta(collider, STIFFNESS_META, stiffness_n_m)
	plane.damping_n_s_m = damping_n_s_m
	plane.friction = float_meta(collider, FRICTION_META, friction)
	plane.is_static = _is_static(plane.rid)
	if plane.is_static and collider is Node3D:
		plane.place = (collider as Node3D).global_transform
	var body: RigidBody3D = collider as RigidBody3D
	if body != null and not body.freeze:
		plane.pushed_body = body
		var per_frame: float = Engine.physics_ticks_per_second / maxf(Engine.time_scale, 1.0)
		# Stiffness is per device metre, the body moves in scene metres.
		var limit: float = PUSHED_STIFFNESS_RATIO * body.mass * per_frame * per_frame * workspace_scale
		plane.stiffness_n_m = minf(plane.stiffness_n_m, limit)


static func _is_static(rid: RID) -> bool:
	return PhysicsServer3D.body_get_mode(rid) == PhysicsServer3D.BODY_MODE_STATIC


## Metadata `key` of `object` when it is a positive finite number, else `fallback`.
static func float_meta(object: Object, key: StringName, fallback: float) -> float:
	if object == null or not object.has_meta(key):
		return fallback
	var value: Variant = object.get_meta(key)
	if not (value is float or value is int):
		return fallback
	var number: float = value
	return number if is_finite(number) and number > 0.0 else fallback
