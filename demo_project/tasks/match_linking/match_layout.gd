@tool
extends "res://tasks/base/task_layout.gd"
## The target shape of a level, and the matches on their rack.

const MatchRack := preload("res://tasks/match_linking/match_rack.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")

const MATCH := preload("res://tasks/match_linking/match.tscn")
const RACK := preload("res://tasks/match_linking/match_rack.tscn")
## By level: a diamond; a fish (a diamond with an open tail); a tent whose four poles meet in the air.
const SHAPES: Array[PackedScene] = [
	preload("res://tasks/match_linking/shapes/diamond.tscn"),
	preload("res://tasks/match_linking/shapes/fish.tscn"),
	preload("res://tasks/match_linking/shapes/tent.tscn"),
]

const BOARD_Z_M := -0.028
## Middle of the rack, and height of its rails, as in its scene.
const RACK_Z_M := 0.092
const RAIL_TOP_M := 0.045
const JITTER_M := 0.002
## By level: how far the matches lie turned, and how near their ends have to come to the corners.
const YAW_RAD: PackedFloat64Array = [0.0, deg_to_rad(8.0), deg_to_rad(15.0)]
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.005, 0.004, 0.004]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(8.0), deg_to_rad(6.0), deg_to_rad(6.0)]

var shape: MatchShape

var _random := RandomNumberGenerator.new()


func lay_out(items: Node3D, level: int, seed_number: int) -> void:
	_random.seed = seed_number
	shape = SHAPES[level - 1].instantiate()
	shape.position += Vector3(
		_random.randf_range(-JITTER_M, JITTER_M), 0.0, BOARD_Z_M + _random.randf_range(-JITTER_M, JITTER_M)
	)
	items.add_child(shape)
	carriers.assign(shape.pegs)
	var rack: MatchRack = RACK.instantiate()
	rack.places = shape.edges.size()
	items.add_child(rack)
	for number in rack.places:
		var stick: MatchStick = MATCH.instantiate()
		stick.name = "Match%d" % number
		stick.label = "match_%d" % number
		stick.shape = shape
		stick.position_tolerance_m = POSITION_TOLERANCE_M[level - 1]
		stick.rotation_tolerance_rad = ROTATION_TOLERANCE_RAD[level - 1]
		stick.start = _start(rack.place_x_m(number), YAW_RAD[level - 1])
		stick.transform = stick.start
		items.add_child(stick)
		carriers.append(stick)
		bodies.append(stick)
	bodies[0].felt.checks_release = true


## The edges in a seeded order, one a match: a script has to know where it goes. Call after lay_out.
func choose_edges() -> void:
	for index in bodies.size():
		(bodies[index] as MatchStick).edge = index
	for last in range(bodies.size() - 1, 0, -1):
		var one := bodies[last] as MatchStick
		var other := bodies[_random.randi_range(0, last)] as MatchStick
		var kept := one.edge
		one.edge = other.edge
		other.edge = kept


func _start(middle_x_m: float, yaw_limit: float) -> Transform3D:
	var x := middle_x_m + _random.randf_range(-JITTER_M, JITTER_M)
	var yaw := _random.randf_range(-yaw_limit, yaw_limit)
	return Transform3D(Basis(Vector3.UP, yaw), Vector3(x, RAIL_TOP_M + 0.5 * MatchStick.THICK_M, RACK_Z_M))
