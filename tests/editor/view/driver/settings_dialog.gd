@tool
extends RefCounted
## Opens the dialog of Project > Tools > SPIDAR-G: Apply Physics Settings and saves a picture of the editor's middle:
## settings_dialog FILE. The first picture of docs/start/first_scene.md is made so. Needs a display.

const PLUGIN: String = "res://addons/spidar_g/editor/plugin.gd"
const PICTURE_PX := Vector2i(960, 540)
const DRAWN_FRAMES: int = 30


func run(plugin: EditorPlugin, arguments: PackedStringArray) -> int:
	OS.low_processor_usage_mode = false # an editor that nobody touches draws nothing
	var tree: SceneTree = plugin.get_tree()
	tree.root.gui_embed_subwindows = true # else the dialog is a window that the picture does not hold
	for node: Node in plugin.get_parent().get_children():
		var script: Script = node.get_script()
		if script != null and script.resource_path == PLUGIN:
			node.call(&"_ask")
	for _i: int in DRAWN_FRAMES:
		await tree.process_frame
	var window: Image = tree.root.get_texture().get_image()
	var corner: Vector2i = (window.get_size() - PICTURE_PX) / 2
	var error: Error = window.get_region(Rect2i(corner, PICTURE_PX)).save_png(arguments[0])
	print("PASS" if error == OK else "FAIL", " saves %s of %s" % [arguments[0], window.get_size()])
	return 0 if error == OK else 1
