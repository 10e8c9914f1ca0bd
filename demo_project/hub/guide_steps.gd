extends RefCounted
## What a newcomer does in the guided start, one step after the other, and whether it has been done. It looks at the device
## alone, so it is the same for a mouse and for a real grip.

enum Step { MOVE, CLOSE, LIFT, FORCES, DONE }

## The grip has been moved when it is so far from where it was at the start, in device metres.
const MOVE_M := 0.04
## The hand first comes to its place by itself, which takes so many physics ticks.
const SETTLE_TICKS := 60
## The thing has been lifted when it is so far above where it lay, in device metres.
const LIFT_M := 0.03

var step := Step.MOVE
## Of the present step, 0 to 1.
var progress := 0.0

var _spidar: SpidarG
var _hand: SpidarGHand
var _thing: RigidBody3D
var _with_forces: bool
var _ticks := 0
var _grip_start := Vector3.INF
var _thing_start := Vector3.ZERO


## with_forces: false where the settings keep the forces off; the step of the forces is then left out.
func _init(spidar: SpidarG, hand: SpidarGHand, thing: RigidBody3D, with_forces: bool) -> void:
	_spidar = spidar
	_hand = hand
	_thing = thing
	_with_forces = with_forces
	_thing_start = thing.global_position


## How many steps there are.
func count() -> int:
	return Step.DONE - (0 if _with_forces else 1)


## Call once a physics tick. Returns whether a step has just been done.
func watch() -> bool:
	if step == Step.DONE:
		return false
	_ticks += 1
	if _ticks < SETTLE_TICKS:
		return false
	progress = clampf(_done_of(step), 0.0, 1.0)
	if progress < 1.0:
		return false
	step = (step + 1) as Step
	if step == Step.FORCES and not _with_forces:
		step = Step.DONE
	progress = 0.0
	return true


func _done_of(which: Step) -> float:
	match which:
		Step.MOVE:
			var grip := _spidar.get_grip_transform().origin
			if not _grip_start.is_finite():
				_grip_start = grip
			return grip.distance_to(_grip_start) / (MOVE_M * _spidar.workspace_scale)
		Step.CLOSE:
			if _spidar.get_grasp_phase() == SpidarG.GRASP_GRASPED or _hand.get_held_body() != null:
				return 1.0
			return minf(_spidar.get_grasp_angle() / _spidar.get_effective_config().grasp_enter_angle, 0.99)
		Step.LIFT:
			if _hand.get_held_body() != _thing:
				return 0.0
			return (_thing.global_position.y - _thing_start.y) / (LIFT_M * _spidar.workspace_scale)
		Step.FORCES:
			return 1.0 if _spidar.get_state() == SpidarG.STATE_ACTIVE else (0.5 if _spidar.forces_enabled else 0.0)
	return 0.0
