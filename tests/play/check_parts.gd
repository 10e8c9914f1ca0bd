extends SceneTree
## Known answers for the demo's own mathematics. Prints FAIL lines and "N passed, N failed".

var _passed := 0
var _failed := 0


func _initialize() -> void:
	_check_width_sense()
	_check_rotation_error()
	_check_layout()
	_check_minimum_jerk()
	_check_csv()
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
		var push := 0.25 * deg_to_rad(4.0)
		_check(absf(sense.push_nm() - push) < 1e-4, "push %.5f, not %.5f" % [sense.push_nm(), push])
	var nothing := _closing(deg_to_rad(30.0), deg_to_rad(38.0), 0.04, 0.0)
	_check(is_nan(nothing.touch_angle_rad()), "touch felt where nothing pushes")
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
	var square := _spec(ObjectSpec.Shape.BOX, Vector3(0.03, 0.06, 0.03))
	var slab := _spec(ObjectSpec.Shape.BOX, Vector3(0.02, 0.06, 0.04))
	var cylinder := _spec(ObjectSpec.Shape.CYLINDER, Vector3(0.03, 0.06, 0.03))
	var quarter := Basis(Vector3.UP, PI * 0.5)
	var tilt := Basis(Vector3.RIGHT, 0.3)
	_near(PlacementJudge.rotation_error_rad(square, quarter, Basis()), 0.0, "square, quarter turn")
	_near(PlacementJudge.rotation_error_rad(slab, quarter, Basis()), PI * 0.5, "slab, quarter turn")
	_near(PlacementJudge.rotation_error_rad(slab, quarter * quarter, Basis()), 0.0, "slab, half turn")
	_near(PlacementJudge.rotation_error_rad(slab, tilt, Basis()), 0.3, "slab, tilt")
	_near(PlacementJudge.rotation_error_rad(cylinder, quarter, Basis()), 0.0, "cylinder, turn")
	_near(PlacementJudge.rotation_error_rad(cylinder, tilt, Basis()), 0.3, "cylinder, tilt")


func _check_layout() -> void:
	var specs := ObjectCatalogue.all()
	for seed_number in range(0, 50):
		var one := TaskLayout.make(seed_number, specs)
		var two := TaskLayout.make(seed_number, specs)
		_check(one.starts == two.starts and one.targets == two.targets, "seed %d twice" % seed_number)
		var places := one.starts + one.targets
		var nearest := INF
		for a in places.size():
			for b in a:
				var way := places[a].origin - places[b].origin
				nearest = minf(nearest, Vector2(way.x, way.z).length())
		var least := TaskLayout.PITCH_M.y - 2.0 * TaskLayout.JITTER_M
		_check(nearest >= least - 1e-6, "seed %d: two things %.4f m apart" % [seed_number, nearest])
	var other := TaskLayout.make(1, specs)
	_check(TaskLayout.make(2, specs).starts != other.starts, "seeds 1 and 2 are alike")


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


func _spec(shape: ObjectSpec.Shape, size: Vector3) -> ObjectSpec:
	return ObjectSpec.make("thing", shape, size, 0.1, Color.WHITE, ObjectSpec.Stand.TABLE)


func _near(value: float, wanted: float, message: String) -> void:
	_check(absf(value - wanted) < 1e-3, "%s: %f, not %f" % [message, value, wanted])
