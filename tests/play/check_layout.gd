extends "check_case.gd"
## Text at every size on 1280x720 and 1920x1080: nothing that is shown leaves the screen, is cut off, or covers something else.

const DemoHud := preload("res://ui/hud.gd")
const ExperimentScreen := preload("res://study/experiment_screen.gd")
const FrameRateNotice := preload("res://ui/frame_rate_notice.gd")
const GuidedStart := preload("res://hub/guided_start.gd")
const SceneLabels := preload("res://ui/scene_labels.gd")
const TextSize := preload("res://ui/text_size.gd")

## Rounding of sizes, px.
const ROUNDING_PX := 1.0


func _run() -> void:
	about = "layout"
	for size in SIZES:
		root.size = size
		for percent in TextSize.CHOICES_PERCENT:
			var where := "%d %%, %d wide" % [percent, size.x]
			for name in SCENES:
				await _check_scene(name, percent, "%s, %s" % [name, where])
			await _check_experiment(percent, where)
	await _check_live()


func _settings(percent: int) -> DemoSettings:
	var settings := DemoSettings.new()
	settings.text_percent = percent
	return settings


func _check_scene(name: String, percent: int, where: String) -> void:
	var task := open(name, _settings(percent))
	await frames(8)
	_check_all(task, where)
	var hud: DemoHud = task.get_node(^"Hud")
	hud.toggle_help()
	await frames(3)
	_check_all(task, where + ", help")
	hud.toggle_help()
	var notice: FrameRateNotice = task.get_node(^"Hud/%FrameRate")
	for plain: bool in [false, true]:
		notice.is_plain = plain
		for _frame in 100:
			notice.note_frame(0.1)
		hud.show_notice("NOTICE_FOCUS_LOST")
		await frames(4)
		check(notice.visible, where + ": no notice of the low rate")
		_check_all(task, "%s, low rate, plain %s" % [where, plain])
	if name == "hub":
		await _check_settings(task, where)
	if name == "guided_start":
		await _check_guide(task as GuidedStart, where)
	await close(task)


func _check_settings(hub: Node, where: String) -> void:
	(hub.get_node(^"Menu/Panel/Rows/Settings") as Button).button_pressed = true
	var form: TabContainer = hub.get_node(^"Menu/FormPanel/Form")
	for page in form.get_tab_count():
		form.current_tab = page
		await frames(4)
		_check_all(hub, "%s, settings page %d" % [where, page])
		var bar := form.get_tab_bar()
		check(bar.size.x + ROUNDING_PX >= bar.get_tab_rect(form.get_tab_count() - 1).end.x, where + ": tabs are cut off")
		check(not bar.get_offset_buttons_visible(), where + ": tabs do not fit")


func _check_guide(guide: GuidedStart, where: String) -> void:
	for step in guide.steps.Step.size():
		guide.steps.step = step as GuidedStart.GuideSteps.Step
		guide.call(&"_show_step")
		await frames(4)
		check((guide.get_node(^"Guide/Panel/Rows/Text") as Label).text != "", "%s, step %d: no text" % [where, step])
		_check_all(guide, "%s, step %d" % [where, step])
		guide.get_node(^"Guide").call(&"show_step", step, 4, false)
		await frames(4)
		_check_all(guide, "%s, step %d, by the grip" % [where, step])


func _check_experiment(percent: int, where: String) -> void:
	var screen: ExperimentScreen = (load("res://study/experiment_screen.tscn") as PackedScene).instantiate()
	screen.text_percent = percent
	root.add_child(screen)
	screen.ask_ratings("forces_on", func(_answers: Dictionary) -> void: pass)
	await frames(4)
	_check_all(screen, where + ", questions")
	var text := "%s\n\n%s\n\n%s" % [
		tr("GOAL_PICK_AND_PLACE"), tr("CONDITION_MOUSE_AUTO"), tr("EXPERIMENT_PRACTICE") % 3
	]
	screen.show_text("TITLE_PICK_AND_PLACE", text, "EXPERIMENT_START", func() -> void: pass)
	await frames(4)
	_check_all(screen, where + ", instruction")
	await close(screen)


## The size that is chosen in the settings is shown at once.
func _check_live() -> void:
	root.size = SIZES[0]
	var hub := open("hub")
	await frames(4)
	var button: Button = hub.get_node(^"Menu/Panel/Rows/Settings")
	var small := button.get_theme_font_size(&"font_size")
	hub.settings.text_percent = 200
	hub.call(&"_show_texts")
	await frames(4)
	check(button.get_theme_font_size(&"font_size") == 2 * small, "the size is not applied at once")
	_check_all(hub, "200 % chosen in the menu")
	hub.settings.text_percent = 100
	hub.call(&"_show_texts")
	await frames(4)
	check(button.get_theme_font_size(&"font_size") == small, "the size does not come back")
	await close(hub)


## Panels against each other; and, inside a panel, every text against every other.
func _check_all(scene: Node, where: String) -> void:
	var screen := root.get_visible_rect().grow(ROUNDING_PX)
	var panels: Array[Control] = []
	for panel: Control in scene.find_children("*", "PanelContainer", true, false):
		if panel.is_visible_in_tree():
			panels.append(panel)
	var labels := scene.get_node_or_null(^"SceneLabels") as SceneLabels
	if labels != null:
		panels.append_array(labels.shown())
	check(not panels.is_empty(), where + ": nothing is shown")
	for index in panels.size():
		var rect := panels[index].get_global_rect()
		check(screen.encloses(rect), "%s: %s leaves the screen: %s" % [where, panels[index].name, rect])
		for other in index:
			var covered := rect.grow(-ROUNDING_PX).intersects(panels[other].get_global_rect())
			check(not covered, "%s: %s covers %s" % [where, panels[index].name, panels[other].name])
		_check_texts(panels[index], where)


func _check_texts(panel: Control, where: String) -> void:
	var texts: Array[Control] = []
	for control: Control in panel.find_children("*", "Control", true, false):
		var is_text := control is Label or control is BaseButton or control is LineEdit or control.has_method(&"set_text_scale")
		if is_text and control.is_visible_in_tree():
			texts.append(control)
	for index in texts.size():
		var rect := texts[index].get_global_rect()
		var inside := panel.get_global_rect().grow(ROUNDING_PX).encloses(rect) or texts[index] is FrameRateNotice
		check(inside, "%s: %s leaves its panel" % [where, texts[index].name])
		_check_cut(texts[index], where)
		for other in index:
			var covered := rect.grow(-ROUNDING_PX).intersects(texts[other].get_global_rect().grow(-ROUNDING_PX))
			check(not covered, "%s: %s covers %s" % [where, texts[index].name, texts[other].name])


## Each text has the room that it needs.
func _check_cut(control: Control, where: String) -> void:
	var need := control.get_combined_minimum_size()
	check(
		control.size.x + ROUNDING_PX >= need.x and control.size.y + ROUNDING_PX >= need.y,
		"%s: %s has %s, needs %s" % [where, control.name, control.size, need]
	)
	if control is Label and not (control as Label).text.is_empty():
		var label := control as Label
		check(label.get_visible_line_count() == label.get_line_count(), "%s: %s shows %d of %d lines" % [
			where, label.name, label.get_visible_line_count(), label.get_line_count()])
