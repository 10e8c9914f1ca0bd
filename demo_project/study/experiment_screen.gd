extends CanvasLayer
## Texts and questionnaires between the trials.

const RatingRow := preload("res://study/rating_row.gd")
const ROW := preload("res://study/rating_row.tscn")
const TextSize := preload("res://ui/text_size.gd")

## At a text size of 100 %; twice as large text makes the panel wider by four fifths.
const WIDTH_PX := 640.0
## By column of ratings.csv: keys of the translation.
const QUESTIONS: Dictionary[String, String] = {
	"grasp": "ASK_GRASP",
	"translation": "ASK_TRANSLATION",
	"rotation": "ASK_ROTATION",
	"overall": "ASK_OVERALL",
	"against_mouse": "ASK_AGAINST_MOUSE",
}

## One of TextSize.CHOICES_PERCENT.
var text_percent := 100

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
	_fit()
	_button.grab_focus()


## then: called with the answers by question, 1 to 5, when all are given.
func ask_ratings(condition: String, then: Callable) -> void:
	var answers := {}
	_begin("ASK_TITLE", "GO_ON", then.bind(answers))
	_text.hide()
	_questions.show()
	_button.disabled = true
	var asked := questions(condition)
	for key in asked:
		var row: RatingRow = ROW.instantiate()
		_questions.add_child(row)
		row.ask(QUESTIONS[key])
		row.rated.connect(func(value: int) -> void:
			answers[key] = value
			_button.disabled = answers.size() < asked.size())
	_fit()
	(_questions.get_child(0) as RatingRow).take_focus()


func _begin(heading: String, button_text: String, then: Callable) -> void:
	for row in _questions.get_children():
		_questions.remove_child(row)
		row.queue_free()
	_heading.text = heading
	_button.text = button_text
	_then = then
	_panel.show()


func _fit() -> void:
	TextSize.apply(_panel, text_percent)
	($Panel/Rows as Control).custom_minimum_size.x = WIDTH_PX * (0.2 + 0.8 * text_percent / 100.0)


func _go_on() -> void:
	hide_all()
	_then.call()
