extends RefCounted
## Turns a finished trial into summary.csv and objects.csv, and into the exit code of a scripted play.

const CsvTable := preload("res://study/csv_table.gd")
const PlayArguments := preload("res://play/play_arguments.gd")
const Trial := preload("res://study/trial.gd")

const OBJECT_COLUMNS: PackedStringArray = [
	"name", "kind", "mass_kg", "width_m", "placed", "position_error_mm", "rotation_error_deg",
	"weight_felt_n", "weight_expected_n", "weight_ok", "width_felt_m", "width_felt_error_mm",
	"squeeze_torque_nm", "width_ok", "detent_felt_n_m", "detent_expected_n_m", "release_felt_n",
	"release_expected_n", "detent_ok", "grasp_angle_deg", "jitter_mm", "attempts",
]

var _task: Trial
var _placed := 0
var _weights_ok := 0
var _widths_ok := 0
var _detents_ok := 0
var _all_felt := true


func _init(task: Trial) -> void:
	_task = task


## Writes the files and prints what came out. Returns the exit code.
func save_scripted(abort_reason: String) -> int:
	var arguments := _task.arguments
	var table := _object_table()
	var total := _task.bodies.size()
	var in_place := _placed == total or arguments.carries > 0 # What is carried about goes back to its start.
	var passed := abort_reason == "" and total > 0 and in_place and _all_felt
	var condition := "simulated_forces"
	if arguments.cut_output:
		condition = "simulated_output_cut"
	elif arguments.freeze_pose:
		condition = "simulated_pose_frozen"
	_fill_row("play-%d" % arguments.seed_number, condition, "scripted", abort_reason)
	_task.logger.row["weight_checks_ok"] = _weights_ok
	_task.logger.row["width_checks_ok"] = _widths_ok
	_task.logger.row["detent_checks_ok"] = _detents_ok
	_task.logger.row["max_penetration_mm"] = 1000.0 * _task.max_penetration_m()
	var code := PlayArguments.EXIT_DONE if passed else PlayArguments.EXIT_NOT_DONE
	if not _save(arguments.out_dir, table):
		code = PlayArguments.EXIT_NOT_DONE
	print(
		"%s level %d seed %d: placed %d/%d, felt: weight %d, width %d, detent %d of %d, %.1f s simulated%s"
		% [
			_task.task_name, arguments.level, arguments.seed_number, _placed, total, _weights_ok,
			_widths_ok, _detents_ok, total, _task.logger.task_time_s,
			"" if abort_reason == "" else "; stopped: " + abort_reason,
		]
	)
	print("results: %s" % arguments.out_dir.path_join("summary.csv"))
	return code


## One row of summary.csv, for an experiment that keeps its own files.
func row_of(abort_reason: String) -> Dictionary:
	_object_table()
	_fill_row("", "", "", abort_reason)
	_task.logger.row["auto_animation"] = _task.settings.auto_animation
	return _task.logger.row


## Results of a person's trial; returns the line to show.
func save_interactive() -> String:
	var started := Time.get_datetime_string_from_system(true).replace(":", "-")
	var folder := "user://trials".path_join(started)
	var table := _object_table()
	var condition := "forces_on" if _task.spidar.forces_enabled else "forces_off"
	_fill_row(started, condition, _task.settings.source, "")
	_task.logger.row["participant_id"] = _task.settings.participant
	_task.logger.row["auto_animation"] = _task.settings.auto_animation
	_task.logger.row["started_utc"] = started
	_save(folder, table)
	return _task.tr("RESULT_ALL_PLACED") % [
		_task.logger.task_time_s, ProjectSettings.globalize_path(folder)
	]


func _object_table() -> CsvTable:
	var table := CsvTable.new(OBJECT_COLUMNS)
	for body in _task.bodies:
		var felt := body.felt
		_placed += int(body.placed)
		_weights_ok += int(felt.weight_ok())
		_widths_ok += int(felt.width_ok())
		_detents_ok += int(felt.detent_ok())
		_all_felt = _all_felt and felt.all_ok()
		table.add_row({
			"name": body.label,
			"kind": body.kind,
			"mass_kg": body.mass,
			"width_m": body.width_m,
			"placed": body.placed,
			"position_error_mm": body.position_error_m() * 1000.0,
			"rotation_error_deg": rad_to_deg(body.rotation_error_rad()),
			"weight_felt_n": felt.weight_felt_n,
			"weight_expected_n": body.mass * _gravity() if felt.checks_weight else NAN,
			"weight_ok": felt.weight_ok(),
			"width_felt_m": felt.width_felt_m,
			"width_felt_error_mm": (felt.width_felt_m - body.width_m) * 1000.0,
			"squeeze_torque_nm": felt.squeeze_torque_nm,
			"width_ok": felt.width_ok(),
			"detent_felt_n_m": felt.detent_felt_n_m,
			"detent_expected_n_m": felt.detent_expected_n_m,
			"release_felt_n": felt.release_felt_n,
			"release_expected_n": felt.release_expected_n,
			"detent_ok": felt.detent_ok(),
			"grasp_angle_deg": rad_to_deg(felt.grasp_angle_rad),
			"jitter_mm": felt.jitter_m * 1000.0,
			"attempts": body.attempts,
		})
	return table


func _fill_row(session: String, condition: String, source: String, abort_reason: String) -> void:
	var position_sum_m := 0.0
	var rotation_sum_rad := 0.0
	var ideal_path_m := 0.0
	for body in _task.bodies:
		if body.placed:
			position_sum_m += body.position_error_m()
			rotation_sum_rad += body.rotation_error_rad()
			var began := (body.get_parent() as Node3D).to_global(body.start.origin)
			ideal_path_m += began.distance_to(body.goal().origin)
	var row := _task.logger.row
	row["session_id"] = session
	row["task"] = _task.task_name
	row["level"] = _task.arguments.level
	row["condition"] = condition
	row["grip_source"] = source
	row["auto_animation"] = false
	row["trial"] = 1
	row["seed"] = _task.arguments.seed_number
	row["completed"] = _placed == _task.bodies.size() and abort_reason == ""
	row["abort_reason"] = abort_reason
	row["objects"] = _task.bodies.size()
	row["objects_placed"] = _placed
	if _placed > 0:
		row["position_error_mm"] = 1000.0 * position_sum_m / _placed
		row["rotation_error_deg"] = rad_to_deg(rotation_sum_rad / _placed)
	_task.logger.finish(_task.spidar, ideal_path_m)


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
			"statistics": _task.spidar.get_statistics(),
			"frame_ms": _task.frame_cost.report(),
		}, "  ") + "\n")
	return saved


func _gravity() -> float:
	return float(ProjectSettings.get_setting("physics/3d/default_gravity"))
