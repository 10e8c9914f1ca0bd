@tool
extends RefCounted
## What the sockets of a held body do to a grip. The attraction's force is a load, which draws the body ahead of the hand; all
## else is one spring of the device's own loop. Renewed as loads at game rate, a seat's force came two frames late, 0.1 N too
## weak on the way out and too strong on the way back; and a body gripped 0.1 m from its socket was shaken off, because the
## moment grows with the square of the arm.

const SocketPull := preload("socket_pull.gd")
const SocketSpring := preload("socket_spring.gd")

## The spring is renewed each frame; a game that hangs lets go.
const DURATION_S: float = 0.1
## A spring's center is not turned further than this from the grip, rad.
const FARTHEST_TURN: float = 1.5
## The stable limit of a moment that is renewed at game rate.
const LOAD_TURN_STIFFNESS_NM_RAD: float = 0.5

## Of the attraction, N, world axes.
var load_n: Vector3
## Of the seats, now: N and N m, world axes; the moment also that of the attraction.
var force_n: Vector3
var moment_nm: Vector3
## By how much they change when the grip moves: N/m and N m/rad.
var stiffness_n_m: float
var turn_stiffness_nm_rad: float


## The sum of `pulls` about a grip at `grip`; with `on_mates` what their mates feel of them.
static func about(grip: Vector3, scale: float, pulls: Array, on_mates: bool) -> SocketSpring:
	var spring: SocketSpring = SocketSpring.new()
	var way: float = -1.0 if on_mates else 1.0
	for pull: SocketPull in pulls:
		var place: Vector3 = pull.mate.global_position if on_mates else pull.at.origin
		var arm: Vector3 = (place - grip) / scale
		spring.moment_nm += way * (arm.cross(pull.force_n) + pull.turn_nm())
		spring.turn_stiffness_nm_rad += pull.stiffness_n_m * arm.length_squared() + pull.turn_stiffness_nm_rad()
		if pull.is_seat:
			spring.force_n += way * pull.force_n
			spring.stiffness_n_m += pull.stiffness_n_m
		else:
			spring.load_n += way * pull.force_n
	return spring


## Renews the spring. Returns false when the device has no effect left for it.
func act(on: SpidarG, id: int) -> bool:
	var limits: Vector3 = on.get_stiffness_limits()
	var linear: float = minf(stiffness_n_m, limits.x)
	var angular: float = minf(turn_stiffness_nm_rad, limits.y)
	var center: Transform3D = on.get_grip_transform()
	if linear > 0.0:
		center.origin += force_n / linear * on.workspace_scale
	var turn: Vector3 = (moment_nm / maxf(angular, 1e-6)).limit_length(FARTHEST_TURN)
	if turn.length() > 1e-6:
		center.basis = Basis(turn.normalized(), turn.length()) * center.basis
	return on.set_spring_effect(
		id, center, 0.0, linear, angular, 0.0, SpidarG.DOF_LINEAR | SpidarG.DOF_ANGULAR, DURATION_S
	)


## As loads, where the device has no effect left: only so much of them stays steady.
func late_force_n() -> Vector3:
	return force_n * minf(1.0, SocketPull.LOAD_STIFFNESS_N_M / maxf(stiffness_n_m, 1e-6))


func late_moment_nm() -> Vector3:
	return moment_nm * minf(1.0, LOAD_TURN_STIFFNESS_NM_RAD / maxf(turn_stiffness_nm_rad, 1e-6))
