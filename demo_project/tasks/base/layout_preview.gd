@tool
extends Node3D
## Shows a task's things in the editor, as a level and a seed lay them out. They are never saved, and a running task has its own.

const TaskLayout := preload("res://tasks/base/task_layout.gd")

## A script that extends task_layout.gd.
@export var layout: GDScript:
	set(value):
		layout = value
		_show()
@export_range(1, 3) var level := 1:
	set(value):
		level = value
		_show()
@export_range(1, 1000) var seed_number := 1:
	set(value):
		seed_number = value
		_show()


func _ready() -> void:
	if Engine.is_editor_hint():
		_show()
	else:
		queue_free()


func _show() -> void:
	if not Engine.is_editor_hint() or not is_node_ready():
		return
	for child in get_children():
		remove_child(child)
		child.queue_free()
	if layout != null:
		(layout.new() as TaskLayout).lay_out(self, level, seed_number)
