@tool
extends RefCounted
## A link of two sockets. Either the spring of a hand or a joint holds the two together.

const SocketHand := preload("socket_hand.gd")
const SocketLink := preload("socket_link.gd")

## The socket from which the link was made: the one on the held body, or the one whose [method SpidarGSocket.link_to] was
## called.
var one: SpidarGSocket
## The socket to which the link was made.
var other: SpidarGSocket
## The hand whose spring holds this link. If it is [code]null[/code], a joint holds the link.
var holder: SocketHand

var _joint: Generic6DOFJoint3D
# Whether this link, and not the game, made the collision exception between the two bodies.
var _keeps_apart: bool = false


## Links two sockets, and lets their bodies no longer collide. Nothing holds the two together before [method lock] or
## [method seat] is called.
static func make(from: SpidarGSocket, to: SpidarGSocket) -> SocketLink:
	var link: SocketLink = SocketLink.new()
	link.one = from
	link.other = to
	from._links.append(link)
	to._links.append(link)
	link._keeps_apart = not link._has_exception()
	link._except()
	return link


## Returns the socket at the other end of this link.
func mate_of(socket: SpidarGSocket) -> SpidarGSocket:
	return other if socket == one else one


## Lets a joint hold the two bodies in their current poses.
func lock() -> void:
	holder = null
	if _joint != null or one.get_body() == null or other.get_body() == null:
		return
	_joint = Generic6DOFJoint3D.new()  # Its limits are all locked at zero as made.
	# Internal: a copy of the body makes no joint of its own.
	one.add_child(_joint, false, Node.INTERNAL_MODE_BACK)
	_joint.global_transform = one.global_transform.orthonormalized()
	_joint.node_a = _joint.get_path_to(other.get_body())
	_joint.node_b = _joint.get_path_to(one.get_body())


## Lets the spring of the hand `in_hand` hold the link, and removes the joint.
func seat(in_hand: SocketHand) -> void:
	holder = in_hand
	_free_joint()
	_except()


## Ends the link and wakes both bodies. They collide again, unless another link joins them, or a script had made them not
## collide before.
func cut() -> void:
	holder = null
	one._links.erase(self)
	other._links.erase(self)
	_free_joint()
	_end_exception()
	for body: RigidBody3D in [one.get_body() as RigidBody3D, other.get_body() as RigidBody3D]:
		if body != null:
			body.sleeping = false


func _free_joint() -> void:
	if _joint == null:
		return
	_joint.node_a = NodePath()
	_joint.node_b = NodePath()
	_joint.queue_free()
	_joint = null


func _has_exception() -> bool:
	return one.get_body().get_collision_exceptions().has(other.get_body())


# Makes the linked bodies not collide. It is needed again after a joint, which takes the engine's own exception with it.
func _except() -> void:
	if not _has_exception():
		one.get_body().add_collision_exception_with(other.get_body())


func _end_exception() -> void:
	var body: PhysicsBody3D = one.get_body()
	var mate: PhysicsBody3D = other.get_body()
	if not _keeps_apart or body == null or mate == null:
		return
	var heir: SocketLink = _link_between(body, mate)
	if heir != null:
		heir._keeps_apart = true
		heir._except()
		return
	body.remove_collision_exception_with(mate)


# Returns another link of the same two bodies, or null.
static func _link_between(body: PhysicsBody3D, mate: PhysicsBody3D) -> SocketLink:
	for child: Node in body.get_children():
		if child is SpidarGSocket:
			for link: SocketLink in (child as SpidarGSocket)._links:
				if link.mate_of(child as SpidarGSocket).get_body() == mate:
					return link
	return null
