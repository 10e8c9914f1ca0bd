extends "res://tasks/base/demo_task.gd"
## The task: pick every object up and put it on the outline of its own shape, colour and size.
## Kim, Koike and Sato's experiment 2 ("SPIDAR-G", section 7.2), at life size.

const ObjectLayout := preload("res://tasks/pick_and_place/object_layout.gd")


func _lay_out() -> void:
	_use_layout(ObjectLayout.new())
