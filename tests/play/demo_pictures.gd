extends SceneTree
## Pictures of all that the demo shows, to be looked at: Godot's arguments `--path demo_project -s tests/play/demo_pictures.gd
## --resolution 1280x720 -- OUT_DIR TEXT_PERCENT`. Needs a display (Xvfb).

const DemoSettings := preload("res://ui/demo_settings.gd")

const FRAMES := 12
## By name of the picture: the scene.
const SCENES: Dictionary[String, String] = {
	"hub": "res://hub/hub.tscn",
	"guide": "res://hub/guided_start.tscn",
	"pick_and_place": "res://tasks/pick_and_place/pick_and_place.tscn",
	"robot_linking": "res://tasks/robot_linking/robot_linking.tscn",
	"match_linking": "res://tasks/match_linking/match_linking.tscn",
	"free_play": "res://tasks/free_play/free_play.tscn",
}

var _folder := ""
var _percent := 100


func _initialize() -> void:
	_folder = OS.get_cmdline_user_args()[0]
	_percent = OS.get_cmdline_user_args()[1].to_int()
	_run.call_deferred()


func _run() -> void:
	for name in SCENES:
		var scene: Node = (load(SCENES[name]) as PackedScene).instantiate()
		var settings := DemoSettings.new()
		settings.text_percent = _percent
		scene.set(&"settings", settings)
		root.add_child(scene)
		await _take(name)
		if name == "hub":
			for page in 4:
				(scene.get_node(^"Menu/FormPanel/Form") as TabContainer).current_tab = page
				(scene.get_node(^"Menu/Panel/Rows/Settings") as Button).button_pressed = true
				await _take("hub_settings_%d" % page)
			(scene.get_node(^"Menu/Panel/Rows/Settings") as Button).button_pressed = false
		if name == "hub" or name == "free_play":
			(scene.get_node(^"Hud")).call(&"toggle_help")
			await _take(name + "_help")
			(scene.get_node(^"Hud")).call(&"toggle_help")
		if name == "pick_and_place":
			var notice := scene.get_node(^"Hud/%FrameRate")
			for _frame in 100:
				notice.call(&"note_frame", 0.1)
			(scene.get_node(^"SpidarG") as SpidarG).forces_enabled = true
			for _frame in 100:
				await process_frame
			for _frame in 100:
				notice.call(&"note_frame", 0.1)
			await _take(name + "_low_rate")
		scene.queue_free()
		await process_frame
	await _take_questions()
	quit()


func _take_questions() -> void:
	var screen: Node = (load("res://study/experiment_screen.tscn") as PackedScene).instantiate()
	screen.set(&"text_percent", _percent)
	root.add_child(screen)
	screen.call(&"ask_ratings", "forces_on", func(_answers: Dictionary) -> void: pass)
	await _take("questions")


func _take(name: String) -> void:
	for _frame in FRAMES:
		await process_frame
	root.get_texture().get_image().save_png("%s/%s_%d_%d.png" % [_folder, name, root.size.x, _percent])
