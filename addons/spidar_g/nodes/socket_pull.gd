@tool
extends RefCounted
## How one socket of a held body is drawn to its mate in one tick.

const SocketPull := preload("socket_pull.gd")

## The stable limit of a load that is renewed at game rate: attraction rises no steeper.
const LOAD_STIFFNESS_N_M: float = 150.0
## Attraction begins at the capture distance and is full at this share of it.
const FULL_FROM: float = 0.75
## Of the turn into the seat, for sockets that do not turn freely.
const TURN_STIFFNESS_NM_RAD: float = 0.10
const TURN_LIMIT_NM: float = 0.04

var socket: SpidarGSocket
## Where the grip would have the socket, world.
var at: Transform3D
var mate: SpidarGSocket
## On the held body, world axes.
var force_n: Vector3
## How far the magnet acts, or which part of the seats' spring this one is: 0 to 1.
var share: float
## By how much the force changes when the grip moves across.
var stiffness_n_m: float
## Whether it is in its seat.
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


## What turns the held body into the seat (N m, world axes); none for a socket that turns freely.
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


## Angle between the axes of a socket at `where` and its mate, rad; 0 for a socket that turns freely.
static func turn_between(of: SpidarGSocket, where: Transform3D, to: SpidarGSocket) -> float:
	if of.turns_freely:
		return 0.0
	var one: Quaternion = where.basis.orthonormalized().get_rotation_quaternion()
	return one.angle_to(to.global_basis.orthonormalized().get_rotation_quaternion())
