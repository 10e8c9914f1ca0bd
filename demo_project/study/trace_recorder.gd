extends RefCounted
## Pose, grasp and given wrench of one trial, in the session's trace.csv when the trial is over. Rows come at the game's
## own rate, 60 a second: what is faster is not known to a game.

const Trial := preload("res://study/trial.gd")

var rows: Array[Dictionary] = []


func sample(trial: Trial, head: Dictionary) -> void:
	var held := trial.tool_hand.get_held_body()
	var grip := trial.spidar.get_grip_transform()
	var turn := grip.basis.get_rotation_quaternion()
	var given := trial.spidar.get_achieved_wrench()
	var row := head.duplicate()
	row.merge({
		"time_s": trial.logger.task_time_s,
		"x_m": grip.origin.x, "y_m": grip.origin.y, "z_m": grip.origin.z,
		"qx": turn.x, "qy": turn.y, "qz": turn.z, "qw": turn.w,
		"grasp_angle_rad": trial.spidar.get_grasp_angle(),
		"fx_n": given[0], "fy_n": given[1], "fz_n": given[2],
		"mx_nm": given[3], "my_nm": given[4], "mz_nm": given[5], "grasp_torque_nm": given[6],
		"held": "" if held == null else String(held.name),
	})
	rows.append(row)
