extends VBoxContainer
## One question of a questionnaire, with the paper's scale of five (Table 3).

signal rated(value: int)


func _ready() -> void:
	for index in $Scale.get_child_count():
		($Scale.get_child(index) as Button).pressed.connect(rated.emit.bind(index + 1))


func ask(question: String) -> void:
	($Question as Label).text = question


func take_focus() -> void:
	($Scale/Choice1 as Control).grab_focus()
