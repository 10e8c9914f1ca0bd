@tool
extends RefCounted
## Computes how one socket of a held body is drawn to its mate in one physics tick.

const SocketPull := preload("socket_pull.gd")

## The largest stiffness of a load that the game refreshes, in N/m. The attraction rises no more steeply.
const LOAD_STIFFNESS_N_M: float = 150.0
## The attraction is full at this share of the capture distance and begins at the capture distance.
const FULL_FROM: float = 0.75
## The stiffness that turns a socket into its seat, in N m/rad. Ignored for a socket that turns freely.
const TURN_STIFFNESS_NM_RAD: float = 0.10
## The largest moment that turns a socket into its seat, in newton meters.
const TURN_LIMIT_NM: float = 0.04

var socket: SpidarGSocket
## The pose of the socket in world coordinates if the body followed the grip.
var at: Transform3D
var mate: SpidarGSocket
## The force on the held body, in newtons, in world axes.
var force_n: Vector3
## This is the strength of the magnet, or the share of the seat in the common spring, from 0 to 1.
var share: float
## The change of the force when the grip moves across it, in newtons per meter.
var stiffness_n_m: float
## If [code]true[/code], the socket sits in the seat of its mate.
var is_seat: bool = false


static func make(of: SpidarGSocket, where: Transform3D, to: SpidarGSocket) -> SocketPull:
	var pull: SocketPull = SocketPull.new()
	pull.socket = of
	pull.at = where
	pull.mate = to
	return pull


func weaken(by: float) -> void:
	force_n /= by
	share /= by
	stiffness_n_m /= by


## Returns the moment that turns the held body into the seat, in newton meters, in world axes. It is zero for a socket that
## turns freely.
func turn_nm() -> Vector3:
	if socket.turns_freely:
		return Vector3.ZERO
	var left: Basis = mate.global_basis.orthonormalized() * at.basis.orthonormalized().inverse()
	var shortest: Quaternion = left.get_rotation_quaternion()
	shortest = shortest if shortest.w >= 0.0 else -shortest
	if shortest.get_angle() < 1e-6:
		return Vector3.ZERO
	var turn: Vector3 = shortest.get_axis() * shortest.get_angle()
	return share * (TURN_STIFFNESS_NM_RAD * turn).limit_length(TURN_LIMIT_NM)


func turn_stiffness_nm_rad() -> float:
	return 0.0 if socket.turns_freely else share * TURN_STIFFNESS_NM_RAD


## Returns the angle between the axes of a socket with the pose `where` and those of its mate, in radians. It is 0 for a
## socket that turns freely.
static func turn_between(of: SpidarGSocket, where: Transform3D, to: SpidarGSocket) -> float:
	if of.turns_freely:
		return 0.0
	var one: Quaternion = where.basis.orthonormalized().get_rotation_quaternion()
	return one.angle_to(to.global_basis.orthonormalized().get_rotation_quaternion())
