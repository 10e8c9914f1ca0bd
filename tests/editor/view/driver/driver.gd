@tool
extends EditorPlugin
## Runs a script of res://driver/ in the editor and quits: --editor --path ... -- NAME [arguments]. The script's run(plugin,
## arguments) says how many checks failed.


func _enter_tree() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() > 0:
		_run.call_deferred(arguments)


func _run(arguments: PackedStringArray) -> void:
	# An editor that is not looked at draws ten frames a second.
	OS.low_processor_usage_mode_sleep_usec = 1000
	# The editor is ready when its first scan of the project is over.
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	while files.is_scanning():
		await get_tree().process_frame
	for _i: int in 3:
		await get_tree().process_frame
	var script: GDScript = load("res://driver/%s.gd" % arguments[0])
	if script == null or not script.can_instantiate():
		print("FAIL no script %s" % arguments[0])
		get_tree().quit(1)
		return
	var task: RefCounted = script.new()
	var failed: int = await task.call("run", self, arguments.slice(1))
	task = null
	get_tree().quit(1 if failed > 0 else 0)
