@tool
extends RefCounted
## Lets sockets and hands of a scene tree find each other, by groups and by one SocketHand node in each [SpidarGHand]. All of
## this is in the scene tree, so nothing outlives a scene.

const SocketHand := preload("socket_hand.gd")

## The group that contains all sockets.
const SOCKETS: StringName = &"_spidar_g_sockets"
## The group that contains the SocketHand of each hand.
const HANDS: StringName = &"_spidar_g_socket_hands"


## Returns the group that contains the sockets with this key.
static func group_of(key: StringName) -> StringName:
	return StringName("_spidar_g_sockets_" + key)


## Gives every hand of the tree a SocketHand. Until [method unwatch], each hand that enters the tree gets one too.
static func watch(tree: SceneTree) -> void:
	# Without the add-on's library a SpidarGHand is a stand-in, which holds nothing.
	if not ClassDB.class_exists(&"SpidarG") or tree.node_added.is_connected(_on_node_added):
		return
	tree.node_added.connect(_on_node_added)
	_equip_all.call_deferred(tree)


## Stops looking for new hands, if no socket is left in the tree.
static func unwatch(tree: SceneTree) -> void:
	if tree.get_node_count_in_group(SOCKETS) == 0 and tree.node_added.is_connected(_on_node_added):
		tree.node_added.disconnect(_on_node_added)


## Returns the SocketHand of the hand that holds `body`, or [code]null[/code]. Of several hands, returns the one that grasped
## first.
static func holder_of(body: PhysicsBody3D) -> SocketHand:
	var found: SocketHand = null
	if body == null or not body.is_inside_tree():
		return found
	for node: Node in body.get_tree().get_nodes_in_group(HANDS):
		var hand: SocketHand = node as SocketHand
		if hand.held == body and (found == null or hand.since_us < found.since_us):
			found = hand
	return found


## Records that two sockets have come apart. A hand that still holds the body of one of them draws the two together again only
## after they were out of reach of each other.
static func note_parted(one: SpidarGSocket, other: SpidarGSocket) -> void:
	var by_one: SocketHand = holder_of(one.get_body())
	var by_other: SocketHand = holder_of(other.get_body())
	if by_one != null:
		by_one.note_parted(one, other)
	if by_other != null:
		by_other.note_parted(other, one)


static func _on_node_added(node: Node) -> void:
	if node is SpidarGHand:
		_equip.call_deferred(node.get_instance_id())


static func _equip_all(tree: SceneTree) -> void:
	for node: Node in tree.root.find_children("*", "SpidarGHand", true, false):
		_equip(node.get_instance_id())


static func _equip(hand_id: int) -> void:
	var hand: SpidarGHand = instance_from_id(hand_id) as SpidarGHand
	if hand == null:
		return
	for child: Node in hand.get_children(true):
		if child is SocketHand:
			return
	# Internal: a copy of the hand gets one of its own.
	hand.add_child(SocketHand.new(), false, Node.INTERNAL_MODE_BACK)
