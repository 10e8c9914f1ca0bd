## Parses scripts: -- SCRIPTS.json PARSED.json. The first holds a list of sources, the second becomes a list of booleans.
extends SceneTree


func _initialize() -> void:
	var paths: PackedStringArray = OS.get_cmdline_user_args()
	var sources: Array = JSON.parse_string(FileAccess.get_file_as_string(paths[0]))
	var parsed: Array[bool] = []
	for source: String in sources:
		var script := GDScript.new()
		script.source_code = source
		parsed.append(script.reload() == OK)
	FileAccess.open(paths[1], FileAccess.WRITE).store_string(JSON.stringify(parsed))
	quit()
