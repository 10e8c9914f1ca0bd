extends "res://play/link_player.gd"
## Builds the robot by script: the torso first where it is loose, then the limbs as the layout shuffled them.

## Parts are weighed before the robot, not above it.
const HEFT_PLACE_M := Vector3(0.030, 0.115, 0.030)

func _init() -> void:
	let_go_m = 0.006
	hold_squeeze_nm = 0.025


func _heft_pose() -> Transform3D:
	var side := signf(spidar.to_local(hand.wanted.origin).x)
	var place := Vector3(HEFT_PLACE_M.x * side, 0.0, HEFT_PLACE_M.z)
	var at := spidar.to_global(place)
	at.y = table_height_m + HEFT_PLACE_M.y
	return Transform3D(spidar.global_basis.orthonormalized(), at)
