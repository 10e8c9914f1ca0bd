extends RefCounted
## What a script knows of the sockets of the thing in its hand.

## All that lie on the table.
var sockets: Array[SpidarGSocket] = []
var spidar: SpidarG
var hand: SpidarGHand


static func of(body: Node) -> Array[SpidarGSocket]:
	var own: Array[SpidarGSocket] = []
	for child in body.get_children():
		if child is SpidarGSocket:
			own.append(child as SpidarGSocket)
	return own


## How many sockets of `body` would find a mate if it were at `pose`.
func mates_at(body: PhysicsBody3D, pose: Transform3D) -> int:
	var count := 0
	for socket in of(body):
		var at := pose * socket.position
		var near_m := socket.latch_distance * spidar.workspace_scale
		count += int(sockets.any(func(mate: SpidarGSocket) -> bool:
			return mate.get_body() != body and socket.fits(mate) and (
				at.distance_to(mate.global_position) < near_m
			)
		))
	return count


## How many sockets of the held body have snapped in.
func linked_count() -> int:
	return _linked().size()


## How far the hand has pulled the held body's sockets out of where they sit: their mean, device metres.
func stretch_m() -> Vector3:
	var sum := Vector3.ZERO
	var wanted := hand.get_wanted_pose()
	var linked := _linked()
	for socket in linked:
		sum += wanted * socket.position - socket.get_mate().global_position
	return sum / (maxi(linked.size(), 1) * spidar.workspace_scale)


func _linked() -> Array[SpidarGSocket]:
	var body := hand.get_held_body()
	if body == null:
		return []
	return of(body).filter(func(socket: SpidarGSocket) -> bool: return socket.is_linked())
