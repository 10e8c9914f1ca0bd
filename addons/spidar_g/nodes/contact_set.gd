extends RefCounted
## The planes published to the device: merges parallel ones, keeps ids from frame to frame, packs them for
## SpidarG.set_contacts, and turns the impulses that come back into what each plane gave since the last frame.

const ContactPlane := preload("contact_plane.gd")

## All planes act on the grip's centre, so of two that are nearly parallel only the nearer one can ever touch.
const MERGE_COSINE: float = 0.996  # 5 degrees
## A surface of the same body whose normal turned less than this in one frame is the same surface.
const SAME_SURFACE_COSINE: float = 0.94  # 20 degrees
## A push makes a body at most this much faster than the tool, and carries it at most this far ahead of the tool before the
## next push. Without a limit a light body would be thrown: in truth the force is gone once the body moves, here it is held for a
## whole frame.
const MOST_LEAD_M_S: float = 0.5
const MOST_LEAD_M: float = 0.0085
## SpidarG takes 8 contacts; one is kept for the grasp stop.
const MAX_PLANES: int = 7

var planes: Array[ContactPlane] = []
var _next_id: int = 1
var _sums: Dictionary[int, Vector3] = {}
var _gained: Dictionary[int, Vector3] = {}


## An id never used before, for the grasp stop as well as planes.
func new_id() -> int:
	var id: int = _next_id
	_next_id = 1 if _next_id >= 0x7fffffff else _next_id + 1  # The device takes 32-bit ids.
	return id


## Replaces the set by `found`, nearest first, at most MAX_PLANES.
func replace(found: Array[ContactPlane]) -> void:
	found.sort_custom(
		func(a: ContactPlane, b: ContactPlane) -> bool: return a.separation_m < b.separation_m
	)
	var kept: Array[ContactPlane] = []
	for plane: ContactPlane in found:
		if kept.size() < MAX_PLANES and not _is_covered(plane, kept):
			kept.append(plane)
	_leave_out_jumps(kept)
	var before: Array[ContactPlane] = planes.duplicate()
	for plane: ContactPlane in kept:
		var same: ContactPlane = _same_surface(plane, before)
		if same == null:
			plane.id = new_id()
		else:
			plane.id = same.id
			before.erase(same)
	planes = kept


## Leaves out the farthest planes beyond `most`, where scripts use some of the device's contacts.
func keep_nearest(most: int) -> void:
	if planes.size() > most:
		planes.resize(maxi(most, 0))


## Appends SpidarG's rows for a grip centred on `centre` (world).
func pack_into(rows: PackedFloat64Array, centre: Vector3) -> void:
	for plane: ContactPlane in planes:
		var offset: float = plane.normal.dot(centre) - plane.separation_m
		var velocity: Vector3 = plane.velocity + plane.closing
		rows.append_array(
			PackedFloat64Array(
				[
					plane.normal.x, plane.normal.y, plane.normal.z, offset,
					velocity.x, velocity.y, velocity.z,
					plane.stiffness_n_m, plane.damping_n_s_m, plane.friction,
					SpidarG.CONTACT_CENTRE, plane.id,
				]
			)
		)


## Takes SpidarG.get_contact_impulses(), sums since each id appeared.
func read_impulses(sums: Dictionary) -> void:
	_gained.clear()
	var now: Dictionary[int, Vector3] = {}
	for key: Variant in sums:
		var id: int = key
		var total: Vector3 = sums[key]
		now[id] = total
		_gained[id] = total - _sums.get(id, Vector3.ZERO)
	_sums = now


## N s on the grip between the last two calls of read_impulses (grasp stop: N m s in x).
func gained(id: int) -> Vector3:
	return _gained.get(id, Vector3.ZERO)


## Newton's third law at game rate: what a plane gave the hand in since_s of device time, its body gets back, up to most_n
## and never so much that it is thrown. In slow motion the force stays the same, and
## the hand is faster in the game's time.
func push_bodies(most_n: float, since_s: float, tool_velocity_m_s: Vector3) -> void:
	var pace: float = Engine.time_scale
	if pace <= 0.0:
		return
	var lead_m_s: float = minf(MOST_LEAD_M_S, MOST_LEAD_M / (pace * since_s))
	for plane: ContactPlane in planes:
		var impulse: Vector3 = -pace * gained(plane.id)
		var body: RigidBody3D = plane.pushed_body
		if is_instance_valid(body) and impulse.is_finite() and not impulse.is_zero_approx():
			var along: Vector3 = impulse.normalized()
			# Not the node's own velocity: that misses what another plane has given in this frame.
			var velocity: Vector3 = PhysicsServer3D.body_get_state(
				body.get_rid(), PhysicsServer3D.BODY_STATE_LINEAR_VELOCITY
			)
			var fastest: float = maxf(tool_velocity_m_s.dot(along) / pace, 0.0) + lead_m_s
			var most: float = minf(pace * most_n * since_s, body.mass * maxf(fastest - velocity.dot(along), 0.0))
			body.apply_impulse(impulse.limit_length(most), plane.point - body.global_position)


## The shortest way out of all planes that a held body stands in; marks them as met through it.
static func way_out(met: Array[ContactPlane]) -> Vector3:
	var shift: Vector3 = Vector3.ZERO
	for _pass: int in 3:  # Enough for a corner of three planes at right angles.
		for plane: ContactPlane in met:
			plane.through_held_body = true
			shift += plane.normal * maxf(-plane.separation_m - plane.normal.dot(shift), 0.0)
	return shift


## How far the tool, as it is shown, is moved so that it stands in no surface that it only leans on.
func shown_shift() -> Vector3:
	var shift: Vector3 = Vector3.ZERO
	for plane: ContactPlane in planes:
		if not plane.through_held_body:
			shift += plane.normal * maxf(-plane.separation_m - plane.normal.dot(shift), 0.0)
	return shift


## Sets the velocity by which each plane is carried on. A body that a script puts elsewhere has a velocity in one tick alone, as
## if it had been swept there. A motion lasts for two ticks, so the part that both ticks share is used. A RigidBody3D is moved by
## its velocity, which is therefore used as it is.
func _leave_out_jumps(found: Array[ContactPlane]) -> void:
	var last: Dictionary[RID, ContactPlane] = {}
	for plane: ContactPlane in planes:
		last[plane.rid] = plane
	for plane: ContactPlane in found:
		plane.seen_velocity = plane.velocity
		if plane.pushed_body != null:
			continue
		var before: ContactPlane = last.get(plane.rid)
		if before == null:
			plane.velocity = Vector3.ZERO
		elif not plane.is_static:
			plane.velocity = _steady(before.seen_velocity, plane.seen_velocity)
		else:
			# One tick late, as the engine's velocities are: all bodies of a lift then have the same velocity.
			var moved: Vector3 = plane.place * (before.place.affine_inverse() * plane.point) - plane.point
			plane.seen_velocity += Engine.physics_ticks_per_second * moved
			plane.earlier_velocity = before.seen_velocity
			plane.velocity = _steady(before.earlier_velocity, before.seen_velocity)


static func _steady(before: Vector3, newest: Vector3) -> Vector3:
	return newest.limit_length(before.length()) if before.dot(newest) > 0.0 else Vector3.ZERO


func _is_covered(plane: ContactPlane, nearer: Array[ContactPlane]) -> bool:
	for other: ContactPlane in nearer:
		if plane.normal.dot(other.normal) > MERGE_COSINE:
			return true
	return false


func _same_surface(plane: ContactPlane, before: Array[ContactPlane]) -> ContactPlane:
	var best: ContactPlane = null
	var best_cosine: float = SAME_SURFACE_COSINE
	for other: ContactPlane in before:
		var cosine: float = plane.normal.dot(other.normal)
		if other.rid == plane.rid and cosine > best_cosine:
			best = other
			best_cosine = cosine
	return best
