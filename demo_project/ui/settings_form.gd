extends GridContainer
## The settings, a line each. A node is called as its setting in demo_settings.gd, in Pascal case: WorkspaceScale.

const DemoSettings := preload("res://ui/demo_settings.gd")
const KeyNames := preload("res://ui/key_names.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")

## A setting has changed.
signal applied

const EXPERIENCE: PackedStringArray = ["not asked", "1 none", "2", "3", "4", "5 a lot"]

var _settings: DemoSettings


## Shows the settings, and changes them from now on.
func setup(settings: DemoSettings) -> void:
	_settings = settings
	for child in get_children():
		if child is Label:
			(child as Label).text = KeyNames.fill((child as Label).text)
	_offer($Source, "source", Array(DemoSettings.SOURCES))
	_take_text($DeviceSerial, "device_serial")
	_offer($Recording, "recording", [""] + Array(DemoSettings.recordings()))
	_take_switch($ForcesAllowed, "forces_allowed")
	_offer($WorkspaceScale, "workspace_scale", Array(DemoSettings.SCALES))
	_offer($RateHz, "rate_hz", Array(DemoSettings.RATES_HZ))
	_offer($Clutch, "clutch", Array(DemoSettings.CLUTCHES))
	_take_switch($AutoAnimation, "auto_animation")
	_offer($Picture, "picture", Array(PictureQuality.CHOICES))
	_take_text($Participant, "participant")
	_offer($ComputerExperience, "computer_experience", range(EXPERIENCE.size()), EXPERIENCE)
	_offer($HapticExperience, "haptic_experience", range(EXPERIENCE.size()), EXPERIENCE)


## texts: what the values are called; empty: as they are.
func _offer(option: OptionButton, key: String, values: Array, texts: PackedStringArray = []) -> void:
	for index in values.size():
		var text := str(values[index]) if texts.is_empty() else texts[index]
		option.add_item("none" if text == "" else text)
	option.selected = values.find(_settings.get(key))
	option.item_selected.connect(func(index: int) -> void: _change(key, values[index]))


func _take_text(field: LineEdit, key: String) -> void:
	field.text = _settings.get(key)
	field.text_changed.connect(func(value: String) -> void: _change(key, value))


func _take_switch(switch: CheckButton, key: String) -> void:
	switch.button_pressed = _settings.get(key)
	switch.toggled.connect(func(value: bool) -> void: _change(key, value))


func _change(key: String, value: Variant) -> void:
	_settings.set(key, value)
	applied.emit()
