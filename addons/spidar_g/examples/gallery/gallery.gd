extends Control
## Shows all examples to choose from. A click, or Enter on the button that has the focus, opens one. Esc returns to the
## buttons.

const FOLDER: String = "res://addons/spidar_g/examples/"
## Maps the name of each folder and scene to the text of its button. To add an example, add a line here and make its picture,
## as the README.md of the examples describes.
const EXAMPLES: Dictionary[String, String] = {
	"first_touch": "First touch\nA table and a ball. Open this one first.",
	"touch": "Touch\nBox, ball, cylinder and a mesh of hills.",
	"materials": "Materials\nHard, soft, slippery, rough, sticky, magnetic: ten samples.",
	"grasp": "Grasp\nThree things to lift, each with its weight and width.",
	"door_and_drawer": "Door and drawer\nHandles on joints: springs, ends and a weight.",
	"two_hands": "Two hands\nA bar that two devices hold: each feels the other.",
	"socket": "Socket\nA plug that clicks on a stand and below an arm.",
	"zone": "Zone\nWater, wind, a rail and a buzz in the air.",
	"clip": "Clip\nA drum, a motor and a board play vibrations.",
	"grip": "Grip\nA torch in the hand: what is below a node follows it.",
	"tracker": "Tracker\nThe device as an XR controller, without a headset.",
	"mouse_hand": "Mouse hand\nWhat mouse and keys do where there is no device.",
}

## The height of a button as a share of its width.
const HEIGHT: float = 0.83
## The font size of a button as a share of its width.
const LETTERS: float = 0.058

var _example: Node = null

@onready var _menu: Control = $Menu
@onready var _buttons: GridContainer = %Buttons
@onready var _back: Label = $Front/Back


func _ready() -> void:
	for name: String in EXAMPLES:
		var button: Button = %Button.duplicate()
		button.name = name
		button.text = EXAMPLES[name]
		button.icon = load(FOLDER + "gallery/pictures/%s.webp" % name)
		button.pressed.connect(open.bind(name))
		_buttons.add_child(button)
	%Button.free()
	_buttons.resized.connect(_size_buttons)
	_size_buttons()
	(_buttons.get_child(0) as Button).grab_focus()


## Shows an example in place of the buttons.
func open(name: String) -> void:
	_example = (load(FOLDER + "%s/%s.tscn" % [name, name]) as PackedScene).instantiate()
	_menu.hide()
	_back.show()
	add_child(_example)


## Shows the buttons again. The focus is on the button that was pressed last.
func close() -> void:
	var name: String = _example.scene_file_path.get_file().get_basename()
	_example.free()
	_example = null
	_back.hide()
	_menu.show()
	(_buttons.get_node(name) as Button).grab_focus()


# Sizes the buttons so that the pictures keep their shape in every window.
func _size_buttons() -> void:
	var width: float = _buttons.size.x / _buttons.columns
	for button: Button in _buttons.get_children():
		button.custom_minimum_size.y = HEIGHT * width
		button.add_theme_font_size_override(&"font_size", roundi(LETTERS * width))


func _unhandled_input(event: InputEvent) -> void:
	if _example != null and event.is_action_pressed(&"ui_cancel"):
		get_viewport().set_input_as_handled()
		close.call_deferred()
