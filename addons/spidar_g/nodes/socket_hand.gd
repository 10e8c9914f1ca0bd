@tool
extends Node
## Moves the sockets of the body that a hand holds: they are drawn to sockets that fit, click into their seats, are held there
## by a spring, and come off. This node is an internal child of a [SpidarGHand], and works while that hand holds a body with
## sockets.

const SocketGraph := preload("socket_graph.gd")
const SocketHand := preload("socket_hand.gd")
const SocketHands := preload("socket_hands.gd")
const SocketLink := preload("socket_link.gd")
const SocketPull := preload("socket_pull.gd")
const SocketSpring := preload("socket_spring.gd")

## The time in which the body moves into its seat, in seconds.
const SEATING_S: float = 0.08

## The body that the hand holds, if the body had sockets when it was grasped, or [code]null[/code].
var held: RigidBody3D
## The time at which the body was grasped, in microseconds. If two hands hold linked bodies, the hand that grasped first
## carries the bodies.
var since_us: int = 0

var _hand: SpidarGHand
var _spidar: SpidarG
# The links of the held body that the spring of the hand holds.
var _seats: Array[SocketLink] = []
# The links into whose seats the body moves. The two below: the pose at which it began, and the time since then.
var _sat_on: Array[SocketLink] = []
var _caught: Transform3D = Transform3D.IDENTITY
var _seated_s: float = 0.0
# Sockets of the held body that have come off a mate and are still within its reach: instance id of the socket to that of
# the mate.
var _parted: Dictionary[int, int] = {}
# Signals of this tick. They are emitted at its end, because a listener may free any node.
var _news: Array[Callable] = []
# Force (N) and moment (N m) on the held body about the grip, until it is next carried. Sockets of other hands add to them.
var _load_n: Vector3 = Vector3.ZERO
var _load_nm: Vector3 = Vector3.ZERO
# The devices on which the spring of this body acts, by instance id: its own, and those of the hands that carry its mates.
var _sprung: Array[int] = []
var _scale: float = 1.0
var _grip: Vector3 = Vector3.ZERO
# The largest stiffness that the device renders, in N/m.
var _stiffest_n_m: float = 0.0


func _enter_tree() -> void:
	_hand = get_parent() as SpidarGHand
	add_to_group(SocketHands.HANDS)
	if not _hand.body_grasped.is_connected(_on_grasped):
		_hand.body_grasped.connect(_on_grasped)
		_hand.body_released.connect(_on_released)
	if _hand.get_held_body() != null:
		_on_grasped(_hand.get_held_body())


func _exit_tree() -> void:
	_let_go()


## Lets the spring of this hand hold a new link of the held body. Returns [code]false[/code] if nothing else carries the other
## body: a joint must then hold the link.
func take(link: SocketLink) -> bool:
	var mate: SpidarGSocket = link.other if link.one.get_body() == held else link.one
	if SocketGraph.carrier_of(mate.get_body(), held, since_us) == null:
		return false
	link.seat(self)
	return true


## Records that a socket of the held body has come off `mate`. The two are drawn together again only after they were out of
## reach of each other.
func note_parted(socket: SpidarGSocket, mate: SpidarGSocket) -> void:
	_parted[socket.get_instance_id()] = mate.get_instance_id()


## Lets this hand feel `pulls`, with the spring effect `id`. With `on_mates` the pulls are those of another hand's body, and
## their mates are on the body of this hand or on bodies that hang on it.
func feel(pulls: Array[SocketPull], id: int, on_mates: bool) -> void:
	var spring: SocketSpring = SocketSpring.about(_grip, _scale, pulls, on_mates)
	_load_n += spring.load_n
	if not spring.act(_spidar, id):
		_load_n += spring.late_force_n()
		_load_nm += spring.late_moment_nm()


## Returns the device of the hand, or [code]null[/code] before the first grasp.
func device() -> SpidarG:
	return _spidar


func _on_grasped(body: RigidBody3D) -> void:
	if body != _hand.get_held_body() or SocketGraph.sockets_of(body).is_empty():
		return
	held = body
	since_us = Time.get_ticks_usec()
	_spidar = _hand.get_parent() as SpidarG
	_look()
	_parted.clear()
	_sat_on.clear()
	_sort_links()
	_hand.carrying.connect(_on_carrying)


func _on_released(_body: RigidBody3D) -> void:
	if held != _hand.get_held_body():
		_let_go()


# Ends the springs; joints take over.
func _let_go() -> void:
	if held == null:
		return
	var body: RigidBody3D = held
	held = null
	_hand.carrying.disconnect(_on_carrying)
	_end_springs([])
	_load_n = Vector3.ZERO
	_load_nm = Vector3.ZERO
	var seats: Array[SocketLink] = _seats_of(body)
	_seats.clear()
	if seats.is_empty():
		return
	body.linear_velocity = Vector3.ZERO
	body.angular_velocity = Vector3.ZERO
	var next: SocketHand = SocketHands.holder_of(body)  # Two hands may hold one body.
	for link: SocketLink in seats:
		if next == null:
			link.lock()
		else:
			link.seat(next)


func _on_carrying(delta: float) -> void:
	if held == null or held != _hand.get_held_body():
		return
	_look()
	var wanted: Transform3D = _hand.get_wanted_pose()
	_sort_links()
	var pulls: Array[SocketPull] = []
	for socket: SpidarGSocket in SocketGraph.sockets_of(held):
		var link: SocketLink = _seat_of(socket)
		if link != null:
			_strain(link, socket, wanted * socket.transform)
		elif socket._is_free():
			_approach(socket, wanted * socket.transform, pulls)
	_share(pulls)
	_add_seats(pulls, wanted)
	_render(pulls)
	_add_weights()
	_hand.add_load(_load_n, _load_nm)
	_load_n = Vector3.ZERO
	_load_nm = Vector3.ZERO
	_sit(wanted, delta)
	_tell()


func _look() -> void:
	_scale = _spidar.workspace_scale
	_grip = _spidar.get_grip_transform().origin
	_stiffest_n_m = _spidar.get_stiffness_limits().x


# A link to something that is carried can be pulled off, so the spring holds it. Every other link is rigid.
func _sort_links() -> void:
	for socket: SpidarGSocket in SocketGraph.sockets_of(held):
		for link: SocketLink in socket._links:
			if link.holder != null and link.holder != self:
				continue
			var mate: PhysicsBody3D = link.mate_of(socket).get_body()
			if SocketGraph.carrier_of(mate, held, since_us) == null:
				link.lock()
			elif link.holder == null:
				link.seat(self)
	_seats = _seats_of(held)


func _seats_of(body: RigidBody3D) -> Array[SocketLink]:
	var seats: Array[SocketLink] = []
	for socket: SpidarGSocket in SocketGraph.sockets_of(body):
		for link: SocketLink in socket._links:
			if link.holder == self:
				seats.append(link)
	return seats


func _seat_of(socket: SpidarGSocket) -> SocketLink:
	for link: SocketLink in _seats:
		if link.one == socket or link.other == socket:
			return link
	return null


# Returns the socket of a link that is not on the held body.
func _mate(link: SocketLink) -> SpidarGSocket:
	return link.other if link.one.get_body() == held else link.one


func _mine(link: SocketLink) -> SpidarGSocket:
	return link.one if link.one.get_body() == held else link.other


# Tears a socket off its seat if the pull is strong enough. `at` is the pose of the socket if the body followed the grip.
func _strain(link: SocketLink, socket: SpidarGSocket, at: Transform3D) -> void:
	var mate: SpidarGSocket = link.mate_of(socket)
	var way: Vector3 = (mate.global_position - at.origin) / _scale
	var pull_n: float = minf(socket.stiffness, _stiffest_n_m) * way.length()
	if pull_n > socket.release_force:
		_seats.erase(link)
		note_parted(socket, mate)
		link.cut()
		_news.append(_tell_unlinked.bind(socket.get_instance_id(), mate.get_instance_id(), pull_n))


# Finds a mate for a free socket, and links the two or attracts them. `at` is the pose of the socket if the body followed
# the grip.
func _approach(socket: SpidarGSocket, at: Transform3D, pulls: Array[SocketPull]) -> void:
	var mate: SpidarGSocket = _nearest(socket, at)
	if mate == null:
		return
	var far_m: float = at.origin.distance_to(mate.global_position) / _scale
	# The magnet draws the body itself, ahead of the hand: whichever comes there first snaps in.
	var body_m: float = socket.global_position.distance_to(mate.global_position) / _scale
	if minf(far_m, body_m) <= socket.latch_distance and SocketPull.turn_between(socket, at, mate) <= socket.latch_angle:
		_latch(socket, mate)
		return
	var pull: SocketPull = SocketPull.make(socket, at, mate)
	pull.share = smoothstep(socket.capture_distance, SocketPull.FULL_FROM * socket.capture_distance, far_m)
	var force_n: float = pull.share * minf(socket.attraction_force, SocketPull.LOAD_STIFFNESS_N_M * far_m)
	pull.force_n = force_n * at.origin.direction_to(mate.global_position)
	# Across the way, a central force is as stiff as this.
	pull.stiffness_n_m = force_n / maxf(far_m, 1e-6)
	pulls.append(pull)


func _latch(socket: SpidarGSocket, mate: SpidarGSocket) -> void:
	var link: SocketLink = SocketLink.make(socket, mate)
	if take(link):
		_seats.append(link)
	else:
		link.lock()
	_news.append(_tell_linked.bind(socket.get_instance_id(), mate.get_instance_id()))


# Returns the nearest free socket within reach that fits, or null.
func _nearest(socket: SpidarGSocket, at: Transform3D) -> SpidarGSocket:
	var best: SpidarGSocket = null
	var best_m: float = socket.capture_distance * _scale
	for node: Node in get_tree().get_nodes_in_group(SocketHands.group_of(socket.key)):
		var mate: SpidarGSocket = node as SpidarGSocket
		var far_m: float = at.origin.distance_to(mate.global_position)
		if far_m >= best_m:
			if _parted.get(socket.get_instance_id(), 0) == mate.get_instance_id() and (
				far_m >= socket.capture_distance * _scale
			):
				_parted.erase(socket.get_instance_id())
			continue
		if _may_draw(socket, mate) and SocketPull.turn_between(socket, at, mate) < socket.capture_angle:
			best = mate
			best_m = far_m
	return best


func _may_draw(socket: SpidarGSocket, mate: SpidarGSocket) -> bool:
	var body: PhysicsBody3D = mate.get_body()
	if body == null or body == held or not socket.fits(mate) or not mate._is_free():
		return false
	if _parted.get(socket.get_instance_id(), 0) == mate.get_instance_id():
		return false
	if mate.get_world_3d() != socket.get_world_3d() or SocketGraph.meeting(socket).has(mate):
		return false
	var holder: SocketHand = SocketHands.holder_of(body)
	return holder == null or holder.since_us < since_us  # Else it is the other hand that draws.


# Divides the pulls of several sockets of one body, so that together they are no larger and no stiffer than one.
func _share(pulls: Array[SocketPull]) -> void:
	var shares: float = 0.0
	for pull: SocketPull in pulls:
		shares += pull.share
	for pull: SocketPull in pulls:
		pull.weaken(maxf(shares, 1.0))


func _add_seats(pulls: Array[SocketPull], wanted: Transform3D) -> void:
	for link: SocketLink in _seats:
		var socket: SpidarGSocket = _mine(link)
		var pull: SocketPull = SocketPull.make(socket, wanted * socket.transform, _mate(link))
		pull.is_seat = true
		pull.share = 1.0
		pull.stiffness_n_m = minf(socket.stiffness, _stiffest_n_m)
		pull.force_n = pull.stiffness_n_m * (pull.mate.global_position - pull.at.origin) / _scale
		pull.weaken(_seats.size())
		pulls.append(pull)


# Applies the pulls to this hand, and the opposite ones to the mates: to other hands and to loose bodies.
func _render(pulls: Array[SocketPull]) -> void:
	var devices: Array[int] = []
	if not pulls.is_empty():
		feel(pulls, _spring_id(), false)
		devices.append(_spidar.get_instance_id())
	var on_hands: Dictionary[int, Array] = {}
	for pull: SocketPull in pulls:
		var body: PhysicsBody3D = pull.mate.get_body()
		var carrier: Node = SocketGraph.carrier_of(body, held, since_us)
		if carrier is SocketHand:
			(on_hands.get_or_add(carrier.get_instance_id(), [] as Array[SocketPull]) as Array).append(pull)
		elif carrier == null and not SocketGraph.joined_to(held, null).has(body):
			(body as RigidBody3D).apply_force(-pull.force_n, pull.mate.global_position - body.global_position)
	for id: int in on_hands:
		var hand: SocketHand = instance_from_id(id) as SocketHand
		hand.feel(on_hands[id], _spring_id(), true)
		devices.append(hand.device().get_instance_id())
	_end_springs(devices)


# Adds the weight of the bodies that hang on the held body.
func _add_weights() -> void:
	if not _hand.render_weight:
		return
	for body: RigidBody3D in SocketGraph.hanging_on(self):
		var state: PhysicsDirectBodyState3D = PhysicsServer3D.body_get_direct_state(body.get_rid())
		if state == null:
			continue
		var weight_n: Vector3 = _hand.weight_scale * body.mass * state.total_gravity
		var middle: Vector3 = body.global_transform * state.center_of_mass_local
		_load_n += weight_n
		_load_nm += (middle - _grip).cross(weight_n) / _scale


# Keeps the held body in its seat, while the grip moves on alone.
func _sit(wanted: Transform3D, delta: float) -> void:
	if _seats != _sat_on:
		_sat_on = _seats.duplicate()
		_caught = held.global_transform
		_seated_s = 0.0
	if _seats.is_empty():
		return
	_seated_s += delta
	_hand.detain(_caught.interpolate_with(_seat(wanted), smoothstep(0.0, SEATING_S, _seated_s)))


# Ends the spring of this body on all devices but these.
func _end_springs(but: Array[int]) -> void:
	for id: int in _sprung:
		var spidar: SpidarG = instance_from_id(id) as SpidarG
		if spidar != null and not but.has(id):
			spidar.clear_effect(_spring_id())
	_sprung = but


# Returns the effect id of the spring. It is negative, so that it is unlike the ids of a game, and differs for each hand.
func _spring_id() -> int:
	return -1 - (get_instance_id() & 0xFFFFFF)


# Returns the pose of the held body in its seat: exactly on its mate. A ball joint turns with the hand, and two ball joints
# define a line.
func _seat(wanted: Transform3D) -> Transform3D:
	for link: SocketLink in _seats:
		if not _mine(link).turns_freely:
			return _mate(link).global_transform.orthonormalized() * _mine(link).transform.affine_inverse()
	var first: SpidarGSocket = _mine(_seats[0])
	var first_place: Vector3 = _mate(_seats[0]).global_position
	var turned: Basis = wanted.basis.orthonormalized()
	if _seats.size() > 1:
		var second: SpidarGSocket = _mine(_seats[1])
		var second_place: Vector3 = _mate(_seats[1]).global_position
		var as_held: Vector3 = turned * (second.position - first.position)
		var as_seated: Vector3 = second_place - first_place
		if not as_seated.is_zero_approx() and not as_held.is_zero_approx():
			turned = Basis(Quaternion(as_held.normalized(), as_seated.normalized())) * turned
			# What is left of the lengths' difference is shared by both ends.
			var middle: Vector3 = 0.5 * (first_place + second_place)
			return Transform3D(turned, middle - turned * (0.5 * (first.position + second.position)))
	return Transform3D(turned, first_place - turned * first.position)


func _tell() -> void:
	var news: Array[Callable] = _news
	_news = []
	for one: Callable in news:
		one.call()


static func _tell_linked(socket_id: int, mate_id: int) -> void:
	var socket: SpidarGSocket = instance_from_id(socket_id) as SpidarGSocket
	var mate: SpidarGSocket = instance_from_id(mate_id) as SpidarGSocket
	if socket != null and mate != null:
		socket._tell_linked(mate)


static func _tell_unlinked(socket_id: int, mate_id: int, pull_n: float) -> void:
	var socket: SpidarGSocket = instance_from_id(socket_id) as SpidarGSocket
	var mate: SpidarGSocket = instance_from_id(mate_id) as SpidarGSocket
	if socket != null and mate != null:
		socket._tell_unlinked(mate, pull_n)
