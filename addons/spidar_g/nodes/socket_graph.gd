@tool
extends RefCounted
## Finds which bodies are connected by links of sockets, and what carries these bodies.

const SocketHand := preload("socket_hand.gd")
const SocketHands := preload("socket_hands.gd")
const SocketLink := preload("socket_link.gd")


## Returns the sockets of a body, in the order of the scene tree.
static func sockets_of(body: Node) -> Array[SpidarGSocket]:
	var sockets: Array[SpidarGSocket] = []
	for child: Node in body.get_children():
		if child is SpidarGSocket:
			sockets.append(child as SpidarGSocket)
	return sockets


## Returns all bodies that links connect to `body`, directly or through other bodies. The first one is `body` itself. Paths
## through the body `without` are ignored.
static func joined_to(body: PhysicsBody3D, without: PhysicsBody3D) -> Array[PhysicsBody3D]:
	var reached: Array[PhysicsBody3D] = [body]
	var index: int = 0
	while index < reached.size():
		for socket: SpidarGSocket in sockets_of(reached[index]):
			for link: SocketLink in socket._links:
				var next: PhysicsBody3D = link.mate_of(socket).get_body()
				if next != null and next != without and not reached.has(next):
					reached.append(next)
		index += 1
	return reached


## Returns what carries `body` if the body `without` is ignored. This is a connected body that is static or frozen, or else
## the SocketHand of a connected body that was grasped before the time `since_us` (in microseconds). Returns [code]null[/code]
## if nothing carries `body`.
static func carrier_of(body: PhysicsBody3D, without: PhysicsBody3D, since_us: int) -> Node:
	var by_hand: SocketHand = null
	for reached: PhysicsBody3D in joined_to(body, without):
		if not _is_loose(reached):
			return reached
		var holder: SocketHand = SocketHands.holder_of(reached)
		if holder != null and holder.since_us < since_us:
			by_hand = holder
	return by_hand


## Returns the bodies that links connect to the body in this hand. Returns an empty array if anything else carries one of
## them: a static or frozen body, or a hand that grasped earlier.
static func hanging_on(hand: SocketHand) -> Array[RigidBody3D]:
	var hanging: Array[RigidBody3D] = []
	for reached: PhysicsBody3D in joined_to(hand.held, null):
		if reached == hand.held:
			continue
		var holder: SocketHand = SocketHands.holder_of(reached)
		if not _is_loose(reached) or (holder != null and holder.since_us < hand.since_us):
			return []
		hanging.append(reached as RigidBody3D)
	return hanging


## Returns all sockets that links connect to `socket`, directly or through other sockets. They meet in one point. The first
## one is `socket` itself.
static func meeting(socket: SpidarGSocket) -> Array[SpidarGSocket]:
	var met: Array[SpidarGSocket] = [socket]
	var index: int = 0
	while index < met.size():
		for mate: SpidarGSocket in met[index].get_mates():
			if not met.has(mate):
				met.append(mate)
		index += 1
	return met


static func _is_loose(body: PhysicsBody3D) -> bool:
	var rigid: RigidBody3D = body as RigidBody3D
	return rigid != null and not rigid.freeze
