@tool
extends RefCounted
## What the scripts of this folder share: checks that count, and waiting for the editor.

var plugin: EditorPlugin
var failed: int = 0
var passed: int = 0


func check(condition: bool, message: String) -> bool:
	if condition:
		passed += 1
	else:
		failed += 1
		print("FAIL ", message)
	return condition


func near(actual: float, expected: float, tolerance: float, message: String) -> bool:
	return check(absf(actual - expected) <= tolerance, "%s: got %.9f, expected %.9f" % [message, actual, expected])


func frames(count: int = 3) -> void:
	for _i: int in count:
		await plugin.get_tree().process_frame


## Opens a scene and waits until it is the edited one.
func open(path: String) -> Node:
	EditorInterface.open_scene_from_path(path)
	for _i: int in 600:
		await frames(1)
		var root: Node = EditorInterface.get_edited_scene_root()
		if root != null and root.scene_file_path == path:
			await frames()
			return root
	check(false, "%s did not open" % path)
	return null


## A key with Ctrl or Shift, as from the keyboard: the editor's own shortcuts answer.
func press(key: Key, control: bool, shift: bool = false) -> void:
	for pressed: bool in [true, false]:
		var event := InputEventKey.new()
		event.keycode = key
		event.physical_keycode = key
		event.ctrl_pressed = control
		event.shift_pressed = shift
		event.pressed = pressed
		EditorInterface.get_base_control().get_viewport().push_input(event)


func select(nodes: Array[Node]) -> void:
	EditorInterface.get_selection().clear()
	for node: Node in nodes:
		EditorInterface.get_selection().add_node(node)


func gizmo_of(device: SpidarG) -> EditorNode3DGizmo:
	for gizmo: EditorNode3DGizmo in device.get_gizmos():
		if gizmo.get_script() != null:
			return gizmo
	return null
