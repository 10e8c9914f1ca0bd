extends CanvasLayer
## Texts and questionnaires between the trials.

const RatingRow := preload("res://study/rating_row.gd")
const ROW := preload("res://study/rating_row.tscn")

const QUESTIONS: Dictionary[String, String] = {
	"grasp": "Grasping things",
	"translation": "Moving things",
	"rotation": "Turning things",
	"overall": "Overall",
	"against_mouse": "Compared with a mouse",
}

## What the button does.
var _then := Callable()

@onready var _panel: Control = $Panel
@onready var _heading: Label = $Panel/Rows/Heading
@onready var _text: Label = $Panel/Rows/Text
@onready var _questions: Control = $Panel/Rows/Questions
@onready var _button: Button = $Panel/Rows/Button


func _ready() -> void:
	_button.pressed.connect(_go_on)
	hide_all()


## Keys of the questions that this condition is asked.
static func questions(condition: String) -> PackedStringArray:
	var keys := PackedStringArray(QUESTIONS.keys())
	if condition.begins_with("mouse"):
		keys.remove_at(keys.find("against_mouse"))
	return keys


func hide_all() -> void:
	_panel.hide()


func show_text(heading: String, text: String, button_text: String, then: Callable) -> void:
	_begin(heading, button_text, then)
	_text.text = text
	_text.show()
	_questions.hide()
	_button.disabled = false
	_button.grab_focus()


## then: called with the answers by question, 1 to 5, when all are given.
func ask_ratings(condition: String, then: Callable) -> void:
	var answers := {}
	_begin("How was it?", "Go on", then.bind(answers))
	_text.hide()
	_questions.show()
	_button.release_focus()
	_button.disabled = true
	var asked := questions(condition)
	for key in asked:
		var row: RatingRow = ROW.instantiate()
		_questions.add_child(row)
		row.ask(QUESTIONS[key])
		row.rated.connect(func(value: int) -> void:
			answers[key] = value
			_button.disabled = answers.size() < asked.size())


func _begin(heading: String, button_text: String, then: Callable) -> void:
	for row in _questions.get_children():
		_questions.remove_child(row)
		row.queue_free()
	_heading.text = heading
	_button.text = button_text
	_then = then
	_panel.show()
	_panel.reset_size()


func _go_on() -> void:
	hide_all()
	_then.call()
