@tool
extends RefCounted
## Waits until the editor has read the project and drawn for a while, and says that it did. Names nothing of the add-on.

## Without a scan of the project: Godot can crash when it is closed in the middle of one.
const QUIET_FRAMES := 40


func run(plugin: EditorPlugin, _arguments: PackedStringArray) -> int:
	var quiet: int = 0
	while quiet < QUIET_FRAMES:
		await plugin.get_tree().process_frame
		quiet = 0 if EditorInterface.get_resource_filesystem().is_scanning() else quiet + 1
	print("1 passed, 0 failed")
	return 0
