@tool
extends RefCounted
## Computes the force and the moment of the sockets of a held body on a grip. The attraction is a load, which moves the body
## ahead of the hand. The pull of all seats is one spring effect of the servo loop. As a load that the game refreshes, this
## pull came two frames late: its force was wrong by 0.1 N, and a body gripped 0.1 m from its socket was shaken off.

const SocketPull := preload("socket_pull.gd")
const SocketSpring := preload("socket_spring.gd")

## The duration of the spring effect, in seconds. The game refreshes the effect in each tick. If the game hangs, the effect
## ends after this time and a fade.
const DURATION_S: float = 0.1
## The largest rotation between the grip and the center of the spring, in radians.
const FARTHEST_TURN: float = 1.5
## The largest rotational stiffness of a load that the game refreshes, in N m/rad. A stiffer load is not stable.
const LOAD_TURN_STIFFNESS_NM_RAD: float = 0.5

## The force of the attraction, in newtons, in world axes.
var load_n: Vector3
## The force of the seats at this moment, in newtons, in world axes.
var force_n: Vector3
## The moment of the seats and of the attraction about the grip, in newton meters, in world axes.
var moment_nm: Vector3
## How much the force of the seats changes when the grip moves, in newtons per meter of device motion.
var stiffness_n_m: float
## How much the moment changes when the grip turns, in newton meters per radian.
var turn_stiffness_nm_rad: float


## Returns the sum of `pulls` on a grip at the position `grip`. With `on_mates` it returns the opposite pulls, which act on
## the grip that holds the mates. `scale` is [member SpidarG.workspace_scale].
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


## Refreshes the spring effect with this id. Returns [code]false[/code] if the device refuses it, usually because 6 other
## effects act.
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


## Returns the part of the force of the seats that is stable as a load, in newtons. It is used if [method act] fails.
func late_force_n() -> Vector3:
	return force_n * minf(1.0, SocketPull.LOAD_STIFFNESS_N_M / maxf(stiffness_n_m, 1e-6))


## Returns the part of the moment that is stable as a load, in newton meters. It is used if [method act] fails.
func late_moment_nm() -> Vector3:
	return moment_nm * minf(1.0, LOAD_TURN_STIFFNESS_NM_RAD / maxf(turn_stiffness_nm_rad, 1e-6))
