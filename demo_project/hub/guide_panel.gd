extends CanvasLayer
## The text of the present step of the guided start, and the buttons to skip the steps and to turn the forces on.

const GuideSteps := preload("res://hub/guide_steps.gd")
const KeyNames := preload("res://ui/key_names.gd")
const TextSize := preload("res://ui/text_size.gd")

signal skipped
signal forces_wanted

## At a text size of 100 %; twice as large text makes the panel wider by two fifths.
const WIDTH_PX := 320.0
const MARGIN_PX := 20.0
## What a mouse user reads, and what a user of a real grip reads, in the order of the steps. Keys of the translation.
const MOUSE_TEXTS: PackedStringArray = [
	"GUIDE_MOVE_MOUSE", "GUIDE_CLOSE_MOUSE", "GUIDE_LIFT_MOUSE", "GUIDE_FORCES", "GUIDE_DONE",
]
const GRIP_TEXTS: PackedStringArray = [
	"GUIDE_MOVE_GRIP", "GUIDE_CLOSE_GRIP", "GUIDE_LIFT_GRIP", "GUIDE_FORCES", "GUIDE_DONE",
]

@onready var _box: Control = $Panel
@onready var _heading: Label = $Panel/Rows/Heading
@onready var _text: Label = $Panel/Rows/Text
@onready var _progress: ProgressBar = $Panel/Rows/Progress
@onready var _forces: Button = $Panel/Rows/Forces
@onready var _skip: Button = $Panel/Rows/Skip


func _ready() -> void:
	_skip.pressed.connect(skipped.emit)
	_forces.pressed.connect(forces_wanted.emit)
	_forces.text = KeyNames.fill(tr("GUIDE_FORCES_BUTTON"))


## percent: one of TextSize.CHOICES_PERCENT.
func set_text_percent(percent: int) -> void:
	TextSize.apply(_box, percent)
	_text.custom_minimum_size.x = WIDTH_PX * (0.6 + 0.4 * percent / 100.0)


func width_px() -> float:
	return _box.get_combined_minimum_size().x + MARGIN_PX


func panels() -> Array[Control]:
	var shown: Array[Control] = []
	if _box.is_visible_in_tree():
		shown.append(_box)
	return shown


## count: how many steps there are. by_mouse: whether the mouse moves the hand.
func show_step(step: GuideSteps.Step, count: int, by_mouse: bool) -> void:
	var done := step == GuideSteps.Step.DONE
	_heading.text = tr("GUIDE_TITLE_DONE") if done else tr("GUIDE_TITLE") % [step + 1, count]
	_text.text = KeyNames.fill(tr(MOUSE_TEXTS[step] if by_mouse else GRIP_TEXTS[step]))
	_progress.visible = not done
	_forces.visible = step == GuideSteps.Step.FORCES
	_skip.text = KeyNames.fill(tr("GUIDE_TO_MENU" if done else "GUIDE_SKIP"))
	(_forces if _forces.visible else _skip).grab_focus()


## share: of the present step, 0 to 1.
func show_progress(share: float) -> void:
	_progress.value = share


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_action_pressed(&"demo_skip"):
		get_viewport().set_input_as_handled()
		skipped.emit()
