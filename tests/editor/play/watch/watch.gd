@tool
extends EditorPlugin
## Prints "EDITOR ready PROGRAM" once the scene is open and files are scanned, "EDITOR playing" and "EDITOR stopped".

const QUIET_FRAMES: int = 20

var _quiet: int = 0
var _playing: bool = false


func _process(_delta: float) -> void:
	var open: bool = EditorInterface.get_edited_scene_root() != null
	if _quiet < QUIET_FRAMES and open and not EditorInterface.get_resource_filesystem().is_scanning():
		_quiet += 1
		if _quiet == QUIET_FRAMES:
			print("EDITOR ready %s" % OS.get_executable_path())
	if EditorInterface.is_playing_scene() != _playing:
		_playing = not _playing
		print("EDITOR playing" if _playing else "EDITOR stopped")
