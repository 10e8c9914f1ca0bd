extends "res://tasks/base/demo_task.gd"
## A task of things that link: what robot, matches and free play have in common.

const Link := preload("res://scene/link.gd")
const Linker := preload("res://scene/linker.gd")

@onready var linker: Linker = $Linker


func _ready() -> void:
	linker.setup(spidar, tool_hand)
	super()
	linker.sound_with(_feedback.sound)


func _use_layout(layout: TaskLayout) -> void:
	linker.clear()
	super(layout)
	for carrier in layout.carriers:
		linker.add_carrier(carrier)


## Only what falls is a drop: a linked thing stays where it is.
func _note_release(body: TaskBody) -> void:
	if linker.links.any(func(link: Link) -> bool: return link.socket_on(body) != null):
		return
	if body.global_position.y - _items.global_position.y > body.start.origin.y + DROP_HEIGHT_M:
		logger.drops += 1
