extends RefCounted
## The files of one session. Rows are appended when they are known and handed to the system at once, so that a killed
## program loses the trial in progress and nothing else; a torn last line is left out when the session goes on.

const CsvTable := preload("res://study/csv_table.gd")
const TrialLogger := preload("res://study/trial_logger.gd")

const RATING_COLUMNS: PackedStringArray = [
	"schema_version", "session_id", "participant_id", "task", "condition", "grasp", "translation",
	"rotation", "overall", "against_mouse", "computer_experience", "haptic_experience", "rated_utc",
]
const TRACE_COLUMNS: PackedStringArray = [
	"session_id", "task", "condition", "trial", "time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw",
	"grasp_angle_rad", "fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm", "grasp_torque_nm", "held",
]

var folder := ""
var session_id := ""


## folder: made when it is not there. Empty problem text: all is well.
func open(folder_: String, session: String) -> String:
	folder = folder_
	session_id = session
	var error := DirAccess.make_dir_recursive_absolute(folder)
	if error != OK:
		return "%s: cannot be made: %s" % [folder, error_string(error)]
	for name: String in ["summary.csv", "ratings.csv", "trace.csv"]:
		var problem := _mend(folder.path_join(name), _columns_of(name))
		if problem != "":
			return problem
	_drop_unfinished_traces()
	return ""


func append(name: String, rows: Array[Dictionary]) -> Error:
	var table := CsvTable.new(_columns_of(name))
	for row in rows:
		table.add_row(row)
	var file := FileAccess.open(folder.path_join(name), FileAccess.READ_WRITE)
	if file == null:
		return FileAccess.get_open_error()
	file.seek_end()
	file.store_string(table.rows_text())
	file.flush()
	return file.get_error()


## Keys task/condition/trial of the counted trials, or task/condition of the ratings, that are on file.
func done(name: String) -> Dictionary[String, bool]:
	var keys: Dictionary[String, bool] = {}
	for row in rows_of(name):
		var key := "%s/%s" % [row.get("task", ""), row.get("condition", "")]
		if name == "summary.csv":
			if row.get("abort_reason", "") != "":
				continue # An aborted trial is done again.
			key += "/%s" % row.get("trial", "")
		keys[key] = true
	return keys


func rows_of(name: String) -> Array[Dictionary]:
	var rows: Array[Dictionary] = []
	var file := FileAccess.open(folder.path_join(name), FileAccess.READ)
	if file == null:
		return rows
	var header := file.get_csv_line()
	while not file.eof_reached():
		var cells := file.get_csv_line()
		if cells.size() == header.size():
			var row := {}
			for index in header.size():
				row[header[index]] = cells[index]
			rows.append(row)
	return rows


## A trial killed between its trace and its row in summary.csv is done again: its trace goes.
func _drop_unfinished_traces() -> void:
	var finished := {}
	for row in rows_of("summary.csv"):
		finished["%s,%s,%s,%s," % [row["session_id"], row["task"], row["condition"], row["trial"]]] = true
	var path := folder.path_join("trace.csv")
	var lines := FileAccess.get_file_as_string(path).split("\n", false)
	var kept := PackedStringArray()
	for index in lines.size():
		var head := ",".join(lines[index].split(",", true, 4).slice(0, 4)) + ","
		if index == 0 or finished.has(head):
			kept.append(lines[index])
	if kept.size() < lines.size():
		var file := FileAccess.open(path, FileAccess.WRITE)
		if file != null:
			file.store_string("\n".join(kept) + "\n")


func _columns_of(name: String) -> PackedStringArray:
	match name:
		"summary.csv":
			return TrialLogger.COLUMNS
		"ratings.csv":
			return RATING_COLUMNS
	return TRACE_COLUMNS


## A new file gets its header; an old one loses a last line that was not finished.
func _mend(path: String, columns: PackedStringArray) -> String:
	var text := FileAccess.get_file_as_string(path)
	if text == "":
		text = ",".join(columns) + "\n"
	elif not text.begins_with(",".join(columns) + "\n"):
		return "%s: has other columns; give another folder" % path
	elif not text.ends_with("\n"):
		text = text.substr(0, text.rfind("\n") + 1)
	else:
		return ""
	var file := FileAccess.open(path, FileAccess.WRITE)
	if file == null:
		return "%s: cannot be written: %s" % [path, error_string(FileAccess.get_open_error())]
	file.store_string(text)
	return ""
