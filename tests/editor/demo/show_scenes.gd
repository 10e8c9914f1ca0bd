@tool
extends "editor_case.gd"
## Opens each scene of the demo in the editor's 3-D view and takes its picture: what a designer sees after a double click.
## Arguments: the folder for the pictures, then the scenes. Each is compared with the empty stage.

## Sky and lights alone: what every scene has before anything stands in it.
const EMPTY := "res://scene/stage.tscn"
const SETTLE_FRAMES := 12
## Wheel notches that bring the editor's first view, 4 m away, near enough to a device of half a metre.
const NOTCHES := 26
## A pixel counts as different when one of its channels is off by this: a ghost is faint.
const DIFFERENT := 0.012
## Of all pixels, against the empty stage: the table alone is more.
const MIN_CHANGED := 0.06
## Of the pixels near a thing's middle, against the scene without its things.
const MIN_CHANGED_NEAR := 0.2
const MIN_COLOURS := 60
## Around a thing's middle on the picture, so many pixels, something has to be drawn.
const NEAR_PX := 8

var _empty: Image
var _surface: Control


func run(owner: EditorPlugin, arguments: PackedStringArray) -> int:
	plugin = owner
	EditorInterface.set_main_screen_editor("3D")
	_surface = _find_surface()
	if not check(_surface != null, "the 3-D view has a surface for its input"):
		return failed
	await _wait_for_first_scene()
	await _open_near(EMPTY)
	_empty = _picture()
	_empty.save_png(arguments[0].path_join("empty.png"))
	for path: String in arguments.slice(1):
		await _show(path, arguments[0])
	print("%d passed, %d failed" % [passed, failed])
	return failed


## An editor without open scenes opens the main scene by itself, and not at once.
func _wait_for_first_scene() -> void:
	for _i: int in 300:
		await frames(1)
		if EditorInterface.get_edited_scene_root() != null:
			break
	await frames(SETTLE_FRAMES)


func _show(path: String, folder: String) -> void:
	var name: String = path.get_file().get_basename()
	var before: int = _nodes_in(path)
	await _open_near(path)
	var picture: Image = _picture()
	picture.save_png(folder.path_join(name + ".png"))
	_window().save_png(folder.path_join(name + "_editor.png"))
	var changed: float = _changed(picture, _empty)
	check(changed > MIN_CHANGED, "%s: %.1f %% of the picture is not the empty stage's" % [name, 100.0 * changed])
	var colours: int = _colours(picture)
	check(colours >= MIN_COLOURS, "%s: %d colours" % [name, colours])
	var things: Array[Node3D] = _things()
	check(things.size() >= 5, "%s: %d things" % [name, things.size()])
	var without: Image = await _picture_without_things()
	for thing: Node3D in things:
		_check_drawn(name, thing, picture, without)
	# What the editor alone shows is not saved with the scene.
	EditorInterface.mark_scene_as_unsaved()
	check(EditorInterface.save_scene() == OK, "%s can be saved" % name)
	check(_nodes_in(path) == before, "%s: %d nodes in its file, then %d" % [name, before, _nodes_in(path)])
	print("%s: %.1f %% drawn, %d colours, %d things" % [name, 100.0 * changed, colours, things.size()])


## The scene, seen from where the editor looks first, but nearer.
func _open_near(path: String) -> void:
	await open(path)
	for _i: int in NOTCHES:
		var wheel := InputEventMouseButton.new()
		wheel.button_index = MOUSE_BUTTON_WHEEL_UP
		wheel.pressed = true
		wheel.factor = 1.0
		wheel.position = _surface.size * 0.5
		_surface.gui_input.emit(wheel)
	await frames(SETTLE_FRAMES)
	await RenderingServer.frame_post_draw


## The control that takes the mouse over the first 3-D view.
func _find_surface() -> Control:
	var container: Node = EditorInterface.get_editor_viewport_3d(0).get_parent()
	for sibling: Node in container.get_parent().get_children():
		if sibling is Control and sibling != container and (sibling as Control).focus_mode == Control.FOCUS_ALL:
			return sibling as Control
	return null


func _holders() -> Array[Node3D]:
	var found: Array[Node3D] = []
	for holder: String in ["Items", "LayoutPreview"]:
		var node := EditorInterface.get_edited_scene_root().get_node_or_null(NodePath(holder)) as Node3D
		if node != null:
			found.append(node)
	return found


## Solid bodies, ghosts and blocks of air: all that has a mesh, but not the stage.
func _things() -> Array[Node3D]:
	var found: Array[Node3D] = []
	for holder: Node3D in _holders():
		for node: Node in holder.find_children("*", "MeshInstance3D", true, false):
			var thing := node as MeshInstance3D
			if thing.mesh != null and thing.is_visible_in_tree():
				found.append(thing)
	return found


func _picture_without_things() -> Image:
	for holder: Node3D in _holders():
		holder.hide()
	await frames(SETTLE_FRAMES)
	await RenderingServer.frame_post_draw
	var picture: Image = _picture()
	for holder: Node3D in _holders():
		holder.show()
	await frames()
	return picture


func _check_drawn(scene: String, thing: Node3D, picture: Image, without: Image) -> void:
	var camera: Camera3D = EditorInterface.get_editor_viewport_3d(0).get_camera_3d()
	var middle: Vector3 = thing.global_transform * (thing as MeshInstance3D).get_aabb().get_center()
	var scale: Vector2 = Vector2(picture.get_size()) / camera.get_viewport().get_visible_rect().size
	var at: Vector2 = camera.unproject_position(middle) * scale
	var frame := Rect2(Vector2.ZERO, picture.get_size()).grow(-NEAR_PX)
	if check(frame.has_point(at) and not camera.is_position_behind(middle), "%s: %s is outside the view" % [scene, thing.get_path()]):
		var near := Rect2i(Vector2i(at) - Vector2i.ONE * NEAR_PX, Vector2i.ONE * 2 * NEAR_PX)
		var changed: float = _changed(picture, without, near)
		check(changed > MIN_CHANGED_NEAR, "%s: %.2f is drawn at %s" % [scene, changed, thing.get_path()])


func _picture() -> Image:
	return EditorInterface.get_editor_viewport_3d(0).get_texture().get_image()


func _window() -> Image:
	return EditorInterface.get_base_control().get_viewport().get_texture().get_image()


## Share of the pixels, of all or of a part, that are not as in the other picture.
func _changed(picture: Image, other: Image, part: Rect2i = Rect2i()) -> float:
	var area: Rect2i = part if part.has_area() else Rect2i(Vector2i.ZERO, picture.get_size())
	var step: int = 1 if part.has_area() else 3
	var count: int = 0
	var different: int = 0
	for y: int in range(area.position.y, area.end.y, step):
		for x: int in range(area.position.x, area.end.x, step):
			var off: Color = picture.get_pixel(x, y) - other.get_pixel(x, y)
			count += 1
			different += int(maxf(maxf(absf(off.r), absf(off.g)), absf(off.b)) > DIFFERENT)
	return float(different) / count


func _colours(picture: Image) -> int:
	var seen: Dictionary[int, bool] = {}
	for y: int in range(0, picture.get_height(), 3):
		for x: int in range(0, picture.get_width(), 3):
			var colour: Color = picture.get_pixel(x, y)
			seen[(colour.r8 >> 4) << 8 | (colour.g8 >> 4) << 4 | (colour.b8 >> 4)] = true
	return seen.size()


func _nodes_in(path: String) -> int:
	return FileAccess.get_file_as_string(path).count("[node ")
