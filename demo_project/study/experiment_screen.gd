extends CanvasLayer
## Texts and questionnaires between the trials.

const DemoPalette := preload("res://scene/demo_palette.gd")

## The paper's scale, Table 3.
const SCALE: PackedStringArray = ["1 bad", "2 little bad", "3 average", "4 good", "5 best"]
const QUESTIONS: Dictionary[String, String] = {
	"grasp": "Grasping things",
	"translation": "Moving things",
	"rotation": "Turning things",
	"overall": "Overall",
	"against_mouse": "Compared with a mouse",
}
const WIDTH_PX := 640.0

var _panel: PanelContainer


## Keys of the questions that this condition is asked.
static func questions(condition: String) -> PackedStringArray:
	var keys := PackedStringArray(QUESTIONS.keys())
	if condition.begins_with("mouse"):
		keys.remove_at(keys.find("against_mouse"))
	return keys


func hide_all() -> void:
	if _panel != null:
		_panel.queue_free()
	_panel = null


func show_text(heading: String, text: String, button_text: String, then: Callable) -> void:
	var rows := _begin(heading)
	_add_label(rows, text, 18, DemoPalette.TEXT)
	_add_button(rows, button_text, then)


## then: called with the answers by question, 1 to 5, when all are given.
func ask_ratings(condition: String, then: Callable) -> void:
	var rows := _begin("How was it?")
	var answers := {}
	var asked := questions(condition)
	var go_on := Button.new()
	for key in asked:
		_add_label(rows, QUESTIONS[key], 17, DemoPalette.TEXT)
		var line := HBoxContainer.new()
		rows.add_child(line)
		var group := ButtonGroup.new()
		for value in SCALE.size():
			var choice := Button.new()
			choice.text = SCALE[value]
			choice.toggle_mode = true
			choice.button_group = group
			choice.size_flags_horizontal = Control.SIZE_EXPAND_FILL
			choice.pressed.connect(func() -> void:
				answers[key] = value + 1
				go_on.disabled = answers.size() < asked.size())
			line.add_child(choice)
	go_on.text = "Go on"
	go_on.disabled = true
	go_on.pressed.connect(func() -> void: _go(then.bind(answers)))
	rows.add_child(go_on)


func _begin(heading: String) -> VBoxContainer:
	hide_all()
	_panel = PanelContainer.new()
	_panel.add_theme_stylebox_override("panel", preload("res://ui/panel_style.tres"))
	_panel.set_anchors_and_offsets_preset(Control.PRESET_CENTER)
	_panel.grow_horizontal = Control.GROW_DIRECTION_BOTH
	_panel.grow_vertical = Control.GROW_DIRECTION_BOTH
	add_child(_panel)
	var rows := VBoxContainer.new()
	rows.custom_minimum_size.x = WIDTH_PX
	rows.add_theme_constant_override("separation", 12)
	_panel.add_child(rows)
	_add_label(rows, heading, 28, DemoPalette.ACCENT)
	return rows


func _add_label(rows: Control, text: String, size: int, colour: Color) -> void:
	var label := Label.new()
	label.text = text
	label.autowrap_mode = TextServer.AUTOWRAP_WORD
	label.add_theme_font_size_override("font_size", size)
	label.add_theme_color_override("font_color", colour)
	rows.add_child(label)


func _add_button(rows: Control, text: String, then: Callable) -> void:
	var button := Button.new()
	button.text = text
	button.pressed.connect(func() -> void: _go(then))
	rows.add_child(button)
	button.grab_focus()


func _go(then: Callable) -> void:
	hide_all()
	then.call()
