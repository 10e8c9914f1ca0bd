## SpidarGWorkspace: what it says of a pose is what the solver gives there, by the defining equations.
extends "res://test_case.gd"

const AXES: PackedVector3Array = [
	Vector3.RIGHT, Vector3.LEFT, Vector3.UP, Vector3.DOWN, Vector3.BACK, Vector3.FORWARD
]
## Of a capacity: Godot's vectors are single precision.
const SHARE: float = 1e-5
const POSES: int = 40


func test_places_of_the_papers_device() -> void:
	var workspace := SpidarGWorkspace.new()
	check_equal(workspace.get_problem(), "", "the default device opens")
	var motors: PackedVector3Array = workspace.get_motor_positions()
	check_near(motors[0].distance_to(Vector3(0.24, 0.24, 0.24)), 0.0, 1e-7, "string 1 leaves at (+++)")
	check_near(motors[2].distance_to(Vector3(0.24, -0.24, 0.24)), 0.0, 1e-7, "string 3 leaves at (+-+)")
	check_near(motors[7].distance_to(Vector3(-0.24, -0.24, -0.24)), 0.0, 1e-7, "string 8 leaves at (---)")
	var place := Transform3D(Basis.IDENTITY, Vector3(0.01, 0.02, 0.03))
	var ends: PackedVector3Array = workspace.get_attachment_points(place, 0.0)
	check_near(ends[0].distance_to(place.origin + Vector3(0.0, 0.04, 0.0)), 0.0, 1e-7, "string 1: +r1 = +Y d")
	check_near(ends[4].distance_to(place.origin + Vector3(0.04, 0.0, 0.0)), 0.0, 1e-7, "string 5: +r2 = +X d")
	var box: PackedVector3Array = workspace.get_box()
	# Half the frame, less half a pole, less the margin of 1 cm.
	check_near(box[0].distance_to(Vector3.ONE * -0.19), 0.0, 1e-6, "the box's low corner")
	check_near(box[1].distance_to(Vector3.ONE * 0.19), 0.0, 1e-6, "the box's high corner")


func test_at_rest_it_agrees_with_the_report_of_the_geometry() -> void:
	for preset: int in [0, 2, 3]:
		var config := SpidarGConfig.new()
		config.preset = preset
		var workspace := SpidarGWorkspace.new()
		workspace.config = config
		var told: Dictionary = config.check_geometry()
		var forces: PackedFloat64Array = workspace.get_force_capacity(Transform3D.IDENTITY, 0.0, AXES)
		var moments: PackedFloat64Array = workspace.get_moment_capacity(Transform3D.IDENTITY, 0.0, AXES)
		var force_n: float = told["force_capacity_n"]
		var moment_nm: float = told["moment_capacity_nm"]
		check_near(_least(forces), force_n, 1e-3 * force_n, "force, preset %d" % preset)
		check_near(_least(moments), moment_nm, 1e-3 * moment_nm, "moment, preset %d" % preset)
		check(workspace.get_closure_margin(Transform3D.IDENTITY, 0.0) > 0.0, "closed, preset %d" % preset)
		var grasp: Vector2 = workspace.get_grasp_capacity(Transform3D.IDENTITY, 0.0)
		check_equal(grasp.x > 0.0 and grasp.y > 0.0, preset == 0, "a grasp torque, preset %d: %s" % [preset, grasp])


func test_what_it_promises_is_given_and_more_is_not() -> void:
	var workspace := SpidarGWorkspace.new()
	workspace.config = _exact_config()
	var random := RandomNumberGenerator.new()
	random.seed = 11
	var asked: int = 0
	for _i: int in POSES:
		var pose: Transform3D = _random_pose(random, 0.06, 0.4)
		var angle: float = random.randf_range(-0.3, 0.6)
		var direction: Vector3 = _random_direction(random)
		var as_moment: bool = random.randf() < 0.5
		var most: float = (
			workspace.get_moment_capacity(pose, angle, [direction])[0]
			if as_moment
			else workspace.get_force_capacity(pose, angle, [direction])[0]
		)
		if most <= 0.0:
			continue
		asked += 1
		var unit: float = 0.04 if as_moment else 1.0  # N at the pole ends
		for factor: float in [1.0 - SHARE, 1.05]:
			var wanted: Vector3 = direction * (most * factor)
			var force: Vector3 = Vector3.ZERO if as_moment else wanted
			var moment: Vector3 = wanted if as_moment else Vector3.ZERO
			var given: PackedFloat64Array = workspace.get_given_wrench(pose, angle, force, moment, 0.0)
			var error: float = _wrench_error(given, force, moment)
			if factor < 1.0:
				check_near(error, 0.0, 1e-3, "given in full at %s" % pose)
			else:
				check(error > 0.001 * most / unit, "5 %% more is not given: error %f N at %s" % [error, pose])
	check(asked > POSES / 2, "poses with some capacity: %d" % asked)


func test_tensions_balance_the_wrench_that_is_given() -> void:
	var workspace := SpidarGWorkspace.new()
	var random := RandomNumberGenerator.new()
	random.seed = 12
	var motors: PackedVector3Array = workspace.get_motor_positions()
	for _i: int in POSES:
		var pose: Transform3D = _random_pose(random, 0.1, 0.6)
		var angle: float = random.randf_range(-0.3, 0.6)
		var wanted: Vector3 = 6.0 * _random_direction(random)
		var tensions: PackedFloat64Array = workspace.get_tensions(pose, angle, wanted, Vector3.ZERO, 0.05)
		var given: PackedFloat64Array = workspace.get_given_wrench(pose, angle, wanted, Vector3.ZERO, 0.05)
		var ends: PackedVector3Array = workspace.get_attachment_points(pose, angle)
		var force := Vector3.ZERO
		var moment := Vector3.ZERO
		for string: int in 8:
			check(tensions[string] >= 0.3 - 1e-9 and tensions[string] <= 10.0 + 1e-9, "within the limits")
			var pull: Vector3 = tensions[string] * (motors[string] - ends[string]).normalized()
			force += pull
			moment += (ends[string] - pose.origin).cross(pull)
		check_near(force.distance_to(Vector3(given[0], given[1], given[2])), 0.0, 1e-4, "the strings' force")
		check_near(moment.distance_to(Vector3(given[3], given[4], given[5])), 0.0, 1e-5, "the strings' moment")


func test_closure_is_lost_away_from_the_centre() -> void:
	var workspace := SpidarGWorkspace.new()
	check_near(workspace.get_closure_margin(Transform3D.IDENTITY, 0.0), 1.0, 1e-6, "all strings alike at rest")
	var line: PackedVector3Array = []
	for i: int in 24:
		line.append(Vector3(0.01 * i, 0.0, 0.0))
	var margins: PackedFloat64Array = workspace.get_closure_margins(line, Basis.IDENTITY, 0.0)
	for i: int in line.size():
		var alone: float = workspace.get_closure_margin(Transform3D(Basis.IDENTITY, line[i]), 0.0)
		check_equal(margins[i], alone, "the map and a single place agree, %d cm" % i)
	check(margins[10] > 0.0, "closed 10 cm along x")
	check_equal(margins[15], 0.0, "lost 15 cm along x")
	# Without closure there is a direction that cannot be had at all.
	var away := Transform3D(Basis.IDENTITY, line[20])
	check_equal(_least(workspace.get_force_capacity(away, 0.0, AXES)), 0.0, "and some force cannot be given")


func test_bad_input_is_refused() -> void:
	var workspace := SpidarGWorkspace.new()
	var nowhere := Transform3D(Basis.IDENTITY, Vector3(NAN, 0.0, 0.0))
	var sheared := Transform3D(Basis.from_scale(Vector3(1.0, 2.0, 1.0)), Vector3.ZERO)
	var mirrored := Transform3D(Basis.from_scale(Vector3(-1.0, 1.0, 1.0)), Vector3.ZERO)
	for pose: Transform3D in [nowhere, sheared, mirrored]:
		check_equal(workspace.get_closure_margin(pose, 0.0), 0.0, "no margin at %s" % pose)
		check_equal(workspace.get_force_capacity(pose, 0.0, AXES).size(), 0, "no capacity at %s" % pose)
		check_equal(workspace.get_tensions(pose, 0.0, Vector3.ZERO, Vector3.ZERO, 0.0).size(), 0, "no tensions")
	var here := Transform3D.IDENTITY
	check_equal(workspace.get_attachment_points(here, NAN).size(), 0, "an angle that is no number")
	check_equal(workspace.get_attachment_points(here, 2.0).size(), 0, "an angle beyond a right one")
	check_equal(workspace.get_force_capacity(here, 0.0, [Vector3.ZERO]).size(), 0, "a direction without length")
	check_equal(workspace.get_moment_capacity(here, 0.0, [Vector3(INF, 0, 0)]).size(), 0, "an endless direction")
	check_equal(workspace.get_given_wrench(here, 0.0, Vector3.ZERO, Vector3.ZERO, NAN).size(), 0, "a torque that is no number")
	check_equal(workspace.get_closure_margins([Vector3(0, INF, 0)], Basis.IDENTITY, 0.0).size(), 0, "an endless place")
	var config := SpidarGConfig.new()
	config.frame_size = Vector3(0.48, -1.0, 0.48)
	workspace.config = config
	check(workspace.get_problem().contains("frame_size.y"), "names the field: %s" % workspace.get_problem())
	check_equal(workspace.get_closure_margin(here, 0.0), 0.0, "nothing of a frame that cannot be")


## Without the terms that give up a little of the wrench for calmer tensions.
func _exact_config() -> SpidarGConfig:
	var config := SpidarGConfig.new()
	config.reference_weight = 0.0
	config.ridge = 1e-12
	return config


func _random_pose(random: RandomNumberGenerator, reach_m: float, turn_rad: float) -> Transform3D:
	var turn := Basis(_random_direction(random), random.randf_range(-turn_rad, turn_rad))
	return Transform3D(turn, reach_m * random.randf() * _random_direction(random))


func _random_direction(random: RandomNumberGenerator) -> Vector3:
	var direction := Vector3.ZERO
	while direction.length() < 0.1:
		direction = Vector3(random.randf_range(-1, 1), random.randf_range(-1, 1), random.randf_range(-1, 1))
	return direction.normalized()


## Largest part, N at the pole ends.
func _wrench_error(given: PackedFloat64Array, force: Vector3, moment: Vector3) -> float:
	var largest: float = absf(given[6]) / 0.04
	for axis: int in 3:
		largest = maxf(largest, absf(given[axis] - force[axis]))
		largest = maxf(largest, absf(given[3 + axis] - moment[axis]) / 0.04)
	return largest


func _least(values: PackedFloat64Array) -> float:
	var least: float = INF
	for value: float in values:
		least = minf(least, value)
	return least
