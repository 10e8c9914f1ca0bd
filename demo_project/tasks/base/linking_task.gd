extends "res://tasks/base/demo_task.gd"
## A task of things that link: what robot, matches and free play have in common. The sockets themselves are SpidarGSocket nodes
## of the things' scenes.

## Of everything that lies on the table.
var sockets: Array[SpidarGSocket] = []


func _use_layout(layout: TaskLayout) -> void:
	super(layout)
	_know_sockets(layout.carriers)


func _know_sockets(carriers: Array[CollisionObject3D]) -> void:
	sockets.clear()
	for carrier in carriers:
		for child in carrier.get_children():
			if child is SpidarGSocket:
				_know_socket(child as SpidarGSocket)


## A knock for what snaps in and what is pulled off, once for the two that meet.
func _know_socket(socket: SpidarGSocket) -> void:
	sockets.append(socket)
	socket.linked.connect(func(mate: SpidarGSocket) -> void:
		if socket.get_instance_id() < mate.get_instance_id():
			_feedback.sound.say(&"linked"))
	socket.unlinked.connect(func(mate: SpidarGSocket, pull_n: float) -> void:
		if pull_n > 0.0 and socket.get_instance_id() < mate.get_instance_id():
			_feedback.sound.say(&"unlinked"))


## Only what falls is a drop: a linked thing stays where it is.
func _note_release(body: TaskBody) -> void:
	for child in body.get_children():
		if child is SpidarGSocket and (child as SpidarGSocket).is_linked():
			return
	if body.global_position.y - _items.global_position.y > body.start.origin.y + DROP_HEIGHT_M:
		logger.drops += 1
