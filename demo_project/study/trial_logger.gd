extends RefCounted
## Measures of one trial, the same for every task; one row of summary.csv. README.md of the task says
## what each column means.

const CsvTable := preload("res://study/csv_table.gd")

const SCHEMA_VERSION := 1
const COLUMNS: PackedStringArray = [
	"schema_version", "session_id", "participant_id", "task", "condition", "grip_source",
	"auto_animation", "trial", "seed", "started_utc", "completed", "abort_reason", "task_time_s",
	"time_to_first_grasp_s", "grasp_attempts", "grasp_successes", "drops", "wrong_placements",
	"collisions", "position_error_mm", "rotation_error_deg", "path_length_m", "path_ratio",
	"peak_force_n", "mean_force_n", "peak_torque_nm", "peak_grasp_moment_nm",
	"wrench_residual_rms", "tension_saturated_pct", "servo_hz_mean", "servo_period_p99_us",
	"missed_deadlines", "addon_version", "godot_version", "objects", "objects_placed",
	"weight_checks_ok", "width_checks_ok", "level", "detent_checks_ok", "max_penetration_mm",
]
## Moments count in the residual as forces at the end of a pole.
const RESIDUAL_LEVER_M := 0.04
const ADDON_CONFIG := "res://addons/spidar_g/plugin.cfg"

var row: Dictionary[String, Variant] = {}
var task_time_s := 0.0
var grasp_attempts := 0
var grasp_successes := 0
var drops := 0
var wrong_placements := 0
var collisions := 0

var _path_length_m := 0.0
var _last_position := Vector3.INF
var _samples := 0
var _force_sum_n := 0.0
var _peak_force_n := 0.0
var _peak_torque_nm := 0.0
var _peak_grasp_nm := 0.0
var _residual_square_sum := 0.0
var _ticks_at_start := 0
var _ticks := 0
var _samples_at_limit := 0


func start(spidar: SpidarG) -> void:
	var statistics := spidar.get_statistics()
	_ticks_at_start = statistics.get("ticks", 0)
	row["schema_version"] = SCHEMA_VERSION
	row["godot_version"] = Engine.get_version_info()["string"]
	var config := ConfigFile.new()
	if config.load(ADDON_CONFIG) == OK:
		row["addon_version"] = config.get_value("plugin", "version", "")


## Once a physics tick while the trial runs.
func sample(spidar: SpidarG, delta: float) -> void:
	task_time_s += delta
	var position := spidar.get_grip_transform().origin
	if _last_position.is_finite():
		_path_length_m += position.distance_to(_last_position)
	_last_position = position
	var asked := spidar.get_requested_wrench()
	var given := spidar.get_achieved_wrench()
	var force := Vector3(given[0], given[1], given[2]).length()
	_samples += 1
	var statistics := spidar.get_statistics()
	_samples_at_limit += int(int(statistics.get("at_max_mask", 0)) != 0)
	_ticks = int(statistics.get("ticks", 0)) - _ticks_at_start
	_force_sum_n += force
	_peak_force_n = maxf(_peak_force_n, force)
	_peak_torque_nm = maxf(_peak_torque_nm, Vector3(given[3], given[4], given[5]).length())
	_peak_grasp_nm = maxf(_peak_grasp_nm, absf(given[6]))
	for axis in 7:
		var error := given[axis] - asked[axis]
		if axis >= 3:
			error /= RESIDUAL_LEVER_M
		_residual_square_sum += error * error


func note_grasp() -> void:
	grasp_successes += 1
	if not row.has("time_to_first_grasp_s"):
		row["time_to_first_grasp_s"] = task_time_s


## ideal_path_m: sum of the straight ways of what was carried; 0 when nothing was.
func finish(spidar: SpidarG, ideal_path_m: float) -> void:
	var statistics := spidar.get_statistics()
	row["task_time_s"] = task_time_s
	row["grasp_attempts"] = grasp_attempts
	row["grasp_successes"] = grasp_successes
	row["drops"] = drops
	row["wrong_placements"] = wrong_placements
	row["collisions"] = collisions
	row["path_length_m"] = _path_length_m
	if ideal_path_m > 0.0:
		row["path_ratio"] = _path_length_m / ideal_path_m
	if _samples > 0:
		row["peak_force_n"] = _peak_force_n
		row["mean_force_n"] = _force_sum_n / _samples
		row["tension_saturated_pct"] = 100.0 * _samples_at_limit / _samples
		row["peak_torque_nm"] = _peak_torque_nm
		row["peak_grasp_moment_nm"] = _peak_grasp_nm
		row["wrench_residual_rms"] = sqrt(_residual_square_sum / _samples)
	if spidar.drive_mode == SpidarG.DRIVE_STEPPED:
		# Simulated time: the rate is cycles per simulated second, and there is no clock to be late by.
		if task_time_s > 0.0:
			row["servo_hz_mean"] = _ticks / task_time_s
	else:
		row["servo_hz_mean"] = statistics.get("servo_rate_hz")
		row["servo_period_p99_us"] = _period_p99_us(spidar, statistics)
		row["missed_deadlines"] = statistics.get("missed_deadlines")


func save(folder: String) -> Error:
	var table := CsvTable.new(COLUMNS)
	table.add_row(row)
	return table.save(folder.path_join("summary.csv"))


## The nominal period and how late 99 of 100 cycles at most begin.
func _period_p99_us(spidar: SpidarG, statistics: Dictionary) -> Variant:
	if spidar.config == null:
		return null
	return 1e6 / spidar.config.rate_hz + float(statistics.get("lateness_p99_us", 0.0))
