class_name TrialResults
extends RefCounted
## Turns a finished trial into summary.csv and objects.csv, and into the exit code of a scripted play.

const OBJECT_COLUMNS: PackedStringArray = [
	"name", "shape", "mass_kg", "width_m", "placed", "position_error_mm", "rotation_error_deg",
	"weight_felt_n", "weight_expected_n", "weight_ok", "width_felt_m", "width_felt_error_mm",
	"squeeze_torque_nm", "width_ok", "attempts",
]

var _task: PickAndPlace
var _player: PickAndPlacePlayer
var _spidar: SpidarG
var _objects_placed := 0
var _weights_ok := 0
var _widths_ok := 0


func _init(task: PickAndPlace, player: PickAndPlacePlayer, spidar: SpidarG) -> void:
	_task = task
	_player = player
	_spidar = spidar


## Writes the files and prints what came out. Returns the exit code.
func save_scripted(abort_reason: String) -> int:
	var arguments := _task.arguments
	var table := _object_table()
	var passed := (
		abort_reason == ""
		and _objects_placed == _task.objects.size()
		and _weights_ok == _task.objects.size()
		and _widths_ok == _task.objects.size()
	)
	var condition := "simulated_forces"
	if arguments.cut_output:
		condition = "simulated_output_cut"
	elif arguments.freeze_pose:
		condition = "simulated_pose_frozen"
	_fill_row("play-%d" % arguments.seed_number, condition, "scripted", abort_reason)
	_task.logger.row["weight_checks_ok"] = _weights_ok
	_task.logger.row["width_checks_ok"] = _widths_ok
	var code := PlayArguments.EXIT_DONE if passed else PlayArguments.EXIT_NOT_DONE
	if not _save(arguments.out_dir, table):
		code = PlayArguments.EXIT_NOT_DONE
	print(
		"pick_and_place seed %d: placed %d/%d, weight felt %d/%d, width felt %d/%d, %.1f s simulated%s"
		% [
			arguments.seed_number, _objects_placed, _task.objects.size(), _weights_ok,
			_task.objects.size(), _widths_ok, _task.objects.size(), _task.logger.task_time_s,
			"" if abort_reason == "" else "; stopped: " + abort_reason,
		]
	)
	print("results: %s" % arguments.out_dir.path_join("summary.csv"))
	return code


## Results of a person's trial; returns the line to show.
func save_interactive() -> String:
	var started := Time.get_datetime_string_from_system(true).replace(":", "-")
	var folder := "user://trials".path_join(started)
	var table := _object_table()
	var condition := "forces_on" if _spidar.forces_enabled else "forces_off"
	var source := "mouse" if _spidar.config == null or _spidar.config.device_name == "" else "device"
	_fill_row(started, condition, source, "")
	_task.logger.row["started_utc"] = started
	_save(folder, table)
	return "All placed in %.1f s. Results: %s" % [
		_task.logger.task_time_s, ProjectSettings.globalize_path(folder)
	]


func _object_table() -> CsvTable:
	var table := CsvTable.new(OBJECT_COLUMNS)
	for object in _task.objects:
		var record: FeltRecord = _player.records.get(object, FeltRecord.new())
		_objects_placed += int(object.placed)
		_weights_ok += int(record.weight_ok())
		_widths_ok += int(record.width_ok())
		table.add_row({
			"name": object.spec.label,
			"shape": (ObjectSpec.Shape.find_key(object.spec.shape) as String).to_lower(),
			"mass_kg": object.mass,
			"width_m": object.spec.size_m.x,
			"placed": object.placed,
			"position_error_mm": object.position_error_m() * 1000.0,
			"rotation_error_deg": rad_to_deg(object.rotation_error_rad()),
			"weight_felt_n": record.weight_felt_n,
			"weight_expected_n": object.mass * _gravity(),
			"weight_ok": record.weight_ok(),
			"width_felt_m": record.width_felt_m,
			"width_felt_error_mm": (record.width_felt_m - object.spec.size_m.x) * 1000.0,
			"squeeze_torque_nm": record.squeeze_torque_nm,
			"width_ok": record.width_ok(),
			"attempts": object.attempts,
		})
	return table


func _fill_row(session: String, condition: String, source: String, abort_reason: String) -> void:
	var position_sum_m := 0.0
	var rotation_sum_rad := 0.0
	var ideal_path_m := 0.0
	for object in _task.objects:
		if object.placed:
			position_sum_m += object.position_error_m()
			rotation_sum_rad += object.rotation_error_rad()
			ideal_path_m += object.start.origin.distance_to(object.target.position)
	var row := _task.logger.row
	row["session_id"] = session
	row["task"] = PickAndPlace.TASK_NAME
	row["condition"] = condition
	row["grip_source"] = source
	row["auto_animation"] = false
	row["trial"] = 1
	row["seed"] = _task.arguments.seed_number
	row["completed"] = _objects_placed == _task.objects.size() and abort_reason == ""
	row["abort_reason"] = abort_reason
	row["objects"] = _task.objects.size()
	row["objects_placed"] = _objects_placed
	if _objects_placed > 0:
		row["position_error_mm"] = 1000.0 * position_sum_m / _objects_placed
		row["rotation_error_deg"] = rad_to_deg(rotation_sum_rad / _objects_placed)
	_task.logger.finish(_spidar, ideal_path_m)


func _save(folder: String, table: CsvTable) -> bool:
	var error := DirAccess.make_dir_recursive_absolute(folder)
	if error != OK:
		push_error("%s cannot be made: %s" % [folder, error_string(error)])
		return false
	var saved := table.save(folder.path_join("objects.csv")) == OK
	saved = _task.logger.save(folder) == OK and saved
	# What differs from run to run is kept apart, so that equal seeds give equal tables.
	var session := FileAccess.open(folder.path_join("session.json"), FileAccess.WRITE)
	if session != null:
		session.store_string(JSON.stringify({
			"written_utc": Time.get_datetime_string_from_system(true),
			"operating_system": OS.get_name(),
			"statistics": _spidar.get_statistics(),
		}, "  ") + "\n")
	return saved


func _gravity() -> float:
	return float(ProjectSettings.get_setting("physics/3d/default_gravity"))
