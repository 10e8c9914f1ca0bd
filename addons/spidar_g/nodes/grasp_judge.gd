extends RefCounted
## Decides whether the squeeze on a body between the pads holds it: opposing faces and a friction check.

const JawSensor := preload("jaw_sensor.gd")

enum Verdict { WAIT, HOLD, REFUSE }

## Faces further from opposite would be squeezed out of the jaws.
const MIN_OPPOSITION_DEG: float = 150.0
## Slower than this the hand has done closing, rad/s.
const SETTLED_RATE: float = 0.2
## A hand that has closed and still squeezes too little for this long is told so.
const REFUSE_AFTER_S: float = 0.25

## Of the pads; a body whose physics material is smoother takes its own, unless it is marked rough.
var pad_friction: float = 1.0
## Least finger force that holds anything, however light.
var min_force_n: float = 0.1
## Multiplies the weight that friction has to carry.
var weight_scale: float = 1.0
## Why the last REFUSE.
var reason: String = ""
var _settled_s: float = 0.0
var _told: bool = false


## A new body, or the jaws have opened: the next squeeze is a new attempt.
func reset() -> void:
	_settled_s = 0.0
	_told = false


## finger_force_n: on each pad. grasp_rate: rad/s. REFUSE comes once per attempt.
func judge(
	jaw: JawSensor, finger_force_n: float, grasp_rate: float, delta_s: float
) -> Verdict:
	var problem: String = ""
	var body: RigidBody3D = jaw.body as RigidBody3D
	if body == null or body.is_queued_for_deletion():
		return Verdict.WAIT  # A wall or a fixed peg: it has a width, and nobody expects to lift it.
	var friction: float = _friction_on(body)
	var carried_n: float = 2.0 * friction * finger_force_n
	var weight_n: float = weight_scale * body.mass * _gravity_on(body)
	if body.freeze:
		problem = "the body is frozen: set freeze to false to let it be lifted"
	elif PhysicsServer3D.body_get_mode(body.get_rid()) < PhysicsServer3D.BODY_MODE_RIGID:
		problem = "the body is disabled: let its process_mode run to let it be lifted"
	elif jaw.opposition_deg() < MIN_OPPOSITION_DEG:
		problem = (
			"its faces are %.0f degrees apart, at least %.0f are needed: turn the grip"
			% [jaw.opposition_deg(), MIN_OPPOSITION_DEG]
		)
	elif finger_force_n < min_force_n:
		problem = (
			"the squeeze is %.2f N, at least %.2f N is needed: close further"
			% [finger_force_n, min_force_n]
		)
	elif carried_n < weight_n:
		problem = (
			"a squeeze of %.2f N carries %.2f N at friction %.2f, the body weighs %.2f N: close further"
			% [finger_force_n, carried_n, friction, weight_n]
		)
	if problem.is_empty():
		return Verdict.HOLD
	_settled_s = _settled_s + delta_s if absf(grasp_rate) < SETTLED_RATE else 0.0
	if _told or _settled_s < REFUSE_AFTER_S:
		return Verdict.WAIT
	_told = true
	reason = problem
	return Verdict.REFUSE


func _friction_on(body: RigidBody3D) -> float:
	var material: PhysicsMaterial = body.physics_material_override
	if material == null:
		return pad_friction
	if material.rough:
		return maxf(pad_friction, material.friction)
	return minf(pad_friction, material.friction)


static func _gravity_on(body: RigidBody3D) -> float:
	var state: PhysicsDirectBodyState3D = PhysicsServer3D.body_get_direct_state(body.get_rid())
	return state.total_gravity.length() if state != null else 0.0
