extends "res://tasks/base/linking_task.gd"
## The task: link matches end to end into the shape shown.
## Kim, Koike and Sato's experiment 4 ("SPIDAR-G", section 7.2).

const DemoPalette := preload("res://scene/demo_palette.gd")
const MatchPlayer := preload("res://tasks/match_linking/match_player.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")

const BOARD_Z_M := -0.028
## The rack: two rails across, the matches on them side by side.
const RACK_Z_M := 0.092
const RAIL_M := Vector3(0.0, 0.045, 0.004)
const RAIL_SPACE_M := 0.036
const PITCH_M := 0.042
const JITTER_M := 0.002
## By level: how far the matches lie turned, and how near their ends have to come to the corners.
const YAW_RAD: PackedFloat64Array = [0.0, deg_to_rad(8.0), deg_to_rad(15.0)]
const POSITION_TOLERANCE_M: PackedFloat64Array = [0.005, 0.004, 0.004]
const ROTATION_TOLERANCE_RAD: PackedFloat64Array = [deg_to_rad(8.0), deg_to_rad(6.0), deg_to_rad(6.0)]

var shape: MatchShape


func _make_player() -> TaskPlayer:
	var match_player := MatchPlayer.new()
	match_player.linker = linker
	return match_player


func _lay_out() -> void:
	var index := arguments.level - 1
	var random := RandomNumberGenerator.new()
	random.seed = arguments.seed_number
	linker.clear()
	shape = MatchShape.of_level(arguments.level)
	shape.position += Vector3(
		random.randf_range(-JITTER_M, JITTER_M), 0.0, BOARD_Z_M + random.randf_range(-JITTER_M, JITTER_M)
	)
	_items.add_child(shape)
	for peg in shape.pegs:
		linker.add_carrier(peg)
	var count := shape.edges.size()
	_add_rack(count)
	for number in count:
		var stick := MatchStick.make(number)
		stick.shape = shape
		stick.position_tolerance_m = POSITION_TOLERANCE_M[index]
		stick.rotation_tolerance_rad = ROTATION_TOLERANCE_RAD[index]
		var x := (number - 0.5 * (count - 1)) * PITCH_M + random.randf_range(-JITTER_M, JITTER_M)
		var y := RAIL_M.y + 0.5 * MatchStick.THICK_M
		var yaw := random.randf_range(-YAW_RAD[index], YAW_RAD[index])
		stick.start = Transform3D(Basis(Vector3.UP, yaw), Vector3(x, y, RACK_Z_M))
		stick.transform = stick.start
		_items.add_child(stick)
		linker.add_carrier(stick)
		bodies.append(stick)
	bodies[0].felt.checks_release = true
	if arguments.scripted():
		_choose_edges(random)


## The edges in a seeded order, one a match: a script has to know where it goes.
func _choose_edges(random: RandomNumberGenerator) -> void:
	for index in bodies.size():
		(bodies[index] as MatchStick).edge = index
	for last in range(bodies.size() - 1, 0, -1):
		var one := bodies[last] as MatchStick
		var other := bodies[random.randi_range(0, last)] as MatchStick
		var kept := one.edge
		one.edge = other.edge
		other.edge = kept


## Any match may lie on any edge, but only one on each.
func _judge(held: RigidBody3D) -> int:
	var free: Array[int] = []
	free.assign(range(shape.edges.size()))
	var count := 0
	for body in bodies:
		var stick := body as MatchStick
		stick.placed = false
		var edge := _nearest_edge(stick, free)
		if not arguments.scripted() and stick != held:
			stick.edge = edge
		if edge != stick.edge:
			continue
		if stick.is_placed(held):
			stick.placed = true
			free.erase(edge)
			count += 1
	for edge in shape.edges.size():
		shape.show_taken(edge, not free.has(edge))
	return count


func _nearest_edge(stick: MatchStick, free: Array[int]) -> int:
	var best := -1
	for edge in free:
		if best < 0 or shape.end_error_m(stick, edge) < shape.end_error_m(stick, best):
			best = edge
	return best


func _add_rack(count: int) -> void:
	for side: float in [-1.0, 1.0]:
		var rail := StaticBody3D.new()
		rail.position = Vector3(0.0, 0.5 * RAIL_M.y, RACK_Z_M + 0.5 * side * RAIL_SPACE_M)
		_items.add_child(rail)
		StandBuilder.add_block(
			rail, Vector3(count * PITCH_M, RAIL_M.y, RAIL_M.z), Vector3.ZERO, DemoPalette.STAND
		)
