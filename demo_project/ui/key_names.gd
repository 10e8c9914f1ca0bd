extends RefCounted
## What the keys and buttons of an action are called on the screen. Texts name an action in braces, "{demo_help}  help", so
## that they stay true when the project's input map changes.

## Keys of the translation.
const BUTTONS: Dictionary[int, String] = {
	MOUSE_BUTTON_LEFT: "BUTTON_LEFT",
	MOUSE_BUTTON_RIGHT: "BUTTON_RIGHT",
	MOUSE_BUTTON_MIDDLE: "BUTTON_MIDDLE",
	MOUSE_BUTTON_WHEEL_UP: "WHEEL_UP",
	MOUSE_BUTTON_WHEEL_DOWN: "WHEEL_DOWN",
}


## The text with each action in braces replaced by its keys.
static func fill(text: String) -> String:
	var braces := RegEx.create_from_string("\\{(\\w+)\\}")
	var filled := text
	for found in braces.search_all(text):
		filled = filled.replace(found.get_string(), of(found.get_string(1)))
	return filled


## The keys and buttons of one action, as "P" or "P / Pause"; "no key" when it has none.
static func of(action: StringName) -> String:
	var names := PackedStringArray()
	for event in _events(action):
		if event is InputEventKey:
			names.append(_key_name(event as InputEventKey))
		elif event is InputEventMouseButton:
			var key: String = BUTTONS.get((event as InputEventMouseButton).button_index, event.as_text())
			names.append(TranslationServer.translate(key))
		else:
			names.append(event.as_text())
	return String(TranslationServer.translate("NO_KEY")) if names.is_empty() else " / ".join(names)


## The editor's own input map does not hold the project's actions: there they are read from the project's settings.
static func _events(action: StringName) -> Array[InputEvent]:
	var events: Array[InputEvent] = []
	if InputMap.has_action(action):
		events = InputMap.action_get_events(action)
	else:
		var setting: Dictionary = ProjectSettings.get_setting("input/" + action, {})
		events.assign(setting.get("events", []))
	return events


## As printed on this keyboard, where a display can say that: "F", "Page Up".
static func _key_name(event: InputEventKey) -> String:
	var key := event.keycode
	if key == KEY_NONE:
		key = event.physical_keycode
		if DisplayServer.get_name() != "headless":
			key = DisplayServer.keyboard_get_keycode_from_physical(key)
	return OS.get_keycode_string(key).capitalize()
