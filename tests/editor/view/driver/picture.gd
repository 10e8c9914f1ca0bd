@tool
extends "editor_case.gd"
## Pictures of the 3-D view for docs/editor.md: run(plugin, [FILE of the whole editor, FILE of the view]). Needs a display.

const PROBE_M := Vector3(0.05, 0.03, 0.0)


func run(owner: EditorPlugin, arguments: PackedStringArray) -> int:
	plugin = owner
	OS.low_processor_usage_mode = false
	EditorInterface.set_main_screen_editor("3D")
	var root: Node = await open("res://stage.tscn")
	var device := SpidarG.new()
	device.name = "SpidarG"
	device.config = SpidarGConfig.new()
	device.workspace_scale = 4.0
	root.add_child(device)
	device.owner = root
	await frames()
	select([device])
	EditorInterface.edit_node(device)
	# Below the tool that selects there is no transform gizmo in the way.
	_view_key(KEY_V)
	await frames(20)
	gizmo_of(device).probe_m = PROBE_M
	device.update_gizmos()
	await frames(20)
	var window: Viewport = EditorInterface.get_base_control().get_viewport()
	check(window.get_texture().get_image().save_png(arguments[0]) == OK, "saves %s" % arguments[0])
	var view: Image = EditorInterface.get_editor_viewport_3d(0).get_texture().get_image()
	check(view.save_png(arguments[1]) == OK, "saves %s" % arguments[1])
	device.free()
	print("%d passed, %d failed" % [passed, failed])
	return failed


func _view_key(key: Key) -> void:
	press(key, false)
