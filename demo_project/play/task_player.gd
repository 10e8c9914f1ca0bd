extends Node
## Plays a task with the scripted hand, from what a player sees (poses of grip and bodies) and feels
## (the strings' wrench on the hand). It moves nothing but the simulated hand. A task of its own adds _deliver.

const CameraRig := preload("res://scene/camera_rig.gd")
const PenetrationMeter := preload("res://play/penetration_meter.gd")
const PictureTaker := preload("res://play/picture_taker.gd")
const ScriptedHand := preload("res://play/scripted_hand.gd")
const TaskBody := preload("res://scene/task_body.gd")
const WidthSense := preload("res://play/width_sense.gd")

const MAX_ATTEMPTS := 3
## Fingers open this much wider than the body before they go down.
const CLEARANCE_M := 0.014
const REACH_S := 1.1
const DESCEND_S := 0.6
const LOWER_S := 0.8
const SETTLE_TOLERANCE_M := 0.001
const SETTLE_S := 0.6
## Hefting: slowly up and down again this far. The strings' friction pulls down on the way up and up on
## the way down, so the mean of both is the weight alone.
const HEFT_M := 0.012
## Bodies are hefted nearer to the middle, where the strings pull best: this share of the way out.
const HEFT_PLACE := 0.6
const HEFT_S := 0.6
## Of a stroke, left out at each end.
const HEFT_FROM := 0.25
## The held body is watched for this long in the still hand.
const WATCH_S := 0.3
const STILL_S := 0.6
const CLOSE_RAD_S := deg_to_rad(25.0)
## The hand never aims past this angle; it squeezes by aiming past the body's width.
const AIM_LIMIT_RAD := deg_to_rad(85.0)
const GRASP_LIMIT_RAD := deg_to_rad(53.0)
const HOLD_PATIENCE_S := 0.5
const RELEASE_GAP_M := 0.001
## What lies further from the table's middle, or lower than its top, is out of reach.
const REACH_M := 0.20

var spidar: SpidarG
var tool_hand: SpidarGHand
var view: SpidarGView
var hand: ScriptedHand
var bodies: Array[TaskBody] = []
var table_height_m := 0.0
var pictures: PictureTaker
var camera_rig: CameraRig
var penetration := PenetrationMeter.new()
## Coroutine, before each attempt: brings the device back to where it can be felt. Not valid: it always can.
var be_ready := Callable()
## Enough to hold the heaviest, with pads that do not slip.
var hold_squeeze_nm := 0.030
## Fingers open this much before they leave.
var let_go_m := CLEARANCE_M


## Coroutine: returns when every body was placed or given up.
func play() -> void:
	hand.set_firmness(SpidarG.HAND_FIRM)
	view.get_tree().process_frame.connect(func() -> void: penetration.note_drawn(tool_hand))
	hand.stepped.connect(func() -> void: penetration.measure(tool_hand, view))
	# Nobody waits for a picture: the play is the same with pictures and without.
	pictures.take("start")
	for body in order():
		while body.attempts < MAX_ATTEMPTS and _worth_trying(body):
			if be_ready.is_valid():
				await be_ready.call()
			body.attempts += 1
			if await _pick(body):
				await _deliver(body)
			await _rise(body)


## What went wrong in the play, beside what is checked of each thing; empty: nothing.
func verdict() -> String:
	return ""


## The order in which the bodies are taken.
func order() -> Array[TaskBody]:
	return bodies


## Coroutine: the held body goes where it belongs, and the fingers leave it.
func _deliver(body: TaskBody) -> void:
	var goal := _grip_for(body, body.goal())
	goal.origin += Vector3.UP * RELEASE_GAP_M
	await hand.move_to(_at_travel_height(goal, body), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if body == bodies[mini(1, bodies.size() - 1)]:
		_take_pictures("carry")
	await hand.move_to(goal, LOWER_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	await _let_go(body)


func _worth_trying(body: TaskBody) -> bool:
	var from_middle := spidar.to_local(body.global_position)
	var on_table := body.global_position.y > table_height_m
	var near := maxf(absf(from_middle.x), absf(from_middle.z)) < REACH_M
	return not body.placed and not hand.stopped and on_table and near


func _pick(body: TaskBody) -> bool:
	if not await take(body):
		return false
	await hand.move_to(_heft_pose(), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if tool_hand.get_held_body() != body:
		return false
	await _watch(body)
	await _weigh(body)
	return tool_hand.get_held_body() == body


## Coroutine: reaches for the body, closes on it and lifts it. False when it is not held.
func take(body: TaskBody) -> bool:
	var open_rad := angle_for(body.width_m + CLEARANCE_M)
	await hand.turn_grasp_to(open_rad, 0.2)
	await hand.move_to(_at_travel_height(_pick_pose(body, true), body), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if not body.approach_m.is_zero_approx():
		await hand.move_to(_pick_pose(body, true), DESCEND_S)
	await hand.move_to(_pick_pose(body, false), DESCEND_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	var held := await _close_on(body)
	if not held:
		await hand.turn_grasp_to(open_rad, 0.3)
		return false
	if body == bodies[0]:
		_take_pictures("grasp")
	await hand.move_to(_at_travel_height(hand.wanted, body), REACH_S)
	return tool_hand.get_held_body() == body


## Coroutine: carries the held body where it belongs, lets go and rises.
func bring(body: TaskBody) -> void:
	await _deliver(body)
	await _rise(body)


## World position of the target of `body` that a click at `at` (screen) would mean.
func target_of(body: TaskBody, _at: Vector2, _camera: Camera3D) -> Vector3:
	return body.goal().origin


## Closes until the body holds, and records the width felt on the way.
func _close_on(body: TaskBody) -> bool:
	var sense := WidthSense.new()
	var patience_s := HOLD_PATIENCE_S
	var tick_s := 1.0 / Engine.physics_ticks_per_second
	var held := false
	while patience_s > 0.0 and not hand.stopped:
		var truth := hand.truth()
		var angle_rad: float = truth["grasp_angle"]
		var strings: PackedFloat64Array = truth["strings_wrench"]
		sense.add(angle_rad, -strings[6])
		held = tool_hand.get_held_body() == body
		if held and sense.push_nm() >= hold_squeeze_nm:
			break
		var at_limit := angle_rad >= GRASP_LIMIT_RAD or hand.grasp_angle_rad >= AIM_LIMIT_RAD
		if held or at_limit:
			patience_s -= tick_s
		await hand.nudge_grasp(0.0 if at_limit else CLOSE_RAD_S * tick_s)
	body.felt.width_expected_m = body.width_m
	body.felt.width_felt_m = _gap_for(sense.touch_angle_rad())
	body.felt.squeeze_torque_nm = sense.push_nm()
	return held


## How far the body moves in the still hand, peak to peak, and how far the fingers are closed on it.
func _watch(body: TaskBody) -> void:
	await hand.wait(STILL_S)
	var seen := AABB(body.global_position, Vector3.ZERO)
	var left_s := WATCH_S
	while left_s > 0.0 and not hand.stopped:
		left_s -= 1.0 / Engine.physics_ticks_per_second
		await hand.nudge_grasp(0.0)
		seen = seen.expand(body.global_position)
	body.felt.jitter_m = seen.size.length()
	body.felt.grasp_angle_rad = spidar.get_grasp_angle()


## Hefts the body: the mean pull over the middle of a stroke up and of one down. At the ends of a stroke the strings'
## friction still holds from the stroke before.
func _weigh(body: TaskBody) -> void:
	var low := hand.wanted
	var high := low.translated(Vector3.UP * HEFT_M)
	var means := PackedFloat64Array()
	for stroke in 2:
		var pulls := PackedFloat64Array()
		var feel := func() -> void:
			var risen := spidar.get_grip_transform().origin.y - low.origin.y
			if risen > HEFT_FROM * HEFT_M and risen < (1.0 - HEFT_FROM) * HEFT_M:
				var strings: PackedFloat64Array = hand.truth()["strings_wrench"]
				pulls.append(-strings[1])
		hand.stepped.connect(feel)
		await hand.move_to(high if stroke == 0 else low, HEFT_S)
		hand.stepped.disconnect(feel)
		var sum := 0.0
		for pull in pulls:
			sum += pull
		means.append(sum / pulls.size() if not pulls.is_empty() else NAN)
	body.felt.weight_expected_n = (
		body.mass * float(ProjectSettings.get_setting("physics/3d/default_gravity"))
	)
	body.felt.weight_felt_n = 0.5 * (means[0] + means[1])


## Opens, and goes back the way it came in.
func _let_go(body: TaskBody) -> void:
	await hand.turn_grasp_to(angle_for(body.width_m + let_go_m), 0.4)
	await hand.wait(0.1)
	if not body.approach_m.is_zero_approx():
		await hand.move_to(hand.wanted.translated_local(body.approach_m), DESCEND_S)


## The whole table, then the grip from near by.
func _take_pictures(picture_name: String) -> void:
	if pictures.folder == "":
		return
	await pictures.take(picture_name)
	camera_rig.look_closely(spidar.get_grip_transform().origin)
	await pictures.take(picture_name + "_close")
	camera_rig.look_at_all()


func _rise(body: TaskBody) -> void:
	await hand.move_to(_at_travel_height(hand.wanted, body), DESCEND_S)


## Where the grip has to go for the held body to be at `pose`: as seen now, how the body lies in the fingers decides.
func _grip_for(body: TaskBody, pose: Transform3D) -> Transform3D:
	var body_in_grip := spidar.get_grip_transform().affine_inverse() * body.global_transform
	var grip := pose * body_in_grip.affine_inverse()
	return Transform3D(grip.basis.orthonormalized(), grip.origin)


## Grip pose to pick this body, upright and turned with it; `before`: from where the fingers come in.
func _pick_pose(body: TaskBody, before: bool) -> Transform3D:
	var pose := Transform3D(_pick_basis(body), body.to_global(body.grasp_offset_m))
	return pose.translated_local(body.approach_m) if before else pose


func _pick_basis(body: TaskBody) -> Basis:
	var across := body.global_basis.x
	var yaw := atan2(-across.z, across.x)
	if body.is_round():
		yaw = 0.0
	elif absf(yaw) > PI * 0.5:
		yaw -= signf(yaw) * PI
	return Basis(Vector3.UP, yaw)


func _heft_pose() -> Transform3D:
	var place := spidar.to_local(hand.wanted.origin)
	place *= Vector3(HEFT_PLACE, 1.0, HEFT_PLACE)
	return Transform3D(spidar.global_basis.orthonormalized(), spidar.to_global(place))


## High and slow enough that surfaces passed on the way, which the device knows a frame or two late, are not brushed.
func _at_travel_height(pose: Transform3D, body: TaskBody) -> Transform3D:
	var raised := pose
	raised.origin.y = table_height_m + body.travel_m
	return raised


func angle_for(width_m: float) -> float:
	return maxf(spidar.get_grasp_angle_for_gap(width_m / spidar.workspace_scale), 0.0)


## Inverse of angle_for: the jaw's gap is linear in the angle.
func _gap_for(angle_rad: float) -> float:
	var at_zero := spidar.get_grasp_angle_for_gap(0.0)
	var at_unit := spidar.get_grasp_angle_for_gap(0.01)
	return 0.01 * (at_zero - angle_rad) / (at_zero - at_unit) * spidar.workspace_scale
