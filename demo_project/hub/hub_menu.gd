extends CanvasLayer
## The menu on the screen: the same choices as the knobs, and settings and participant. Works by mouse and by keyboard: an entry
## has the action demo_entry_1, demo_entry_2 and so on, in the order of the buttons; Tab and Enter work, too.

const DemoSettings := preload("res://ui/demo_settings.gd")
const KeyNames := preload("res://ui/key_names.gd")
const SettingsForm := preload("res://ui/settings_form.gd")

signal chosen(entry: StringName)
signal applied

var _buttons: Array[Button] = []

@onready var _level: Button = $Panel/Rows/Level
@onready var _settings: Button = $Panel/Rows/Settings
@onready var _form: SettingsForm = $Panel/Rows/Form


func _ready() -> void:
	for child in $Panel/Rows.get_children():
		var button := child as Button
		if button == null:
			continue
		_buttons.append(button)
		_name_button(button, button.text)
		if button != _settings:
			button.pressed.connect(chosen.emit.bind(StringName(String(button.name).to_snake_case())))
	_settings.toggled.connect(func(shown: bool) -> void: _form.visible = shown)
	_form.applied.connect(applied.emit)


func setup(settings: DemoSettings) -> void:
	_form.setup(settings)


func show_level(level: int) -> void:
	_name_button(_level, "Level %d" % level)


func _unhandled_key_input(event: InputEvent) -> void:
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
