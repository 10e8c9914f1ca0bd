extends Node3D
## A game that draws some frames, says in a file what it is, and ends.

const FRAMES: int = 10


func _ready() -> void:
	for frame: int in FRAMES:
		await get_tree().process_frame
	var played: Dictionary = {
		"scene": String(name),
		"executable": OS.get_executable_path(),
		"display": DisplayServer.get_name(),
		"add_on": ClassDB.class_exists(&"SpidarG"),
		"frames": Engine.get_frames_drawn(),
	}
	var path: String = OS.get_environment("SPIDAR_G_PLAYED")
	var file: FileAccess = FileAccess.open(path + ".part", FileAccess.WRITE)
	file.store_string(JSON.stringify(played))
	file.close()
	DirAccess.rename_absolute(path + ".part", path)
	get_tree().quit()
