## Collects what is pushed as errors and warnings. Of Godot 4.5 and newer: load it only where the class Logger exists.
extends Logger

var messages: PackedStringArray = []


func _log_error(
	_function: String, _file: String, _line: int, code: String, rationale: String, _editor_notify: bool,
	_error_type: int, _script_backtraces: Array[ScriptBacktrace]
) -> void:
	messages.append(rationale if rationale != "" else code)
