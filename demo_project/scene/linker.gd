extends Node
## Sockets that attract, snap, hold and let go by force. The held body's sockets are drawn to the ones they fit; what
## the magnets pull is felt by the hand. Once snapped in, the body stays in its seat while the hand still feels the
## spring: pulled far enough, it comes off; let go, it is locked to what it sits on.

const ContactSound := preload("res://scene/contact_sound.gd")
const Link := preload("res://scene/link.gd")
const LinkSocket := preload("res://scene/link_socket.gd")
const TaskBody := preload("res://scene/task_body.gd")

signal linked(socket: LinkSocket, mate: LinkSocket)
## pull_n: the force at which it came off.
signal unlinked(socket: LinkSocket, mate: LinkSocket, pull_n: float)

## Sums over all sockets of the held body. While attracted, the stable limit of a request renewed at game rate; in its seat
## the body hangs on a spring of the device's own loop, which does not lag.
const STIFFNESS_N_M := 150.0
const SPRING_ID := 71
const TRANSLATION_DOF := 0b111
## Renewed each frame; a game that hangs lets go.
const SPRING_S := 0.1
## Attraction begins here and is full at FULL_M.
const CAPTURE_M := 0.012
const FULL_M := 0.009
const CAPTURE_RAD := deg_to_rad(15.0)
const ATTRACTION_N := 2.0
## Of the turn into the seat, for sockets that do not turn freely.
const TURN_STIFFNESS_NM_RAD := 0.10
const TURN_LIMIT_NM := 0.04
## Lets go at whichever comes first; further out than the capture, so that it never chatters.
const RELEASE_N := 4.0
const RELEASE_M := 0.015
## From where it was caught into the seat.
const SEATING_S := 0.08

## Snaps in within these.
var latch_m := 0.003
var latch_rad := deg_to_rad(5.0)

var links: Array[Link] = []
var _spidar: SpidarG
var _hand: SpidarGHand
var _sockets: Array[LinkSocket] = []
## Of the held body: its sockets that have snapped in and where.
var _latched: Dictionary[LinkSocket, LinkSocket] = {}
var _held: RigidBody3D
var _caught := Transform3D.IDENTITY
var _seated_s := 0.0


func setup(spidar: SpidarG, hand: SpidarGHand) -> void:
	_spidar = spidar
	_hand = hand
	_hand.carrying.connect(_on_carrying)
	_hand.body_grasped.connect(_on_grasped)
	_hand.body_released.connect(_on_released)


## A knock for what snaps in and what comes off.
func sound_with(sound: ContactSound) -> void:
	linked.connect(func(_one: LinkSocket, _other: LinkSocket) -> void: sound.say(&"linked"))
	unlinked.connect(
		func(_one: LinkSocket, _other: LinkSocket, _pull_n: float) -> void: sound.say(&"unlinked")
	)


func clear() -> void:
	for link in links:
		link.unlock()
	links.clear()
	_sockets.clear()
	_latched.clear()


## Takes in the sockets among the children of `carrier`.
func add_carrier(carrier: CollisionObject3D) -> void:
	for child in carrier.get_children():
		if child is LinkSocket:
			_sockets.append(child as LinkSocket)


## How many sockets of `body` would find a mate if it were at `pose`.
func mates_at(body: CollisionObject3D, pose: Transform3D) -> int:
	var count := 0
	for socket in _sockets:
		if socket.carrier() == body:
			var at := pose * socket.transform
			count += int(_sockets.any(func(mate: LinkSocket) -> bool:
				return mate.carrier() != body and socket.fits(mate) and (
					at.origin.distance_to(mate.global_position) < latch_m * _spidar.workspace_scale
				)
			))
	return count


## How far the hand has pulled the held body's sockets out of where they sit: their mean, device metres.
func stretch_m() -> Vector3:
	var sum := Vector3.ZERO
	var wanted := _hand.get_wanted_pose()
	for socket: LinkSocket in _latched:
		sum += wanted * socket.position - _latched[socket].global_position
	return sum / (maxi(_latched.size(), 1) * _spidar.workspace_scale)


## How many of the held body's sockets have snapped in.
func latched_count() -> int:
	return _latched.size()


func _on_grasped(body: RigidBody3D) -> void:
	_held = body
	_latched.clear()
	for link: Link in links.duplicate():
		var socket := link.socket_on(body)
		if socket == null:
			continue
		var mate := link.mate_of(socket)
		if _is_fixed(mate.carrier(), body):
			links.erase(link)
			link.unlock()
			_latched[socket] = mate
	_caught = body.global_transform
	_seated_s = 0.0


func _on_released(_body: RigidBody3D) -> void:
	if is_instance_valid(_held) and not _latched.is_empty():
		_held.linear_velocity = Vector3.ZERO
		_held.angular_velocity = Vector3.ZERO
		for socket: LinkSocket in _latched:
			var link := Link.make(socket, _latched[socket])
			link.lock(self)
			links.append(link)
	_latched.clear()
	_hang_on_seat()
	_held = null


func _on_carrying(delta: float) -> void:
	var wanted := _hand.get_wanted_pose()
	for socket in _sockets:
		if socket.carrier() == _held:
			_draw(socket, wanted * socket.transform)
	for hanging in _hanging_on(_held):
		var arm := hanging.global_position - _spidar.get_grip_transform().origin
		var weight := hanging.mass * hanging.get_gravity()
		_hand.add_load(weight, (arm / _spidar.workspace_scale).cross(weight))
	_hang_on_seat()
	if _latched.is_empty():
		_seated_s = 0.0
		_caught = wanted
		return
	_seated_s += delta
	var part := smoothstep(0.0, SEATING_S, _seated_s)
	_hand.detain(_caught.interpolate_with(_seat(wanted), part))


## Attracts `socket`, which the grip would have at `at`, latches it, or tears it off.
func _draw(socket: LinkSocket, at: Transform3D) -> void:
	var mate: LinkSocket = _latched.get(socket)
	var scale_m := _spidar.workspace_scale
	if mate == null:
		mate = _nearest(socket, at)
		if mate == null:
			return
		var far_m := at.origin.distance_to(mate.global_position) / scale_m
		# The magnet draws the body itself, ahead of the hand: whichever comes there first snaps in.
		var body_m := socket.global_position.distance_to(mate.global_position) / scale_m
		if minf(far_m, body_m) <= latch_m and _turn(socket, at, mate) <= latch_rad:
			_latch(socket, mate)
		if not _latched.has(socket):
			_pull(socket, at, mate, smoothstep(CAPTURE_M, FULL_M, far_m))
		return
	var pull_n := _stiffness() * at.origin.distance_to(mate.global_position) / scale_m
	if pull_n > RELEASE_N or pull_n > _stiffness() * RELEASE_M:
		_latched.erase(socket)
		_exclude(Link.make(socket, mate), false)
		_caught = _held.global_transform
		unlinked.emit(socket, mate, pull_n)
	else:
		_turn_into(socket, at, mate)


func _latch(socket: LinkSocket, mate: LinkSocket) -> void:
	var link := Link.make(socket, mate)
	_exclude(link, true)
	if _is_fixed(mate.carrier(), _held):
		if _latched.is_empty():
			_caught = _held.global_transform
			_seated_s = 0.0
		_latched[socket] = mate
	else:
		link.lock(self)
		links.append(link)
	linked.emit(socket, mate)


## What the hand feels of one socket's attraction, and what a loose mate feels of it.
func _pull(socket: LinkSocket, at: Transform3D, mate: LinkSocket, share: float) -> void:
	var scale_m := _spidar.workspace_scale
	var way := (mate.global_position - at.origin) / scale_m
	var force := (share * _stiffness() * way).limit_length(ATTRACTION_N)
	_hand.add_load(force, _moment(socket, at, mate, force, share))
	var loose := mate.carrier() as RigidBody3D
	if loose != null and not loose.freeze and not _is_fixed(loose, _held):
		loose.apply_force(-force, mate.global_position - loose.global_position)


## Of a socket in its seat: what its share of the spring turns the grip with, beside the spring itself.
func _turn_into(socket: LinkSocket, at: Transform3D, mate: LinkSocket) -> void:
	var force := _stiffness() * (mate.global_position - at.origin) / _spidar.workspace_scale
	_hand.add_load(Vector3.ZERO, _moment(socket, at, mate, force, 1.0))


func _moment(
	socket: LinkSocket, at: Transform3D, mate: LinkSocket, force: Vector3, share: float
) -> Vector3:
	var arm := (at.origin - _spidar.get_grip_transform().origin) / _spidar.workspace_scale
	if socket.turns_freely:
		return arm.cross(force)
	var turn := (mate.global_basis.orthonormalized() * at.basis.orthonormalized().inverse())
	var rotation_vector := _rotation_vector(turn.get_rotation_quaternion())
	return arm.cross(force) + (
		(share * TURN_STIFFNESS_NM_RAD * rotation_vector).limit_length(TURN_LIMIT_NM)
	)


## The spring to where the grip would be with the sockets in their seats, in the servo loop: renewed at game rate it came
## two frames late, 0.1 N too weak on the way out and too strong on the way back.
func _hang_on_seat() -> void:
	if _latched.is_empty():
		_spidar.clear_effect(SPRING_ID)
		return
	var centre := _spidar.get_grip_transform()
	centre.origin -= stretch_m() * _spidar.workspace_scale
	_spidar.set_spring_effect(
		SPRING_ID, centre, 0.0, STIFFNESS_N_M, 0.0, 0.0, TRANSLATION_DOF, SPRING_S
	)


func _stiffness() -> float:
	return STIFFNESS_N_M / maxi(_latched.size(), 1)


func _nearest(socket: LinkSocket, at: Transform3D) -> LinkSocket:
	var best: LinkSocket = null
	var best_m := CAPTURE_M * _spidar.workspace_scale
	for mate in _sockets:
		if mate.carrier() == _held or not socket.fits(mate) or _is_taken(mate):
			continue
		var far_m := at.origin.distance_to(mate.global_position)
		if far_m < best_m and _turn(socket, at, mate) < CAPTURE_RAD:
			best = mate
			best_m = far_m
	return best


func _is_taken(socket: LinkSocket) -> bool:
	if socket.meets_many:
		return false
	for link in links:
		if link.one == socket or link.other == socket:
			return true
	return _latched.values().has(socket)


func _turn(socket: LinkSocket, at: Transform3D, mate: LinkSocket) -> float:
	return 0.0 if socket.turns_freely else TaskBody.turn_between(at.basis, mate.global_basis)


## Where the held body sits: exactly on its mate; a ball turns with the hand, two balls make a line.
func _seat(wanted: Transform3D) -> Transform3D:
	var first: LinkSocket = _latched.keys()[0]
	var mate := _latched[first]
	if not first.turns_freely:
		return mate.global_transform.orthonormalized() * first.transform.affine_inverse()
	var turned := wanted.basis.orthonormalized()
	if _latched.size() > 1:
		var second: LinkSocket = _latched.keys()[1]
		var as_held := turned * (second.position - first.position)
		var as_seated := _latched[second].global_position - mate.global_position
		if not as_seated.is_zero_approx():
			turned = Basis(Quaternion(as_held.normalized(), as_seated.normalized())) * turned
			# What is left of the lengths' difference is shared by both ends.
			var middle := 0.5 * (mate.global_position + _latched[second].global_position)
			return Transform3D(turned, middle - turned * (0.5 * (first.position + second.position)))
	return Transform3D(turned, mate.global_position - turned * first.position)


## Whether `carrier` is held by the ground when `without` is taken away.
func _is_fixed(carrier: CollisionObject3D, without: CollisionObject3D) -> bool:
	for reached in _joined_to(carrier, without):
		var body := reached as RigidBody3D
		if body == null or body.freeze:
			return true
	return false


## The bodies that hang on `body` by links and on nothing else.
func _hanging_on(body: CollisionObject3D) -> Array[RigidBody3D]:
	var hanging: Array[RigidBody3D] = []
	for reached in _joined_to(body, null):
		var rigid := reached as RigidBody3D
		if rigid == null or rigid.freeze:
			return [] # The ground carries them all.
		if rigid != body:
			hanging.append(rigid)
	return hanging


## All that is reached from `carrier` by locked links, itself first.
func _joined_to(
	carrier: CollisionObject3D, without: CollisionObject3D
) -> Array[CollisionObject3D]:
	var reached: Array[CollisionObject3D] = [carrier]
	var index := 0
	while index < reached.size():
		for link in links:
			var socket := link.socket_on(reached[index])
			if socket == null:
				continue
			var next := link.mate_of(socket).carrier()
			if next != without and not reached.has(next):
				reached.append(next)
		index += 1
	return reached


func _exclude(link: Link, excluded: bool) -> void:
	var body := link.one.carrier() as PhysicsBody3D
	if excluded:
		body.add_collision_exception_with(link.other.carrier())
	else:
		body.remove_collision_exception_with(link.other.carrier())


static func _rotation_vector(turn: Quaternion) -> Vector3:
	var shortest := turn if turn.w >= 0.0 else -turn
	return shortest.get_axis() * shortest.get_angle() if shortest.get_angle() > 1e-6 else Vector3.ZERO
