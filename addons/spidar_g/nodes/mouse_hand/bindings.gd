extends RefCounted
## Reads the actions of SpidarGMouseHand, and adds the default keys and buttons of those that the project does not have. An
## action that the InputMap does not have, such as one with an empty name, is never pressed.

const DEFAULT_PREFIX: String = "spidar_g_"
const SUFFIX: String = "_action"

## Maps to its default mouse button the property of SpidarGMouseHand that names the action.
const BUTTONS: Dictionary[StringName, MouseButton] = {
	&"grasp_action": MOUSE_BUTTON_LEFT,
	&"turn_action": MOUSE_BUTTON_RIGHT,
	&"wheel_away_action": MOUSE_BUTTON_WHEEL_UP,
	&"wheel_near_action": MOUSE_BUTTON_WHEEL_DOWN,
}
## Maps to its default key the property of SpidarGMouseHand that names the action. A key is identified by its place on a US
## keyboard.
const KEYS: Dictionary[StringName, Key] = {
	&"clutch_action": KEY_SHIFT,
	&"move_left_action": KEY_A,
	&"move_right_action": KEY_D,
	&"move_down_action": KEY_Q,
	&"move_up_action": KEY_E,
	&"move_away_action": KEY_W,
	&"move_near_action": KEY_S,
	&"turn_left_action": KEY_LEFT,
	&"turn_right_action": KEY_RIGHT,
	&"tilt_back_action": KEY_UP,
	&"tilt_forward_action": KEY_DOWN,
	&"roll_left_action": KEY_PAGEUP,
	&"roll_right_action": KEY_PAGEDOWN,
	&"upright_action": KEY_HOME,
}


## Adds each action of `node` that the running project lacks to its InputMap. An action with an empty name is ignored.
static func add_missing(node: Node) -> void:
	for property: StringName in BUTTONS:
		var event: InputEventMouseButton = InputEventMouseButton.new()
		event.button_index = BUTTONS[property]
		_add(property, node.get(property) as StringName, event)
	for property: StringName in KEYS:
		var event: InputEventKey = InputEventKey.new()
		event.physical_keycode = KEYS[property]
		_add(property, node.get(property) as StringName, event)


static func _add(property: StringName, action: StringName, event: InputEvent) -> void:
	if action == &"" or InputMap.has_action(action):
		return
	event.device = -1  # of every mouse and keyboard
	InputMap.add_action(action)
	InputMap.action_add_event(action, event)
	if action != DEFAULT_PREFIX + property.trim_suffix(SUFFIX):
		push_warning((
			"SpidarGMouseHand: %s = \"%s\", and the project has no such input action: it is bound to \"%s\" in this run."
			+ " Add the action in Project Settings > Input Map, or set %s to one that is there."
		) % [property, action, event.as_text(), property])


## Returns the way along the axes of the device on which the pressed keys move the grip of `node`, each part from -1 to 1.
static func way(node: Node) -> Vector3:
	return Vector3(
		_axis(node, &"move_left_action", &"move_right_action"),
		_axis(node, &"move_down_action", &"move_up_action"),
		_axis(node, &"move_away_action", &"move_near_action")
	)


## Returns the turn about the axes of the device by which the pressed keys turn the grip of `node`, each part from -1 to 1.
static func turn(node: Node) -> Vector3:
	return Vector3(
		_axis(node, &"tilt_back_action", &"tilt_forward_action"),
		_axis(node, &"turn_right_action", &"turn_left_action"),
		_axis(node, &"roll_right_action", &"roll_left_action")
	)


static func _axis(node: Node, negative: StringName, positive: StringName) -> float:
	return strength(node.get(positive) as StringName) - strength(node.get(negative) as StringName)


static func strength(action: StringName) -> float:
	return Input.get_action_strength(action) if InputMap.has_action(action) else 0.0


static func is_pressed(event: InputEvent, action: StringName) -> bool:
	return InputMap.has_action(action) and event.is_action_pressed(action)


static func is_released(event: InputEvent, action: StringName) -> bool:
	return InputMap.has_action(action) and event.is_action_released(action)
