extends RefCounted
## Finds the node that the events of a [SpidarGClipPlayer] come from, and states what that node lacks.

const Event := SpidarGClipPlayer.Event

## The device, hand, surface or body that is the source, or [code]null[/code].
var node: Node = null
## The body, if the source is a body or a surface of one, or [code]null[/code].
var body: PhysicsBody3D = null
## The surface, if the source is a surface or a body that has one, or [code]null[/code].
var surface: SpidarGSurface = null
## The hand, if the source is a hand or a device that has one: only its events count. Otherwise [code]null[/code].
var hand: SpidarGHand = null
## The device, if the source is a device or a hand of one, or [code]null[/code].
var spidar: SpidarG = null


## Returns a new object of this class for `player`: its source is the node at `path`, or the nearest ancestor that can be a
## source if `path` is empty.
static func find(player: Node, path: NodePath) -> RefCounted:
	var source: RefCounted = new()
	source._take(player.get_node_or_null(path) if not path.is_empty() else _above(player))
	return source


## Returns why this source cannot give the event `event`, with a remedy. Returns an empty string if it can.
func problem(event: Event, path: NodePath) -> String:
	if not path.is_empty() and node == null:
		return "source_path \"%s\" leads to no SpidarG, SpidarGHand, SpidarGSurface or physics body. Choose one, or clear the path." % path
	var named: String = Event.find_key(event)
	match event:
		Event.NONE:
			return ""
		Event.GRASP, Event.RELEASE:
			if body != null and not body is RigidBody3D:
				return "%s does not come from \"%s\": only a RigidBody3D is grasped. Use TOUCH, or choose a RigidBody3D." % [named, body.name]
			if node == null or (body == null and hand == null):
				return "%s has no source here: make the player a child of a RigidBody3D or of a SpidarGHand, or set source_path." % named
			return ""
	if surface != null:
		return ""
	if body != null:
		return "%s has no source here: give \"%s\" a SpidarGSurface as a child." % [named, body.name]
	return "%s has no source here: it comes from a SpidarGSurface. Make the player a child of one or of its body, or set source_path." % named


func _take(found: Node) -> void:
	if not _is_source(found):
		return
	node = found
	surface = found as SpidarGSurface
	body = (surface.get_parent() if surface != null else found) as PhysicsBody3D
	if surface == null and body != null:
		surface = _child_of(body, func(child: Node) -> bool: return child is SpidarGSurface) as SpidarGSurface
	hand = found as SpidarGHand
	spidar = (found.get_parent() if hand != null else found) as SpidarG
	if hand == null and spidar != null:
		hand = _child_of(spidar, func(child: Node) -> bool: return child is SpidarGHand) as SpidarGHand


static func _above(player: Node) -> Node:
	var above: Node = player.get_parent()
	while above != null and not _is_source(above):
		above = above.get_parent()
	return above


static func _is_source(found: Node) -> bool:
	return found is SpidarG or found is SpidarGHand or found is SpidarGSurface or found is PhysicsBody3D


static func _child_of(parent: Node, fits: Callable) -> Node:
	for child: Node in parent.get_children():
		if fits.call(child):
			return child
	return null
