extends TabContainer
## The settings on four pages, a line each. A node has the name of its setting in demo_settings.gd, in Pascal case:
## WorkspaceScale.

const DemoSettings := preload("res://ui/demo_settings.gd")
const KeyNames := preload("res://ui/key_names.gd")
const PictureQuality := preload("res://scene/picture_quality.gd")
const TextSize := preload("res://ui/text_size.gd")

## A setting has changed.
signal applied

## In the order of the pages. Keys of the translation, as are all texts here.
const TITLES: PackedStringArray = ["PAGE_DEVICE", "PAGE_HAND", "PAGE_SCREEN", "PAGE_PERSON"]
const EXPERIENCE: PackedStringArray = [
	"EXPERIENCE_NOT_ASKED", "EXPERIENCE_NONE", "EXPERIENCE_2", "EXPERIENCE_3", "EXPERIENCE_4", "EXPERIENCE_A_LOT",
]
## What the values are called that are words.
const WORDS: Dictionary[String, String] = {
	DemoSettings.SIMULATED: "VALUE_SIMULATED",
	DemoSettings.DEVICE: "VALUE_DEVICE",
	DemoSettings.SERIAL: "VALUE_SERIAL",
	DemoSettings.MOUSE: "VALUE_MOUSE",
	DemoSettings.REPLAY: "VALUE_REPLAY",
	"held": "VALUE_HELD",
	"switched": "VALUE_SWITCHED",
	PictureQuality.AUTOMATIC: "VALUE_AUTOMATIC",
	PictureQuality.FULL: "VALUE_FULL",
	PictureQuality.PLAIN: "VALUE_PLAIN",
	"": "VALUE_NONE",
}

var _settings: DemoSettings


## Shows the settings, and changes them from now on.
func setup(settings: DemoSettings) -> void:
	_settings = settings
	for page in TITLES.size():
		set_tab_title(page, TITLES[page])
	for child in find_children("*Label", "Label"):
		(child as Label).text = KeyNames.fill(tr((child as Label).text))
	_offer($Device/Source, "source", Array(DemoSettings.SOURCES))
	_take_text($Device/DeviceSerial, "device_serial")
	_offer($Device/Recording, "recording", [""] + Array(DemoSettings.recordings()))
	_offer($Device/RateHz, "rate_hz", Array(DemoSettings.RATES_HZ))
	_take_switch($Hand/ForcesAllowed, "forces_allowed")
	_offer($Hand/WorkspaceScale, "workspace_scale", Array(DemoSettings.SCALES))
	_offer($Hand/Clutch, "clutch", Array(DemoSettings.CLUTCHES))
	_take_switch($Hand/AutoAnimation, "auto_animation")
	_offer($Screen/Picture, "picture", Array(PictureQuality.CHOICES))
	_offer($Screen/TextPercent, "text_percent", Array(TextSize.CHOICES_PERCENT))
	_take_text($Person/Participant, "participant")
	_offer($Person/ComputerExperience, "computer_experience", range(EXPERIENCE.size()), EXPERIENCE)
	_offer($Person/HapticExperience, "haptic_experience", range(EXPERIENCE.size()), EXPERIENCE)


## texts: what the values are called; empty: as WORDS says, or as they are.
func _offer(option: OptionButton, key: String, values: Array, texts: PackedStringArray = []) -> void:
	for index in values.size():
		var text := str(values[index])
		option.add_item(WORDS.get(text, text) if texts.is_empty() else texts[index])
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
