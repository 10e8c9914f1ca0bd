@tool
extends StaticBody3D
## One choice of the menu in the scene: a block that the grip touches and closes on, and its name.

const DemoPalette := preload("res://scene/demo_palette.gd")

## What it opens, as in hub/task_list.gd; or level.
@export var entry: StringName = &""
@export var text := "":
	set(value):
		text = value
		_show()
@export var colour := Color.WHITE:
	set(value):
		colour = value
		_show()


func _ready() -> void:
	_show()


## Of the block's middle, where the fingers go.
func distance_to(point: Vector3) -> float:
	return point.distance_to(($Knob as Node3D).global_position)


func show_touched(touched: bool) -> void:
	_material().emission_enabled = touched
	($Label as Label3D).modulate = DemoPalette.ACCENT if touched else DemoPalette.TEXT


## Does nothing while the scene is still being put together.
func _show() -> void:
	if not is_node_ready() and get_node_or_null(^"Label") == null:
		return
	($Label as Label3D).text = text
	_material().albedo_color = colour
	_material().emission = colour


func _material() -> StandardMaterial3D:
	return ($Knob as MeshInstance3D).material_override as StandardMaterial3D
