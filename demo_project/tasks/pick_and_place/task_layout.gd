extends RefCounted
## Where everything starts and where it has to go, from a seed alone: same seed, same layout.

const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")
const TaskLayout := preload("res://tasks/pick_and_place/task_layout.gd")

## Cells of the table. The pitch leaves room for the opened fingers (x) beside a neighbour, and keeps
## all of them where the strings can give weight and squeeze together.
const COLUMNS := 4
const ROWS := 4
const PITCH_M := Vector2(0.083, 0.065)
const JITTER_M := 0.003

## In the frame of the table top: origin at its centre, y = 0 on its surface.
var starts: Array[Transform3D] = []
var targets: Array[Transform3D] = []


## yaw_limit: boxes are turned by up to this, rad.
static func make(seed_number: int, specs: Array[ObjectSpec], yaw_limit: float) -> TaskLayout:
	var random := RandomNumberGenerator.new()
	random.seed = seed_number
	var cells := _shuffled_cells(random)
	var layout := TaskLayout.new()
	for index in specs.size():
		layout.starts.append(_pose(specs[index], cells[index], random, yaw_limit))
	for index in specs.size():
		layout.targets.append(_pose(specs[index], cells[specs.size() + index], random, yaw_limit))
	return layout


static func _pose(
	spec: ObjectSpec, cell: Vector2, random: RandomNumberGenerator, yaw_limit: float
) -> Transform3D:
	var x := cell.x + random.randf_range(-JITTER_M, JITTER_M)
	var z := cell.y + random.randf_range(-JITTER_M, JITTER_M)
	# Round things show no yaw; drawing the number anyway keeps every seed's sequence alike.
	var yaw := random.randf_range(-yaw_limit, yaw_limit)
	if spec.is_round():
		yaw = 0.0
	return Transform3D(Basis(Vector3.UP, yaw), Vector3(x, spec.rest_height_m(), z))


static func _shuffled_cells(random: RandomNumberGenerator) -> Array[Vector2]:
	var cells: Array[Vector2] = []
	for row in ROWS:
		for column in COLUMNS:
			cells.append(
				Vector2(column - (COLUMNS - 1) * 0.5, row - (ROWS - 1) * 0.5) * PITCH_M
			)
	for last in range(cells.size() - 1, 0, -1):
		var other := random.randi_range(0, last)
		var kept := cells[last]
		cells[last] = cells[other]
		cells[other] = kept
	return cells
