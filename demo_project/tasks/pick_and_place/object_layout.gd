@tool
extends "res://tasks/base/task_layout.gd"
## Where everything starts and where it has to go, from a seed alone: same seed, same layout.

const ObjectCatalogue := preload("res://tasks/pick_and_place/object_catalogue.gd")
const OUTLINE := preload("res://tasks/pick_and_place/target_outline.tscn")
const TargetOutline := preload("res://tasks/pick_and_place/target_outline.gd")
const TaskObject := preload("res://tasks/pick_and_place/task_object.gd")

## Cells of the table. The pitch leaves room for the opened fingers (x) beside a neighbour, and keeps
## all of them where the strings can give weight and squeeze together.
const COLUMNS := 4
const ROWS := 4
const PITCH_M := Vector2(0.083, 0.065)
const JITTER_M := 0.003

## In the frame of the table top: origin at its centre, y = 0 on its surface.
var starts: Array[Transform3D] = []
var targets: Array[Transform3D] = []


func lay_out(items: Node3D, level: int, seed_number: int) -> void:
	var objects := ObjectCatalogue.of_level(level)
	choose_places(objects, seed_number, ObjectCatalogue.YAW_RAD[level - 1])
	for index in objects.size():
		var object := objects[index]
		var target: TargetOutline = OUTLINE.instantiate()
		target.setup(object, targets[index])
		items.add_child(target)
		var stand := object.make_stand()
		if stand != null:
			stand.transform = starts[index].translated_local(Vector3.DOWN * object.rest_height_m())
			items.add_child(stand)
		object.setup(starts[index], target)
		items.add_child(object)
		bodies.append(object)


## yaw_limit: boxes are turned by up to this, rad.
func choose_places(objects: Array[TaskObject], seed_number: int, yaw_limit: float) -> void:
	var random := RandomNumberGenerator.new()
	random.seed = seed_number
	var cells := _shuffled_cells(random)
	for index in objects.size():
		starts.append(_pose(objects[index], cells[index], random, yaw_limit))
	for index in objects.size():
		targets.append(_pose(objects[index], cells[objects.size() + index], random, yaw_limit))


func _pose(
	object: TaskObject, cell: Vector2, random: RandomNumberGenerator, yaw_limit: float
) -> Transform3D:
	var x := cell.x + random.randf_range(-JITTER_M, JITTER_M)
	var z := cell.y + random.randf_range(-JITTER_M, JITTER_M)
	# Round things show no yaw; drawing the number anyway keeps every seed's sequence alike.
	var yaw := random.randf_range(-yaw_limit, yaw_limit)
	if object.is_round():
		yaw = 0.0
	return Transform3D(Basis(Vector3.UP, yaw), Vector3(x, object.rest_height_m(), z))


func _shuffled_cells(random: RandomNumberGenerator) -> Array[Vector2]:
	var cells: Array[Vector2] = []
	for row in ROWS:
		for column in COLUMNS:
			cells.append(
				Vector2(column - (COLUMNS - 1) * 0.5, row - (ROWS - 1) * 0.5) * PITCH_M
			)
	cells.assign(shuffled(cells, random))
	return cells
