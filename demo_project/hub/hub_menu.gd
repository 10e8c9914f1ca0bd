extends CanvasLayer
## The menu on the screen: the same choices as the knobs, and settings, experiment and guided start. It works by mouse and by
## keyboard: an entry has the action demo_entry_1, demo_entry_2 and so on, in the order of the buttons. Tab and the arrow keys
## move the focus, Enter chooses, Escape closes the settings.

const DemoSettings := preload("res://ui/demo_settings.gd")
const KeyNames := preload("res://ui/key_names.gd")
const SettingsForm := preload("res://ui/settings_form.gd")
const TextSize := preload("res://ui/text_size.gd")

signal chosen(entry: StringName)
signal applied

const MARGIN_PX := 20.0

var _buttons: Array[Button] = []

@onready var _panel: Control = $Panel
@onready var _level: Button = $Panel/Rows/Level
@onready var _settings: Button = $Panel/Rows/Settings
@onready var _form_panel: Control = $FormPanel
@onready var _form: SettingsForm = $FormPanel/Form


func _ready() -> void:
	for child in $Panel/Rows.get_children():
		var button := child as Button
		if button == null:
			continue
		_buttons.append(button)
		_name_button(button, tr(button.text))
		if button != _settings:
			button.pressed.connect(chosen.emit.bind(StringName(String(button.name).to_snake_case())))
	_settings.toggled.connect(_show_form)
	_form.applied.connect(applied.emit)


func setup(settings: DemoSettings) -> void:
	_form.setup(settings)
	_buttons[0].grab_focus()


func show_level(level: int) -> void:
	_name_button(_level, tr("LEVEL") % level)


## percent: one of TextSize.CHOICES_PERCENT.
func set_text_percent(percent: int) -> void:
	TextSize.apply(_panel, percent)
	TextSize.apply(_form_panel, percent)
	_fit.call_deferred()


## The width that the menu takes at the left of the screen.
func width_px() -> float:
	return _panel.get_combined_minimum_size().x + MARGIN_PX


func panels() -> Array[Control]:
	var shown: Array[Control] = []
	for panel: Control in [_panel, _form_panel]:
		if panel.is_visible_in_tree():
			shown.append(panel)
	return shown


func _fit() -> void:
	_form_panel.offset_left = _panel.get_combined_minimum_size().x + 2.0 * MARGIN_PX
	_form_panel.offset_right = _form_panel.offset_left


func _show_form(shown: bool) -> void:
	_form_panel.visible = shown
	_fit()
	if shown:
		_form.get_tab_bar().grab_focus()
	else:
		_settings.grab_focus()


func _unhandled_key_input(event: InputEvent) -> void:
	if not visible:
		return
	if _form_panel.visible and event.is_action_pressed(&"ui_cancel"):
		_settings.button_pressed = false
		get_viewport().set_input_as_handled()
		return
	for index in _buttons.size():
		if not event.is_action_pressed(_action_of(index)):
			continue
		if _buttons[index] == _settings:
			_settings.button_pressed = not _settings.button_pressed
		else:
			_buttons[index].pressed.emit()
		return


## The key stands before the text.
func _name_button(button: Button, text: String) -> void:
	button.text = "%s   %s" % [KeyNames.of(_action_of(_buttons.find(button))), text]


func _action_of(index: int) -> StringName:
	return &"demo_entry_%d" % (index + 1)
