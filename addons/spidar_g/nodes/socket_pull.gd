@tool
extends RefCounted
## Holds the pull with which one socket of a held body is drawn to its mate in one physics tick.

const SocketPull := preload("socket_pull.gd")

## The largest stiffness of a load that the game refreshes, in N/m. The attraction near the mate is at most this value times
## the distance.
const LOAD_STIFFNESS_N_M: float = 150.0
## The attraction acts in full within this share of the capture distance, and falls to 0 at the capture distance.
const FULL_FROM: float = 0.75
## The stiffness with which a socket is turned to the orientation of its mate, in N m/rad. Ignored for a socket that turns
## freely.
const TURN_STIFFNESS_NM_RAD: float = 0.10
## The largest moment with which a socket is turned to the orientation of its mate, in newton meters.
const TURN_LIMIT_NM: float = 0.04

var socket: SpidarGSocket
## The pose that the socket would have in world coordinates if the held body followed the grip.
var at: Transform3D
var mate: SpidarGSocket
## The force on the held body, in newtons, in world axes.
var force_n: Vector3
## The weight of this pull, from 0 to 1: how much of the attraction acts, or the share of a seat in the spring of all seats.
var share: float
## How much the force changes when the grip moves, in newtons per meter of device motion. For an attraction it is the change
## at right angles to the force.
var stiffness_n_m: float
## If [code]true[/code], the pull is that of a seat, and not the attraction of a socket that is not linked.
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


## Returns the moment that turns the held body to the orientation of the seat, in newton meters, in world axes. Returns zero
## for a socket that turns freely.
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


## Returns the angle of the rotation from the pose `where` of the socket `of` to the pose of its mate `to`, in radians.
## Returns 0 for a socket that turns freely.
static func turn_between(of: SpidarGSocket, where: Transform3D, to: SpidarGSocket) -> float:
	if of.turns_freely:
		return 0.0
	var one: Quaternion = where.basis.orthonormalized().get_rotation_quaternion()
	return one.angle_to(to.global_basis.orthonormalized().get_rotation_quaternion())
