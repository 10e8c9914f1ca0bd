extends SpidarGMouseHand
## The add-on's mouse hand, with what is the demo's alone: it can move the hand of a board's model, leave the mouse to the
## auto-animation, and leave the arrow keys to a menu.

const ModelHand := preload("res://play/model_hand.gd")

## In place of the simulated device's own hand; null: that one.
var model: ModelHand:
	set(value):
		model = value
		_update_acting()
## The mouse chooses, it does not move the grip: see AutoAnimator.
var clicks_only := false


func _has_hand() -> bool:
	return model != null or super()


func _aim(target: Transform3D, grasp_angle: float) -> void:
	if model == null:
		super(target, grasp_angle)
	else:
		model.aim(spidar, target, grasp_angle)


## While a button has the focus, the arrow keys move the focus and do not turn the grip.
func _move_by_keys(delta: float) -> void:
	var turn := turn_rad
	super(delta)
	if get_viewport().gui_get_focus_owner() != null:
		turn_rad = turn


func _unhandled_input(event: InputEvent) -> void:
	if not clicks_only:
		super(event)
