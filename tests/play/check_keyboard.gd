extends "check_case.gd"
## Every menu by keyboard events alone: the focus is where it can be seen, it reaches every control and comes round, Enter
## chooses, Escape leaves.

const ExperimentScreen := preload("res://study/experiment_screen.gd")
const GuidedStart := preload("res://hub/guided_start.gd")
const Hub := preload("res://hub/hub.gd")

## Nobody needs more steps to come round.
const MOST_STEPS := 60

var _chosen: Array[StringName] = []
var _left := 0


func _run() -> void:
	about = "keyboard"
	root.size = SIZES[0]
	await _check_hub()
	await _check_entries()
	await _check_settings()
	await _check_help()
	await _check_guide()
	await _check_low_rate()
	await _check_experiment()


func _open_hub() -> Hub:
	var hub := open("hub") as Hub
	_chosen.clear()
	_left = 0
	hub.chosen.connect(func(entry: StringName, _level: int) -> void: _chosen.append(entry))
	hub.left.connect(func() -> void: _left += 1)
	await frames(5)
	return hub


## The name of what has the focus; empty: nothing.
func _focus() -> String:
	var owner := root.gui_get_focus_owner()
	return "" if owner == null else String(owner.name)


func _check_seen(where: String) -> void:
	var owner := root.gui_get_focus_owner()
	check(owner != null, where + ": nothing has the focus")
	if owner == null:
		return
	check(owner.is_visible_in_tree() and owner.has_focus(true), "%s: the focus of %s is not seen" % [where, owner.name])
	var style_name := &"tab_focus" if owner is TabBar else &"focus"
	var style := owner.get_theme_stylebox(style_name) as StyleBoxFlat
	check(style != null and style.border_width_left >= 3, "%s: %s has no visible focus" % [where, owner.name])


## Goes round with `key`: the names of all that had the focus, in order.
func _round(key: Key, shift: bool, where: String) -> PackedStringArray:
	var names := PackedStringArray([_focus()])
	for _step in MOST_STEPS:
		await press(key, shift)
		_check_seen(where)
		if _focus() == names[0]:
			return names
		names.append(_focus())
	check(false, "%s: the focus does not come round: %s" % [where, names])
	return names


func _check_hub() -> void:
	var hub := await _open_hub()
	var names := PackedStringArray()
	for button: Button in hub.get_node(^"Menu/Panel/Rows").find_children("*", "Button", false):
		names.append(button.name)
	_check_seen("hub")
	check(_focus() == names[0], "the focus begins on " + _focus())
	check(await _round(KEY_TAB, false, "hub, Tab") == names, "Tab goes in another order")
	var back := await _round(KEY_TAB, true, "hub, Shift+Tab")
	back.reverse()
	check(back == names.slice(1) + names.slice(0, 1), "Shift+Tab goes in another order: %s" % back)
	for index in range(1, names.size()):
		await press(KEY_DOWN)
		check(_focus() == names[index], "down goes to %s, not %s" % [_focus(), names[index]])
	var turned: Vector3 = hub.get_node(^"MouseHand").get(&"turn_rad")
	check(turned.is_zero_approx(), "the arrow keys have turned the grip, too: %s" % turned)
	await press(KEY_ESCAPE)
	check(_left == 1, "Escape leaves the hub %d times" % _left)
	await close(hub)


## Each entry by Enter, and by its number.
func _check_entries() -> void:
	var hub := await _open_hub()
	var buttons := hub.get_node(^"Menu/Panel/Rows").find_children("*", "Button", false)
	for index in buttons.size():
		var entry := String(buttons[index].name).to_snake_case()
		(buttons[index] as Button).grab_focus()
		if entry in ["settings", "level"]:
			continue
		_chosen.clear()
		await press(KEY_ENTER)
		await press((KEY_1 + index) as Key)
		check(_chosen == [StringName(entry), StringName(entry)], "%s: chosen by Enter and by its number: %s" % [entry, _chosen])
	_chosen.clear()
	(buttons[0] as Button).grab_focus()
	await press(KEY_SPACE)
	check(_chosen.is_empty(), "the panic key chooses %s" % [_chosen])
	var level := hub.settings.level
	(hub.get_node(^"Menu/Panel/Rows/Level") as Button).grab_focus()
	await press(KEY_ENTER)
	check(hub.settings.level == level + 1, "Enter does not change the level")
	await close(hub)


func _check_settings() -> void:
	var hub := await _open_hub()
	var form: TabContainer = hub.get_node(^"Menu/FormPanel/Form")
	for _step in 5:
		await press(KEY_DOWN)
	await press(KEY_ENTER)
	check(form.is_visible_in_tree() and root.gui_get_focus_owner() == form.get_tab_bar(), "the settings do not take the focus")
	for page in form.get_tab_count():
		check(form.current_tab == page, "page %d is shown, not %d" % [form.current_tab, page])
		var wanted := PackedStringArray()
		for control: Control in form.get_current_tab_control().find_children("*", "Control", false):
			if control is BaseButton or control is LineEdit:
				wanted.append(control.name)
		var reached := await _round(KEY_TAB, false, "settings page %d" % page)
		for name in wanted:
			check(reached.has(name), "page %d: Tab does not reach %s" % [page, name])
		check(root.gui_get_focus_owner() == form.get_tab_bar(), "page %d: not back on the tabs" % page)
		await press(KEY_RIGHT)
	await _check_values(hub, form)
	await press(KEY_ESCAPE)
	check(not form.is_visible_in_tree(), "Escape does not close the settings")
	check(_focus() == "Settings", "the focus is on %s after the settings" % _focus())
	check(_left == 0, "Escape in the settings leaves the hub")
	await press(KEY_ESCAPE)
	check(_left == 1, "the second Escape does not leave the hub")
	await close(hub)


## A list, a switch and a text field are changed by keys.
func _check_values(hub: Hub, form: TabContainer) -> void:
	await _go_to(form, 2, "TextPercent")
	await press(KEY_ENTER)
	await press(KEY_DOWN)
	await press(KEY_ENTER)
	check(hub.settings.text_percent == 125, "Enter, Down, Enter: the text size is %d percent" % hub.settings.text_percent)
	await press(KEY_ENTER)
	await press(KEY_ESCAPE)
	check(form.is_visible_in_tree() and hub.settings.text_percent == 125, "Escape in an open list does more than close it")
	await _go_to(form, 1, "AutoAnimation")
	await press(KEY_ENTER)
	check(hub.settings.auto_animation, "Enter does not switch")
	await _go_to(form, 3, "Participant")
	var field := root.gui_get_focus_owner() as LineEdit
	if not field.is_editing():
		await press(KEY_ENTER)
	var digit := InputEventKey.new()
	digit.keycode = KEY_7
	digit.physical_keycode = KEY_7
	digit.unicode = 55
	digit.pressed = true
	Input.parse_input_event(digit)
	await frames(2)
	check(hub.settings.participant == "7", "the participant is %s after 7" % hub.settings.participant)
	check(_chosen.is_empty(), "a digit in a text field chooses %s" % [_chosen])
	await press(KEY_ENTER)


## The focus to a control of a page, by keys.
func _go_to(form: TabContainer, page: int, name: String) -> void:
	for _step in MOST_STEPS:
		if root.gui_get_focus_owner() == form.get_tab_bar():
			break
		await press(KEY_TAB)
	for _step in form.get_tab_count():
		if form.current_tab < page:
			await press(KEY_RIGHT)
		elif form.current_tab > page:
			await press(KEY_LEFT)
	for _step in MOST_STEPS:
		if _focus() == name:
			return
		await press(KEY_TAB)
	check(false, "%s is not reached" % name)


## The help is opened and closed by its key, and closed by Escape, which then does nothing else.
func _check_help() -> void:
	var task := open("free_play")
	_left = 0
	task.left.connect(func() -> void: _left += 1)
	await frames(3)
	var help: Control = task.get_node(^"Hud/Screen/Help")
	await press(KEY_H)
	check(help.visible, "H does not open the help")
	await press(KEY_ESCAPE)
	check(not help.visible and _left == 0, "Escape does not close the help alone")
	await press(KEY_ESCAPE)
	check(_left == 1, "Escape does not leave")
	await close(task)


func _check_guide() -> void:
	for key: Key in [KEY_ENTER, KEY_G, KEY_ESCAPE]:
		var guide := open("guided_start") as GuidedStart
		_left = 0
		guide.left.connect(func() -> void: _left += 1)
		await frames(3)
		_check_seen("guided start")
		await press(key)
		check(_left == 1, "%s leaves the guided start %d times" % [OS.get_keycode_string(key), _left])
		await close(guide)


## The plain picture by its key, in a task where nothing has the focus.
func _check_low_rate() -> void:
	var task := open("free_play")
	await frames(3)
	var notice: Control = task.get_node(^"Hud/%FrameRate")
	notice.set(&"is_plain", false)
	for _frame in 100:
		notice.call(&"note_frame", 0.1)
	await press(KEY_V)
	check(task.settings.picture == "plain" and not notice.visible, "V does not choose the plain picture")
	await close(task)


func _check_experiment() -> void:
	var screen: ExperimentScreen = (load("res://study/experiment_screen.tscn") as PackedScene).instantiate()
	root.add_child(screen)
	var gone_on := [0]
	screen.show_text("EXPERIMENT_BREAK", "EXPERIMENT_REST", "GO_ON", func() -> void: gone_on[0] += 1)
	await frames(2)
	_check_seen("break")
	await press(KEY_ENTER)
	check(gone_on[0] == 1, "Enter does not go on after a break")
	var answers := {}
	screen.ask_ratings("forces_on", func(given: Dictionary) -> void: answers.merge(given))
	await frames(2)
	for question in ExperimentScreen.questions("forces_on").size():
		_check_seen("question %d" % question)
		for _step in question:
			await press(KEY_RIGHT)
		await press(KEY_ENTER)
		for _step in MOST_STEPS:
			if (root.gui_get_focus_owner() as Button).get_index() == 0 and _step > 0:
				break
			await press(KEY_TAB)
	for _step in MOST_STEPS:
		if _focus() == "Button":
			break
		await press(KEY_TAB)
	await press(KEY_ENTER)
	check(answers.values() == [1, 2, 3, 4, 5], "the answers by keys are %s" % answers)
	await close(screen)
