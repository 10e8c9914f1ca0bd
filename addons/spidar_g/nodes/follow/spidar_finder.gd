extends RefCounted
## Helps the nodes that follow a [SpidarG]: finds their device, and makes them run after the device in each frame and tick.


## Returns the [SpidarG] at `path` as seen from `node`, or the nearest ancestor of `node` that is one if `path` is empty.
## Returns [code]null[/code] if there is none, or if the add-on's library is missing.
static func find(node: Node, path: NodePath) -> SpidarG:
	if not ClassDB.class_exists(&"SpidarG"):
		return null
	if not path.is_empty():
		return node.get_node_or_null(path) as SpidarG
	var above: Node = node.get_parent()
	while above != null and not above is SpidarG:
		above = above.get_parent()
	return above as SpidarG


## Returns the [SpidarGHand] of `spidar`, which is its first child of this type, or [code]null[/code].
static func find_hand(spidar: SpidarG) -> SpidarGHand:
	if spidar == null:
		return null
	for child: Node in spidar.get_children():
		if child is SpidarGHand:
			return child as SpidarGHand
	return null


## Returns a warning that says why [method find] found nothing. Returns an empty string if it finds a device.
static func problem(node: Node, path: NodePath, name: String) -> String:
	if find(node, path) != null or not ClassDB.class_exists(&"SpidarG"):
		return ""
	if not path.is_empty():
		return "%s does nothing: spidar_path \"%s\" leads to no SpidarG. Choose a SpidarG node, or clear the path to use an ancestor." % [name, path]
	return "%s does nothing: none of its ancestors is a SpidarG. Move it below a SpidarG, or set spidar_path." % name


## Makes `node` run after `leader` in each frame and physics tick: raises the process priorities of `node` as little as
## possible. Nodes with the same priority run in the order of the scene tree.
static func run_after(node: Node, leader: Node) -> void:
	if leader == null:
		return
	var least: int = 0 if node.is_greater_than(leader) else 1
	node.process_physics_priority = maxi(node.process_physics_priority, leader.process_physics_priority + least)
	node.process_priority = maxi(node.process_priority, leader.process_priority + least)
