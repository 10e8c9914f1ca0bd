class_name PickAndPlacePlayer
extends Node
## Plays the task with the scripted hand, from what a player sees (poses of grip and objects) and feels
## (the strings' wrench on the hand). It moves nothing but the simulated hand.

const MAX_ATTEMPTS := 3
## Fingers open this much wider than the object before they go down.
const CLEARANCE_M := 0.014
## High and slow enough that surfaces passed on the way, which the device knows a frame or two late, are not brushed.
const TRAVEL_ABOVE_TABLE_M := 0.130
const REACH_S := 1.1
const DESCEND_S := 0.6
const LOWER_S := 0.8
const SETTLE_TOLERANCE_M := 0.001
const SETTLE_S := 0.6
## Hefting: slowly up and down again this far. The strings' friction pulls down on the way up and up on
## the way down, so the mean of both is the weight alone.
const HEFT_M := 0.012
## Objects are hefted nearer to the middle, where the strings pull best: this share of the way out.
const HEFT_PLACE := 0.6
const HEFT_S := 0.6
const CLOSE_RAD_S := deg_to_rad(25.0)
## The hand never aims past this angle; it squeezes by aiming past the object's width.
const AIM_LIMIT_RAD := deg_to_rad(85.0)
const GRASP_LIMIT_RAD := deg_to_rad(53.0)
const HOLD_SQUEEZE_NM := 0.030
const HOLD_PATIENCE_S := 0.5
const RELEASE_GAP_M := 0.001
## What lies further from the table's middle, or lower than its top, is out of reach.
const REACH_M := 0.20

var spidar: SpidarG
var tool_hand: SpidarGHand
var hand: ScriptedHand
var objects: Array[TaskObject] = []
var table_height_m := 0.0
var records: Dictionary[TaskObject, FeltRecord] = {}
var pictures: PictureTaker
var camera_rig: CameraRig


## Coroutine: returns when every object was placed or given up.
func play() -> void:
	spidar.set_simulated_hand_firmness(SpidarG.HAND_FIRM)
	for object in objects:
		records[object] = FeltRecord.new()
	# Nobody waits for a picture: the play is the same with pictures and without.
	pictures.take("start")
	for object in objects:
		while object.attempts < MAX_ATTEMPTS and _worth_trying(object):
			object.attempts += 1
			if await _pick(object):
				await _place(object)
			await _rise()


func _worth_trying(object: TaskObject) -> bool:
	var from_middle := spidar.to_local(object.global_position)
	var on_table := object.global_position.y > table_height_m
	var near := maxf(absf(from_middle.x), absf(from_middle.z)) < REACH_M
	return not object.placed and not hand.stopped and on_table and near


func _pick(object: TaskObject) -> bool:
	var width_m := object.spec.size_m.x
	var open_rad := _angle_for(width_m + CLEARANCE_M)
	await hand.turn_grasp_to(open_rad, 0.2)
	await hand.move_to(_at_travel_height(_pick_pose(object)), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	await hand.move_to(_pick_pose(object), DESCEND_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	var held := await _close_on(object)
	if not held:
		await hand.turn_grasp_to(open_rad, 0.3)
		return false
	if object == objects[0]:
		_take_pictures("grasp")
	await hand.move_to(_at_travel_height(hand.wanted), REACH_S)
	await hand.move_to(_heft_pose(), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if tool_hand.get_held_body() != object:
		return false
	await _weigh(object)
	return true


## Closes until the object holds, and records the width felt on the way.
func _close_on(object: TaskObject) -> bool:
	var sense := WidthSense.new()
	var patience_s := HOLD_PATIENCE_S
	var tick_s := 1.0 / Engine.physics_ticks_per_second
	var held := false
	while patience_s > 0.0 and not hand.stopped:
		var truth := spidar.get_simulated_truth()
		var angle_rad: float = truth["grasp_angle"]
		var strings: PackedFloat64Array = truth["strings_wrench"]
		sense.add(angle_rad, -strings[6])
		held = tool_hand.get_held_body() == object
		if held and sense.push_nm() >= HOLD_SQUEEZE_NM:
			break
		var at_limit := angle_rad >= GRASP_LIMIT_RAD or hand.grasp_angle_rad >= AIM_LIMIT_RAD
		if held or at_limit:
			patience_s -= tick_s
		await hand.nudge_grasp(0.0 if at_limit else CLOSE_RAD_S * tick_s)
	var record := records[object]
	record.width_expected_m = object.spec.size_m.x
	record.width_felt_m = _gap_for(sense.touch_angle_rad())
	record.squeeze_torque_nm = sense.push_nm()
	return held


## Hefts the object: the mean pull over one stroke up and one down.
func _weigh(object: TaskObject) -> void:
	var low := hand.wanted
	var high := low.translated(Vector3.UP * HEFT_M)
	var pulls := PackedFloat64Array()
	var feel := func() -> void:
		var strings: PackedFloat64Array = spidar.get_simulated_truth()["strings_wrench"]
		pulls.append(-strings[1])
	hand.stepped.connect(feel)
	await hand.move_to(high, HEFT_S)
	await hand.move_to(low, HEFT_S)
	hand.stepped.disconnect(feel)
	var sum := 0.0
	for pull in pulls:
		sum += pull
	var record := records[object]
	record.weight_expected_n = (
		object.mass * float(ProjectSettings.get_setting("physics/3d/default_gravity"))
	)
	record.weight_felt_n = sum / maxi(pulls.size(), 1)


func _place(object: TaskObject) -> void:
	# As seen now: how the object lies in the fingers decides where the grip has to go.
	var object_in_grip := spidar.get_grip_transform().affine_inverse() * object.global_transform
	var goal := object.target.goal() * object_in_grip.affine_inverse()
	goal = Transform3D(goal.basis.orthonormalized(), goal.origin + Vector3.UP * RELEASE_GAP_M)
	await hand.move_to(_at_travel_height(goal), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if object == objects[1]:
		_take_pictures("carry")
	await hand.move_to(goal, LOWER_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	await hand.turn_grasp_to(_angle_for(object.spec.size_m.x + CLEARANCE_M), 0.4)
	await hand.wait(0.1)


## The whole table, then the grip from near by.
func _take_pictures(picture_name: String) -> void:
	await pictures.take(picture_name)
	camera_rig.look_closely(spidar.get_grip_transform().origin)
	await pictures.take(picture_name + "_close")
	camera_rig.look_at_all()


func _rise() -> void:
	await hand.move_to(_at_travel_height(hand.wanted), DESCEND_S)


## Grip pose to pick this object: upright, turned with the object, at the height of its top part.
func _pick_pose(object: TaskObject) -> Transform3D:
	var across := object.global_basis.x
	var yaw := atan2(-across.z, across.x)
	if object.spec.is_round():
		yaw = 0.0
	elif absf(yaw) > PI * 0.5:
		yaw -= signf(yaw) * PI
	return Transform3D(
		Basis(Vector3.UP, yaw),
		object.global_position + Vector3.UP * object.spec.grasp_above_centre_m
	)


func _heft_pose() -> Transform3D:
	var place := spidar.to_local(hand.wanted.origin)
	place *= Vector3(HEFT_PLACE, 1.0, HEFT_PLACE)
	return Transform3D(spidar.global_basis.orthonormalized(), spidar.to_global(place))


func _at_travel_height(pose: Transform3D) -> Transform3D:
	var raised := pose
	raised.origin.y = table_height_m + TRAVEL_ABOVE_TABLE_M
	return raised


func _angle_for(width_m: float) -> float:
	return maxf(spidar.get_grasp_angle_for_gap(width_m / spidar.workspace_scale), 0.0)


## Inverse of _angle_for: the jaw's gap is linear in the angle.
func _gap_for(angle_rad: float) -> float:
	var at_zero := spidar.get_grasp_angle_for_gap(0.0)
	var at_unit := spidar.get_grasp_angle_for_gap(0.01)
	return 0.01 * (at_zero - angle_rad) / (at_zero - at_unit) * spidar.workspace_scale
