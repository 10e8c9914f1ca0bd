extends RefCounted
## Computes the inputs that a [SpidarGTracker] gives to its XR tracker: how far grip and trigger are closed, and their clicks.

const TRIGGER_AUTOMATIC: int = 0
const TRIGGER_SQUEEZE: int = 1
const TRIGGER_ACTION: int = 2


## Returns how far the grasp is closed, from 0 (open) to 1 (at [member SpidarGConfig.jaw_closed_angle]).
static func closed_part(spidar: SpidarG) -> float:
	var closed: float = spidar.get_effective_config().jaw_closed_angle
	return clampf(spidar.get_grasp_angle() / closed, 0.0, 1.0) if closed > 0.0 else 0.0


## Returns the value of the input named trigger, from 0 to 1. `source` is a SpidarGTracker.TriggerSource, and `hand` may be
## [code]null[/code]. `full_squeeze_nm` is the grasp torque, in newton meters, at which the value is 1.
static func trigger(source: int, spidar: SpidarG, hand: SpidarGHand, full_squeeze_nm: float) -> float:
	var config: SpidarGConfig = spidar.get_effective_config()
	var action: StringName = config.grasp_action
	if source == TRIGGER_AUTOMATIC:
		if config.has_rigid_grip() and InputMap.has_action(action):
			source = TRIGGER_ACTION
		elif hand != null:
			source = TRIGGER_SQUEEZE
	match source:
		TRIGGER_SQUEEZE:
			return clampf(hand.get_squeeze_torque() / full_squeeze_nm, 0.0, 1.0) if hand != null else 0.0
		TRIGGER_ACTION:
			return Input.get_action_strength(action) if InputMap.has_action(action) else 0.0
	return closed_part(spidar)


## Sets the float input named `input` to `value`, and the boolean input whose name has "_click" appended. The click is pressed
## when the value reaches `click_at`, and released when the value is below `release_below`.
static func set_with_click(
	tracker: XRControllerTracker, input: String, value: float, click_at: float, release_below: float
) -> void:
	tracker.set_input(input, value)
	var click: String = input + "_click"
	var was_down: bool = tracker.get_input(click) == true
	var least: float = minf(release_below, click_at) if was_down else click_at
	var is_down: bool = value >= least and value > 0.0
	# The tracker would report a first false as the release of a button.
	if is_down != was_down:
		tracker.set_input(click, is_down)
