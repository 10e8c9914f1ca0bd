extends RefCounted
## Two sockets that hold each other, and the joint that does it while no hand does.

const Link := preload("res://scene/link.gd")
const LinkSocket := preload("res://scene/link_socket.gd")

var one: LinkSocket
var other: LinkSocket
var joint: Generic6DOFJoint3D


static func make(one_: LinkSocket, other_: LinkSocket) -> Link:
	var link := Link.new()
	link.one = one_
	link.other = other_
	return link


## The socket on `body`, or null.
func socket_on(body: CollisionObject3D) -> LinkSocket:
	if one.carrier() == body:
		return one
	return other if other.carrier() == body else null


func mate_of(socket: LinkSocket) -> LinkSocket:
	return other if socket == one else one


## Locks the two carriers as they are.
func lock(parent: Node) -> void:
	if joint != null:
		return
	joint = Generic6DOFJoint3D.new() # Its limits are all locked at zero as made.
	parent.add_child(joint)
	joint.global_transform = one.global_transform.orthonormalized()
	joint.node_a = joint.get_path_to(other.carrier())
	joint.node_b = joint.get_path_to(one.carrier())


func unlock() -> void:
	if joint == null:
		return
	joint.node_a = NodePath()
	joint.node_b = NodePath()
	joint.queue_free()
	joint = null
