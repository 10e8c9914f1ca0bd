@tool
extends RefCounted
## What the seats of a held body pull a grip with, as one spring of the device's own loop. Renewed by loads at game rate, the pull
## came two frames late: 0.1 N too weak on the way out and too strong on the way back; and long bodies trembled in their seats,
## because the moment of a seat grows with the square of its arm.

const SocketPull := preload("socket_pull.gd")
const SocketSpring := preload("socket_spring.gd")

## The spring is renewed each frame; a game that hangs lets go.
const DURATION_S: float = 0.1
## Moments are not turned further than this into the spring, rad.
const FARTHEST_TURN: float = 1.5

## On the grip, now: N and N m, world axes.
var force_n: Vector3
var moment_nm: Vector3
## By how much they change when the grip moves: N/m and N m/rad.
var stiffness_n_m: float
var turn_stiffness_nm_rad: float


## The sum of `pulls` on the grip at `grip`; where the pulled sockets sit it is that of the mates that is felt: `on_mates`.
static func about(grip: Vector3, scale: float, pulls: Array[SocketPull], on_mates: bool) -> SocketSpring:
	var spring: SocketSpring = SocketSpring.new()
	var way: float = -1.0 if on_mates else 1.0
	for pull: SocketPull in pulls:
		var place: Vector3 = pull.mate.global_position if on_mates else pull.at.origin
		var arm: Vector3 = (place - grip) / scale
		spring.force_n += way * pull.force_n
		spring.moment_nm += way * (arm.cross(pull.force_n) + pull.turn_nm())
		spring.stiffness_n_m += pull.stiffness_n_m
		spring.turn_stiffness_nm_rad += pull.stiffness_n_m * arm.length_squared() + pull.turn_stiffness_nm_rad()
	return spring


## Where all effects of the device are in use, the pull is a load renewed at game rate: so much of it stays steady.
func late_share() -> float:
	return minf(1.0, SocketPull.LOAD_STIFFNESS_N_M / stiffness_n_m)


## Returns false when the device has no effect left for it.
func act(on: SpidarG, id: int) -> bool:
	var limits: Vector3 = on.get_stiffness_limits()
	var linear: float = minf(stiffness_n_m, limits.x)
	var angular: float = minf(turn_stiffness_nm_rad, limits.y)
	var center: Transform3D = on.get_grip_transform()
	center.origin += force_n / linear * on.workspace_scale
	var turn: Vector3 = (moment_nm / maxf(angular, 1e-6)).limit_length(FARTHEST_TURN)
	if turn.length() > 1e-6:
		center.basis = Basis(turn.normalized(), turn.length()) * center.basis
	return on.set_spring_effect(
		id, center, 0.0, linear, angular, 0.0, SpidarG.DOF_LINEAR | SpidarG.DOF_ANGULAR, DURATION_S
	)
