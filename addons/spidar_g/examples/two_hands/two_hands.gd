extends Node3D
## Moves the right hand, which holds its end of the bar and sways. Take the other end with the left hand, and feel it.

const SWAY_M := Vector3(0.0, 0.012, 0.0)
const PERIOD_S: float = 4.0
const SQUEEZE_RAD: float = 1.2

var _time_s: float = 0.0

@onready var _right: SpidarG = $Right
@onready var _end: Vector3 = $Bar/RightEnd.global_position


func _physics_process(delta: float) -> void:
	_time_s += delta
	var closed: float = clampf(_time_s - 1.5, 0.0, 1.0) # when its forces are on
	var sway: Vector3 = SWAY_M * (1.0 - cos(TAU * maxf(_time_s - 3.0, 0.0) / PERIOD_S))
	_right.set_simulated_hand_target(Transform3D(_right.global_basis, _end + sway), SQUEEZE_RAD * closed)
