## The gallery lists every example that there is, with a picture, and opens it and comes back, by mouse and by keyboard:
## -s check_gallery.gd -- SCENE [SIZE PICTURE]. With a display it saves what it looks like to the file PICTURE.
extends SceneTree

const Play := preload("res://plays/play.gd")
const EXAMPLES: String = "res://addons/spidar_g/examples/"
const SIZE_PX: Vector2i = Vector2i(1280, 720)
const PICTURE_PX: Vector2i = Vector2i(320, 180)
const MOST_PICTURE_BYTES: int = 20000

var _play: Play = Play.new()
var _gallery: Control


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	root.size = SIZE_PX
	if arguments.size() > 1:
		root.size = Vector2i(arguments[1].get_slice("x", 0).to_int(), arguments[1].get_slice("x", 1).to_int())
	_play.tree = self
	_gallery = (load(arguments[0]) as PackedScene).instantiate()
	root.add_child(_gallery)
	await process_frame
	await process_frame
	_check_lists_all()
	_check_fits()
	if arguments.size() > 2:
		await RenderingServer.frame_post_draw
		_play.check_equal(root.get_texture().get_image().save_png(arguments[2]), OK, "the picture is saved")
		RenderingServer.render_loop_enabled = false
	await _check_opens_by_mouse()
	await _check_opens_by_keyboard()
	_gallery.free()
	await process_frame
	for failure: String in _play.failures:
		print("FAIL gallery: %s" % failure)
	print("%d passed, %d failed" % [_play.check_count - _play.failures.size(), _play.failures.size()])
	quit(0 if _play.failures.is_empty() else 1)


func _check_lists_all() -> void:
	var listed: PackedStringArray = []
	for button: Button in _buttons():
		listed.append(button.name)
		var file: String = EXAMPLES + "gallery/pictures/%s.webp" % button.name
		var picture := Image.new()
		_play.check_equal(picture.load_webp_from_buffer(FileAccess.get_file_as_bytes(file)), OK, "%s is a picture" % file)
		_play.check_equal(picture.get_size(), PICTURE_PX, "size of %s" % file)
		var bytes: int = FileAccess.get_file_as_bytes(file).size()
		_play.check(bytes < MOST_PICTURE_BYTES, "%s is small: %d bytes" % [file, bytes])
		_play.check_equal(button.text.count("\n"), 1, "%s has a title and one line" % button.name)
	for name: String in DirAccess.get_directories_at(EXAMPLES):
		_play.check(name == "gallery" or listed.has(name), "%s is in EXAMPLES of gallery/gallery.gd" % name)


func _check_fits() -> void:
	var window := Rect2(Vector2.ZERO, root.size)
	for button: Button in _buttons():
		_play.check(window.encloses(button.get_global_rect()), "%s is in the window: %s" % [button.name, button.get_global_rect()])


func _check_opens_by_mouse() -> void:
	for button: Button in _buttons():
		var click := InputEventMouseButton.new()
		click.button_index = MOUSE_BUTTON_LEFT
		click.position = button.get_global_rect().get_center()
		click.global_position = click.position
		await _send(click)
		await _check_shown(button.name)


func _check_opens_by_keyboard() -> void:
	_buttons()[0].grab_focus()
	for key: Key in [KEY_RIGHT, KEY_DOWN, KEY_ENTER] as Array[Key]:
		await _press_key(key)
	await _check_shown(_buttons()[1 + (_buttons()[0].get_parent() as GridContainer).columns].name)


## An example is there alone, and moves; Esc brings the buttons back.
func _check_shown(name: String) -> void:
	var menu: Control = _gallery.get_node(^"Menu")
	var shown: Node = _gallery.get_child(-1)
	_play.check(shown.scene_file_path.ends_with("/%s.tscn" % name), "%s is shown: %s" % [name, shown.scene_file_path])
	_play.check(not menu.visible and root.get_camera_3d() != null, "%s is seen" % name)
	_play.device = null
	_play.hand = null
	_play.mouse = null
	_play.take(self, shown)
	_play.press(_play.mouse.move_up_action, true)
	await _play.ticks(30)
	_play.press(_play.mouse.move_up_action, false)
	_play.check(_play.mouse.position_m.y > _play.mouse.start.y + 0.03, "keys move the hand in %s" % name)
	await _press_key(KEY_ESCAPE)
	_play.check(menu.visible and root.get_camera_3d() == null, "Esc leaves %s" % name)
	_play.check_equal(str(root.gui_get_focus_owner().name), name, "the focus is where it was")


func _press_key(key: Key) -> void:
	var event := InputEventKey.new()
	event.keycode = key
	event.physical_keycode = key
	await _send(event)


func _send(event: InputEvent) -> void:
	for pressed: bool in [true, false]:
		event.set("pressed", pressed)
		root.push_input(event.duplicate() as InputEvent)
		await process_frame
	await process_frame


func _buttons() -> Array[Button]:
	var buttons: Array[Button] = []
	for child: Node in (_gallery.get_node(^"%Buttons") as Node).get_children():
		buttons.append(child)
	return buttons
