extends CanvasLayer
## The menu on the screen: the same choices as the knobs, and settings and participant. Works by mouse and by keyboard
## (1 to 7, or Tab and Enter).

const DemoPalette := preload("res://scene/demo_palette.gd")
const DemoSettings := preload("res://ui/demo_settings.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")

signal chosen(entry: StringName)
signal applied

const ENTRIES: Dictionary[StringName, String] = {
	&"pick_and_place": "1   Pick and place",
	&"robot_linking": "2   Robot linking",
	&"match_linking": "3   Match linking",
	&"free_play": "4   Free play",
	&"level": "5   Level 1",
}
const WIDTH_PX := 230.0
const EXPERIENCE: PackedStringArray = ["not asked", "1 none", "2", "3", "4", "5 a lot"]

var _settings: DemoSettings
var _rows: VBoxContainer
var _form: GridContainer
var _level: Button


func setup(settings: DemoSettings) -> void:
	_settings = settings
	var panel := PanelContainer.new()
	panel.add_theme_stylebox_override("panel", preload("res://ui/panel_style.tres"))
	panel.position = Vector2(20.0, 20.0)
	add_child(panel)
	_rows = VBoxContainer.new()
	_rows.custom_minimum_size.x = WIDTH_PX
	panel.add_child(_rows)
	_add_text(_rows, "spidar_g", DemoPalette.TEXT, 26)
	_add_text(_rows, "touch a knob and close on it,\nor choose here", DemoPalette.TEXT_SOFT, 13)
	for entry in ENTRIES:
		var button := _add_button(ENTRIES[entry])
		button.pressed.connect(func() -> void: chosen.emit(entry))
		if entry == &"level":
			_level = button
	var settings_button := _add_button("6   Settings")
	settings_button.toggle_mode = true
	settings_button.toggled.connect(func(shown: bool) -> void: _form.visible = shown)
	_add_button("7   Experiment").pressed.connect(func() -> void: chosen.emit(&"experiment"))
	_build_form()


func show_level(level: int) -> void:
	_level.text = "5   Level %d" % level


func _unhandled_key_input(event: InputEvent) -> void:
	for number in ENTRIES.size():
		if event.is_action_pressed(&"demo_entry_%d" % (number + 1)):
			chosen.emit(ENTRIES.keys()[number])
	if event.is_action_pressed(&"demo_entry_7"):
		chosen.emit(&"experiment")
	elif event.is_action_pressed(&"demo_entry_6"):
		_form.visible = not _form.visible


func _build_form() -> void:
	_form = GridContainer.new()
	_form.columns = 2
	_form.visible = false
	_rows.add_child(_form)
	_add_choice("Source", "source", Array(DemoSettings.SOURCES))
	_add_text_field("Device's serial number", "device_serial")
	_add_choice("Recording (L makes one)", "recording", [""] + Array(DemoSettings.recordings()))
	_add_check("Forces may be turned on", "forces_allowed")
	_add_choice("Scale", "workspace_scale", Array(DemoSettings.SCALES))
	_add_choice("Rate, Hz", "rate_hz", Array(DemoSettings.RATES_HZ))
	_add_choice("Clutch (C)", "clutch", Array(DemoSettings.CLUTCHES))
	_add_check("Auto-animation", "auto_animation")
	_add_choice("Picture", "picture", Array(PictureQuality.CHOICES))
	_add_text_field("Participant", "participant")
	_add_experience("Computers", "computer_experience")
	_add_experience("Force feedback", "haptic_experience")


func _add_text_field(text: String, key: String) -> void:
	_add_text(_form, text, DemoPalette.TEXT_SOFT, 13)
	var field := LineEdit.new()
	field.text = _settings.get(key)
	field.text_changed.connect(func(value: String) -> void: _change(key, value))
	_form.add_child(field)


func _add_check(text: String, key: String) -> void:
	_add_text(_form, text, DemoPalette.TEXT_SOFT, 13)
	var check := CheckButton.new()
	check.button_pressed = _settings.get(key)
	check.toggled.connect(func(value: bool) -> void: _change(key, value))
	_form.add_child(check)


func _add_choice(text: String, key: String, values: Array) -> void:
	_add_text(_form, text, DemoPalette.TEXT_SOFT, 13)
	var option := OptionButton.new()
	if key == "recording": # A long name is cut off instead of widening the menu.
		option.fit_to_longest_item = false
		option.clip_text = true
	for value: Variant in values:
		option.add_item("none" if str(value) == "" else str(value))
	option.selected = values.find(_settings.get(key))
	option.item_selected.connect(func(index: int) -> void: _change(key, values[index]))
	_form.add_child(option)


func _add_experience(text: String, key: String) -> void:
	_add_text(_form, text, DemoPalette.TEXT_SOFT, 13)
	var option := OptionButton.new()
	for value in EXPERIENCE:
		option.add_item(value)
	option.selected = _settings.get(key)
	option.item_selected.connect(func(index: int) -> void: _change(key, index))
	_form.add_child(option)


func _change(key: String, value: Variant) -> void:
	_settings.set(key, value)
	applied.emit()


func _add_button(text: String) -> Button:
	var button := Button.new()
	button.text = text
	button.alignment = HORIZONTAL_ALIGNMENT_LEFT
	button.add_theme_font_size_override("font_size", 16)
	_rows.add_child(button)
	return button


func _add_text(parent: Node, text: String, colour: Color, size: int) -> void:
	var label := Label.new()
	label.text = text
	label.add_theme_color_override("font_color", colour)
	label.add_theme_font_size_override("font_size", size)
	parent.add_child(label)
