## Saves a picture of each step of docs/start/first_scene.md from the second on: -s first_scene_pictures.gd -- FOLDER. The
## scene is built from the page's own tables. At the left is its tree, with what the step adds in color. Needs a display and
## --fixed-fps 60. The window has the size of the pictures: --resolution 960x540.
extends SceneTree

const Page := preload("res://first_scene_page.gd")
const TREE_WIDTH_PX: int = 300
const FIRST_PICTURE: int = 2
const NEW_COLOR := Color(1.0, 0.8, 0.3)
const TYPE_COLOR := Color(0.55, 0.6, 0.68)
const ARMING_FRAMES: int = 90
const MOVE_FRAMES: int = 60
const CLOSING_FRAMES: int = 120
const DRAWN_FRAMES: int = 3

var _page := Page.new()
var _view := SubViewport.new()
var _tree := Tree.new()


func _initialize() -> void:
	_run()


func _run() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() != 1 or not _page.read():
		push_error("first_scene_pictures.gd: give one folder, in the project of the repository.")
		quit(2)
		return
	_lay_out()
	for step: int in _page.titles:
		if step < FIRST_PICTURE:
			continue
		var error: Error = await _save(step, arguments[0].path_join("step_%02d.png" % step))
		if error != OK:
			quit(1)
			return
	quit(0)


func _lay_out() -> void:
	var shown := SubViewportContainer.new()
	shown.stretch = true
	shown.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_view.msaa_3d = Viewport.MSAA_4X
	shown.add_child(_view)
	_tree.custom_minimum_size.x = TREE_WIDTH_PX
	var both := HBoxContainer.new()
	both.add_theme_constant_override(&"separation", 0)
	both.set_anchors_preset(Control.PRESET_FULL_RECT)
	both.add_child(_tree)
	both.add_child(shown)
	root.add_child(both)


func _save(step: int, file: String) -> Error:
	var scene := Node3D.new()
	scene.name = "FirstScene"
	for done: int in range(1, step + 1):
		for problem: String in _page.build(scene, done):
			push_error(problem)
			return FAILED
	_list(scene, step)
	var device: SpidarG = scene.get_node_or_null(^"SpidarG")
	if device != null:
		device.drive_mode = SpidarG.DRIVE_STEPPED # simulated time: the same at every run
	RenderingServer.render_loop_enabled = false # only the last frame is looked at
	_view.add_child(scene)
	await _frames(ARMING_FRAMES)
	if step == 8:
		await _point_at(scene, Vector3(-0.06, -0.095, 0.0))
	elif step > 8:
		await _lift(scene, 0.05 if step == 9 else 0.07)
	RenderingServer.render_loop_enabled = true
	for _i: int in DRAWN_FRAMES:
		await process_frame
	await RenderingServer.frame_post_draw
	var error: Error = root.get_texture().get_image().save_png(file)
	scene.free()
	await process_frame
	return error


func _lift(scene: Node3D, height: float) -> void:
	var ball: Node3D = scene.get_node(^"Ball")
	await _point_at(scene, Vector3(ball.position.x, 0.02, 0.0))
	await _point_at(scene, ball.position)
	var button := InputEventMouseButton.new()
	button.button_index = MOUSE_BUTTON_LEFT
	button.pressed = true
	_view.push_input(button)
	await _frames(CLOSING_FRAMES)
	await _point_at(scene, ball.position + Vector3(0.0, height, 0.0))


## The cursor goes to where a point of the scene is seen, and the hand follows.
func _point_at(scene: Node3D, point: Vector3) -> void:
	var motion := InputEventMouseMotion.new()
	motion.position = (scene.get_node(^"Camera") as Camera3D).unproject_position(point)
	_view.push_input(motion)
	await _frames(2 * MOVE_FRAMES)


## The nodes of the scene; those of the step are marked.
func _list(scene: Node3D, step: int) -> void:
	_tree.clear()
	var items: Dictionary[Node, TreeItem] = {scene: _item(null, "FirstScene", "Node3D", false)}
	for node: Node in scene.find_children("*", "", true, true):
		var type: String = node.get_class()
		var script: Script = node.get_script()
		if script != null and script.get_global_name() != &"":
			type = script.get_global_name()
		var is_new: bool = _page.nodes_of(step).has(str(scene.get_path_to(node)))
		items[node] = _item(items[node.get_parent()], node.name, type, is_new)


func _item(parent: TreeItem, name: String, type: String, is_new: bool) -> TreeItem:
	var item: TreeItem = _tree.create_item(parent)
	item.set_text(0, name if name == type else "%s  (%s)" % [name, type])
	item.set_custom_color(0, NEW_COLOR if is_new else TYPE_COLOR)
	return item


func _frames(count: int) -> void:
	for _i: int in count:
		await physics_frame
