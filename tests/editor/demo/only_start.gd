@tool
extends RefCounted
## Waits until the editor has read the project and drawn for a while, and says that it did. Names nothing of the add-on.

## Without a scan of the project: Godot can crash when it is closed in the middle of one.
const QUIET_FRAMES := 40
## After an import without a display, the editor reads the documentation of all scripts in a thread of its own, and crashes when
## it is closed meanwhile. With the scripts loaded the thread has little left to do.
const DOCUMENTED_AFTER_S := 5.0


func run(plugin: EditorPlugin, _arguments: PackedStringArray) -> int:
	var quiet: int = 0
	while quiet < QUIET_FRAMES:
		await plugin.get_tree().process_frame
		quiet = 0 if EditorInterface.get_resource_filesystem().is_scanning() else quiet + 1
	_load_scripts(EditorInterface.get_resource_filesystem().get_filesystem())
	await plugin.get_tree().create_timer(DOCUMENTED_AFTER_S).timeout
	print("1 passed, 0 failed")
	return 0


func _load_scripts(folder: EditorFileSystemDirectory) -> void:
	for index: int in folder.get_file_count():
		if folder.get_file_type(index) == &"GDScript":
			load(folder.get_file_path(index))
	for index: int in folder.get_subdir_count():
		_load_scripts(folder.get_subdir(index))
