extends SceneTree
## Known answers for the demo's own mathematics. Prints FAIL lines and "N passed, N failed".

const CsvTable := preload("res://study/csv_table.gd")
const DemoSettings := preload("res://ui/demo_settings.gd")
const ExperimentPlan := preload("res://study/experiment_plan.gd")
const ExperimentStore := preload("res://study/experiment_store.gd")
const FitLine := preload("res://play/fit_line.gd")
const MatchLayout := preload("res://tasks/match_linking/match_layout.gd")
const MatchShape := preload("res://tasks/match_linking/match_shape.gd")
const MatchStick := preload("res://tasks/match_linking/match_stick.gd")
const ObjectCatalogue := preload("res://tasks/pick_and_place/object_catalogue.gd")
const ObjectLayout := preload("res://tasks/pick_and_place/object_layout.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const RobotLayout := preload("res://tasks/robot_linking/robot_layout.gd")
const RobotPart := preload("res://tasks/robot_linking/robot_part.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const TaskObject := preload("res://tasks/pick_and_place/task_object.gd")
const WidthSense := preload("res://play/width_sense.gd")

## A thin leg in a corner of the workspace, stopped at 41.2 degrees: grasp angle (degrees) and opening torque (N mm).
const LEG_STOP_DEG := 41.2
const LEG_ANGLES_DEG: PackedFloat64Array = [
	32.311, 32.398, 32.563, 32.778, 33.017, 33.303, 33.597, 33.889, 34.227, 34.584, 34.936, 35.332,
	35.739, 36.129, 36.554, 36.979, 37.380, 37.811, 38.240, 38.641, 39.072, 39.499, 39.900, 40.329,
	40.756, 41.155, 41.570, 41.931, 42.217, 42.482, 42.712, 42.915, 43.132, 43.349, 43.557, 43.790,
	44.024, 44.245,
]
const LEG_TORQUES_NMM: PackedFloat64Array = [
	0.9346, 3.0082, 3.1534, 3.6262, 3.9909, 4.7983, 5.0823, 5.2082, 5.3338, 5.4515, 5.4802, 5.4163,
	5.4565, 5.5538, 5.4185, 5.4025, 5.5533, 5.4027, 5.4141, 5.5287, 5.3429, 5.3599, 5.4966, 5.3831,
	5.3036, 5.9946, 6.7963, 8.2012, 9.6896, 10.1858, 11.2136, 11.9563, 12.7268, 13.5936, 14.7379, 15.4758,
	16.4184, 17.3173,
]

var _passed := 0
var _failed := 0


func _initialize() -> void:
	_check_width_sense()
	_check_rotation_error()
	_check_layout()
	_check_fit_line()
	_check_catalogue()
	_check_match_shapes()
	_check_robot()
	_check_plan()
	_check_store()
	_check_minimum_jerk()
	_check_csv()
	_check_settings()
	_check_picture_quality()
	print("%d passed, %d failed" % [_passed, _failed])
	quit(0 if _failed == 0 else 1)


func _check(condition: bool, message: String) -> void:
	if condition:
		_passed += 1
	else:
		_failed += 1
		print("FAIL parts: " + message)


## Free closing that drifts with the angle once made the fingers feel a slab 4.7 mm too wide.
func _check_width_sense() -> void:
	for drift_nm_rad: float in [0.0, 0.04]:
		var sense := _closing(deg_to_rad(30.0), deg_to_rad(38.0), drift_nm_rad, 0.25)
		var off_deg := rad_to_deg(sense.touch_angle_rad()) - 38.0
		_check(absf(off_deg) < 0.1, "touch is %.2f deg off at a drift of %.2f" % [off_deg, drift_nm_rad])
		# Above free closing where the touch began; its drift is not taken off from there on.
		var push := (0.25 + drift_nm_rad) * deg_to_rad(4.0)
		_check(absf(sense.push_nm() - push) < 5e-4, "push %.5f, not %.5f" % [sense.push_nm(), push])
	var nothing := _closing(deg_to_rad(30.0), deg_to_rad(38.0), 0.04, 0.0)
	_check(is_nan(nothing.touch_angle_rad()), "touch felt where nothing pushes")
	# The last samples once counted for late knees only: an early one won, 1.5 mm too wide.
	var leg := WidthSense.new()
	for index in LEG_ANGLES_DEG.size():
		leg.add(deg_to_rad(LEG_ANGLES_DEG[index]), 1e-3 * LEG_TORQUES_NMM[index])
	var leg_off_deg := rad_to_deg(leg.touch_angle_rad()) - LEG_STOP_DEG
	_check(absf(leg_off_deg) < 0.3, "a thin leg is touched %.2f deg off" % leg_off_deg)
	# So soft that the line of free closing once bent with it: felt 10 mm late.
	var soft := _closing(deg_to_rad(26.0), deg_to_rad(34.0), 0.005, 0.04)
	var soft_off_deg := rad_to_deg(soft.touch_angle_rad()) - 34.0
	_check(absf(soft_off_deg) < 0.3, "something soft is touched %.2f deg off" % soft_off_deg)
	_check(is_nan(WidthSense.new().touch_angle_rad()), "touch felt without a sample")


## Closing from start to 4 degrees past the stop, 0.4 degrees a tick.
func _closing(start: float, stop: float, drift_nm_rad: float, stiffness_nm_rad: float) -> WidthSense:
	var sense := WidthSense.new()
	for tick in 31:
		var angle := start + deg_to_rad(0.4) * tick
		var torque := 0.004 + drift_nm_rad * (angle - start)
		sense.add(angle, torque + stiffness_nm_rad * maxf(angle - stop, 0.0))
	return sense


func _check_rotation_error() -> void:
	var square := _object("blue_box")
	var slab := _object("coral_slab")
	var cylinder := _object("teal_cylinder")
	var quarter := Basis(Vector3.UP, PI * 0.5)
	var tilt := Basis(Vector3.RIGHT, 0.3)
	_near(square.turn_as_shown(quarter, Basis()), 0.0, "square, quarter turn")
	_near(slab.turn_as_shown(quarter, Basis()), PI * 0.5, "slab, quarter turn")
	_near(slab.turn_as_shown(quarter * quarter, Basis()), 0.0, "slab, half turn")
	_near(slab.turn_as_shown(tilt, Basis()), 0.3, "slab, tilt")
	_near(cylinder.turn_as_shown(quarter, Basis()), 0.0, "cylinder, turn")
	_near(cylinder.turn_as_shown(tilt, Basis()), 0.3, "cylinder, tilt")
	for object: TaskObject in [square, slab, cylinder]:
		object.free()


func _check_layout() -> void:
	var objects := ObjectCatalogue.of_level(2)
	for seed_number in range(0, 50):
		var one := _layout(objects, seed_number)
		var two := _layout(objects, seed_number)
		_check(one.starts == two.starts and one.targets == two.targets, "seed %d twice" % seed_number)
		var places := one.starts + one.targets
		var nearest := INF
		for a in places.size():
			for b in a:
				var way := places[a].origin - places[b].origin
				nearest = minf(nearest, Vector2(way.x, way.z).length())
		var least := ObjectLayout.PITCH_M.y - 2.0 * ObjectLayout.JITTER_M
		_check(nearest >= least - 1e-6, "seed %d: two things %.4f m apart" % [seed_number, nearest])
	_check(_layout(objects, 2).starts != _layout(objects, 1).starts, "seeds 1 and 2 are alike")
	for object in objects:
		object.free()


func _layout(objects: Array[TaskObject], seed_number: int) -> ObjectLayout:
	var layout := ObjectLayout.new()
	layout.choose_places(objects, seed_number, 0.2)
	return layout


func _check_fit_line() -> void:
	var line := FitLine.new()
	for x: float in [-1.0, 0.0, 2.0, 3.0]:
		line.add(x, 5.0 - 2.0 * x + (0.1 if x in [-1.0, 3.0] else -0.1))
	_near(line.slope(), -2.0, "slope of a line with an even ripple")
	_near(line.at(1.0), 3.0, "middle of a line with an even ripple")
	_near(line.ripple(), 0.1, "ripple of a line")
	_check(is_nan(FitLine.new().slope()), "a line without points has a slope")


## Levels differ in what they have to differ in, and everything fits between the fingers.
func _check_catalogue() -> void:
	for level in range(1, PlayArguments.LEVELS + 1):
		var masses: Dictionary[float, bool] = {}
		var widths: Dictionary[float, bool] = {}
		var frictions: Dictionary[float, bool] = {}
		var squeezes: Dictionary[float, bool] = {}
		for object in ObjectCatalogue.of_level(level):
			masses[object.mass] = true
			widths[object.width_m] = true
			frictions[object.physics_material_override.friction] = true
			squeezes[object.squeeze_stiffness()] = true
			_check(object.width_m <= 0.052, "%s is wider than the fingers hold" % object.label)
			object.free()
		_check(masses.size() >= 3 and widths.size() >= 3, "level %d: masses and widths" % level)
		_check(level < 3 or (frictions.size() >= 3 and squeezes.size() >= 3), "level 3: frictions, softness")


## Every edge is one match long, no further turned or raised than a hand can follow, and joins others at its ends.
func _check_match_shapes() -> void:
	for level in range(1, PlayArguments.LEVELS + 1):
		var shape: MatchShape = MatchLayout.SHAPES[level - 1].instantiate()
		for edge in shape.edges:
			var way := shape.corners[edge.y] - shape.corners[edge.x]
			_near(way.length(), MatchStick.LENGTH_M, "level %d: length of an edge" % level)
			_check(absf(atan2(way.x, way.z)) < deg_to_rad(45.0), "level %d: an edge turned too far" % level)
			_check(absf(way.y) < 0.5 * way.length(), "level %d: an edge too steep" % level)
			var met := shape.edges.filter(func(other: Vector2i) -> bool:
				return other != edge and (other.x in [edge.x, edge.y] or other.y in [edge.x, edge.y]))
			_check(not met.is_empty(), "level %d: an edge meets no other" % level)
		shape.free()


## In the finished robot each plug lies on its cup.
func _check_robot() -> void:
	var parts: Array[RobotPart] = [RobotLayout.TORSO.instantiate() as RobotPart]
	for scene in RobotLayout.LIMBS:
		parts.append(scene.instantiate() as RobotPart)
	var stand: Node3D = RobotLayout.STAND.instantiate()
	var cups: Dictionary[StringName, Vector3] = {}
	for bracket in stand.get_children():
		for child in bracket.get_children():
			if child is SpidarGSocket:
				cups[(child as SpidarGSocket).key] = (bracket as Node3D).position + (child as SpidarGSocket).position
	for child in parts[0].get_children():
		if child is SpidarGSocket and not (child as SpidarGSocket).is_plug:
			cups[(child as SpidarGSocket).key] = parts[0].place() * (child as SpidarGSocket).position
	var plugs := 0
	for part in parts:
		for child in part.get_children():
			var plug := child as SpidarGSocket
			if plug != null and plug.is_plug:
				plugs += 1
				var off := (part.place() * plug.position).distance_to(cups.get(plug.key, Vector3.INF))
				_check(off <= 1e-6, "%s: its plug is %.4f m from its cup" % [part.label, off])
		part.free()
	_check(plugs == 6 and cups.size() == 6, "%d plugs, %d cups" % [plugs, cups.size()])
	stand.free()


## Each condition once in each place, and once right after each other one; the same layouts for all.
func _check_plan() -> void:
	var places: Dictionary[String, bool] = {}
	var pairs: Dictionary[String, bool] = {}
	for participant in range(1, 5):
		var order: PackedStringArray = []
		var seeds: Dictionary[String, Array] = {}
		for step in ExperimentPlan.make(participant, 3, ["one", "two", "three"]):
			if step.kind != ExperimentPlan.Kind.TRIAL:
				continue
			if not order.has(step.condition):
				order.append(step.condition)
			var key := "%s/%s" % [step.task, step.condition]
			if not seeds.has(key):
				seeds[key] = []
			seeds[key].append(step.seed_number)
		_check(seeds.size() == 12 and order.size() == 4, "participant %d: %s" % [participant, seeds.keys()])
		for key in seeds:
			_check(seeds[key] == [1, 2, 3], "%s: layouts %s" % [key, seeds[key]])
		for place in order.size():
			places["%d %s" % [place, order[place]]] = true
			if place > 0:
				pairs["%s %s" % [order[place - 1], order[place]]] = true
	_check(places.size() == 16, "%d of 16 places and conditions" % places.size())
	_check(pairs.size() == 12, "%d of 12 neighbours" % pairs.size())


## A torn last line and the trace of an unfinished trial go; what is finished stays as it was.
func _check_store() -> void:
	var folder := ProjectSettings.globalize_path("user://check_store")
	for name: String in ["summary.csv", "ratings.csv", "trace.csv"]:
		DirAccess.remove_absolute(folder.path_join(name))
	var store := ExperimentStore.new()
	_check(store.open(folder, "s") == "", "a new folder is refused")
	var head := {"session_id": "s", "task": "t", "condition": "c", "trial": 1}
	store.append("trace.csv", [head.merged({"time_s": 0.5})])
	store.append("summary.csv", [head.merged({"completed": true})])
	var before := FileAccess.get_file_as_string(folder.path_join("trace.csv"))
	store.append("trace.csv", [head.merged({"trial": 2, "time_s": 0.5}, true)])
	var torn := FileAccess.open(folder.path_join("summary.csv"), FileAccess.READ_WRITE)
	torn.seek_end()
	torn.store_string("1,s,3,t")
	torn.close()
	var again := ExperimentStore.new()
	_check(again.open(folder, "s") == "", "a folder with a torn line is refused")
	_check(again.rows_of("summary.csv").size() == 1, "rows after mending: %s" % [again.rows_of("summary.csv")])
	_check(again.done("summary.csv").keys() == ["t/c/1"], "done: %s" % [again.done("summary.csv")])
	var after := FileAccess.get_file_as_string(folder.path_join("trace.csv"))
	_check(after == before, "the trace of an unfinished trial: " + after)
	again.append("summary.csv", [head.merged({"trial": 2, "abort_reason": "x"}, true)])
	_check(not again.done("summary.csv").has("t/c/2"), "an aborted trial counts as done")


func _check_minimum_jerk() -> void:
	_near(ScriptedHand.minimum_jerk(0.0), 0.0, "minimum jerk, start")
	_near(ScriptedHand.minimum_jerk(0.5), 0.5, "minimum jerk, middle")
	_near(ScriptedHand.minimum_jerk(1.0), 1.0, "minimum jerk, end")


func _check_csv() -> void:
	var path := "user://check_parts.csv"
	var table := CsvTable.new(["a", "b", "c", "d"])
	table.add_row({"a": NAN, "b": 'x "y", z', "d": true})
	table.save(path)
	var text := FileAccess.get_file_as_string(path)
	DirAccess.remove_absolute(ProjectSettings.globalize_path(path))
	_check(text == 'a,b,c,d\n,"x ""y"", z",,1\n', "CSV text is " + text)


## What is saved is read again; what makes no sense is not.
func _check_settings() -> void:
	var kept := FileAccess.get_file_as_string(DemoSettings.PATH)
	var settings := DemoSettings.new()
	settings.source = DemoSettings.MOUSE
	settings.workspace_scale = 2.0
	settings.clutch = DemoSettings.CLUTCHES[1]
	settings.picture = PictureQuality.PLAIN
	settings.save()
	var again := DemoSettings.load_or_default()
	_check(again.source == "mouse" and again.workspace_scale == 2.0, "settings read: %s" % again.source)
	_check(again.clutch == "switched" and again.picture == "plain", "clutch and picture: %s" % again.clutch)
	settings.source = "thin air"
	settings.workspace_scale = 7.0
	settings.rate_hz = -1
	settings.level = 9
	settings.save()
	again = DemoSettings.load_or_default()
	_check(again.source == "simulated", "a source that does not exist: %s" % again.source)
	_check(again.workspace_scale == 1.0 and again.rate_hz == 1000, "scale %f, rate %d" % [again.workspace_scale, again.rate_hz])
	_check(again.level == PlayArguments.LEVELS, "level %d" % again.level)
	var forces: Array[bool] = []
	for source in DemoSettings.SOURCES:
		again.source = source
		forces.append(again.may_have_forces())
	_check(forces == [true, true, true, false, false], "forces with %s: %s" % [DemoSettings.SOURCES, forces])
	DirAccess.remove_absolute(ProjectSettings.globalize_path(DemoSettings.PATH))
	if kept != "":
		var file := FileAccess.open(DemoSettings.PATH, FileAccess.WRITE)
		file.store_string(kept)


func _check_picture_quality() -> void:
	var software := "llvmpipe (LLVM 21.1.8, 256 bits)"
	_check(PictureQuality.is_plain(PictureQuality.AUTOMATIC, software), "full on a software renderer")
	_check(not PictureQuality.is_plain(PictureQuality.AUTOMATIC, "AMD Radeon RX 6600"), "plain on a GPU")
	_check(not PictureQuality.is_plain(PictureQuality.FULL, software), "full was asked for")
	_check(PictureQuality.is_plain(PictureQuality.PLAIN, "AMD Radeon RX 6600"), "plain was asked for")


func _object(label: String) -> TaskObject:
	return (load("res://tasks/pick_and_place/objects/%s.tscn" % label) as PackedScene).instantiate()


func _near(value: float, wanted: float, message: String) -> void:
	_check(absf(value - wanted) < 1e-3, "%s: %f, not %f" % [message, value, wanted])
