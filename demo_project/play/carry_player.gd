extends "res://play/task_player.gd"
## Carries things about instead of playing the task: each is picked up, led along a seeded way with turns, shaken and put
## back where it stood. What leaves the fingers before they open is a drop without cause.

const FeltRecord := preload("res://scene/felt_record.gd")

const WAYPOINTS := 3
## Of a waypoint from the middle of the table, at most, and above the height of travel.
const WAY_M := Vector3(0.07, 0.03, 0.06)
## Fastest and slowest reach between two waypoints.
const WAY_S := Vector2(0.45, 0.9)
const TURN_RAD := deg_to_rad(15.0)
const SHAKE_M := 0.010
const SHAKE_HZ := 3.0
const SHAKE_S := 1.0
## So many things in a row that could not be taken end the play.
const MAX_MISSES := 3

var carries := 1
var seed_number := 1
## Carried to the end, and dropped without cause.
var done := 0
var dropped := 0
var _random := RandomNumberGenerator.new()
var _opening := false


func play() -> void:
	hand.set_firmness(SpidarG.HAND_FIRM)
	view.get_tree().process_frame.connect(func() -> void: penetration.note_drawn(tool_hand))
	hand.stepped.connect(func() -> void: penetration.measure(tool_hand, view))
	tool_hand.body_released.connect(func(_body: RigidBody3D) -> void: dropped += int(not _opening))
	_random.seed = seed_number
	for body in bodies: # Nothing is weighed or measured.
		body.felt = FeltRecord.new()
		body.felt.checks_weight = false
		body.felt.checks_width = false
	var misses := 0
	while done + dropped < carries and misses < MAX_MISSES and not hand.stopped:
		var body := bodies[(done + dropped + misses) % bodies.size()]
		body.attempts += 1
		var before := done + dropped
		await _carry(body)
		misses = misses + 1 if done + dropped == before else 0


func verdict() -> String:
	if done == carries and dropped == 0:
		return ""
	return "%d of %d carried to the end, %d dropped without cause" % [done, carries, dropped]


func _carry(body: TaskBody) -> void:
	var home := body.global_transform
	if not await take(body):
		await _rise(body)
		return
	for _way in WAYPOINTS:
		await hand.move_to(_anywhere(body), _random.randf_range(WAY_S.x, WAY_S.y))
	await _shake()
	if tool_hand.get_held_body() != body:
		await hand.turn_grasp_to(angle_for(body.width_m + CLEARANCE_M), 0.3)
		await _rise(body)
		return
	var goal := _grip_for(body, home)
	goal.origin += Vector3.UP * RELEASE_GAP_M
	await hand.move_to(_at_travel_height(goal, body), REACH_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	await hand.move_to(goal, LOWER_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	var held := tool_hand.get_held_body() == body
	_opening = true
	await _let_go(body)
	_opening = false
	done += int(held)
	await _rise(body)


func _anywhere(body: TaskBody) -> Transform3D:
	var middle := spidar.to_global(Vector3.ZERO)
	var at := middle + WAY_M * Vector3(_between(), 0.0, _between())
	at.y = table_height_m + body.travel_m + WAY_M.y * absf(_between())
	return Transform3D(Basis(Vector3.UP, TURN_RAD * _between()), at)


## To and fro along a way that is drawn by lot.
func _shake() -> void:
	var still := hand.wanted
	var along := Vector3(_between(), _between(), _between()).normalized()
	var elapsed_s := 0.0
	while elapsed_s < SHAKE_S and not hand.stopped:
		elapsed_s += 1.0 / Engine.physics_ticks_per_second
		await hand.follow(still.translated(along * SHAKE_M * sin(TAU * SHAKE_HZ * elapsed_s)))
	await hand.move_to(still, DESCEND_S)


func _between() -> float:
	return _random.randf_range(-1.0, 1.0)
