extends "res://play/task_player.gd"
## Plays a task of linking: carries each part in front of its seat, feels it snap in, pulls at it to feel the detent
## and, where asked for, pulls it off once and puts it back.

const FitLine := preload("res://play/fit_line.gd")
const SeatSense := preload("res://play/seat_sense.gd")

## In front of the seat, along the way in.
const BEFORE_M := 0.030
const PUSH_IN_S := 0.8
const LATCH_PATIENCE_S := 1.2
## Pulled out this far and back to feel the spring.
const TUG_M := 0.008
const TUG_S := 0.7
## Where friction has turned with the way: this share of it.
const TUG_FROM := 0.25
const TUG_TO := 0.75
## A tick in which the grip is drawn less than this far (device metres) tells nothing of the spring.
const TUG_MOVES_M := 0.00005
## Further than the release distance.
const TEAR_M := 0.022
const TEAR_S := 0.9

var seats := SeatSense.new()
var _torn_at_n := NAN
var _felt_max_n := 0.0


func _deliver(body: TaskBody) -> void:
	seats.spidar = spidar
	seats.hand = tool_hand
	if not await _push_in(body):
		await _let_go(body)
		return
	if body.felt.checks_detent:
		await _feel_detent(body)
	if body.felt.checks_release and is_nan(body.felt.release_felt_n):
		await _tear_off(body)
		await _push_in(body)
	if body == bodies[mini(1, bodies.size() - 1)]:
		_take_pictures("linked")
	await _let_go(body)


## From above or from the front into the seat; true when it has snapped in.
func _push_in(body: TaskBody) -> bool:
	var before := _grip_for(body, _before(body))
	# From near by, just pulled off, straight back: the way round would lead past what it came off.
	if hand.wanted.origin.distance_to(before.origin) > 1.5 * BEFORE_M:
		await hand.move_to(_over(before, body), REACH_S)
		await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	await hand.move_to(before, LOWER_S)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	if body == bodies[mini(1, bodies.size() - 1)] and body.attempts == 1:
		_take_pictures("carry")
	await hand.move_to(_grip_for(body, body.goal()), PUSH_IN_S)
	var left_s := LATCH_PATIENCE_S
	while seats.linked_count() < _needed(body) and left_s > 0.0 and not hand.stopped:
		left_s -= 1.0 / Engine.physics_ticks_per_second
		await hand.nudge_grasp(0.0)
	return seats.linked_count() >= _needed(body)


## How many sockets have to snap in: as many as find a mate there.
func _needed(body: TaskBody) -> int:
	return seats.mates_at(body, body.goal())


## Pose of the body before the last, straight part of its way.
func _before(body: TaskBody) -> Transform3D:
	return body.goal().translated(_way_out(body) * BEFORE_M)


## The way out of the seat, world.
func _way_out(body: TaskBody) -> Vector3:
	if body.approach_m.is_zero_approx():
		return Vector3.UP
	return (body.goal().basis * body.approach_m).normalized()


func _over(pose: Transform3D, body: TaskBody) -> Transform3D:
	var raised := pose
	raised.origin.y = maxf(raised.origin.y, table_height_m + body.travel_m)
	return raised


## Out and back: the pull's slope against the way is the spring; the strings' friction changes its sign with the way.
func _feel_detent(body: TaskBody) -> void:
	var out := _way_out(body)
	var seat := hand.wanted
	var lines: Array[FitLine] = [FitLine.new(), FitLine.new()]
	# The hand rises a little when the seat takes the weight: the way counts from where it begins.
	var begins := out.dot(seats.stretch_m())
	for back in 2:
		var last: Array[float] = [NAN]
		var feel := func() -> void:
			var truth := hand.truth()
			var strings: PackedFloat64Array = truth["strings_wrench"]
			var pull := -out.dot(Vector3(strings[0], strings[1], strings[2]))
			var way := out.dot(seats.stretch_m()) - begins
			# Where the strings' friction holds the grip, at the turn, the pull changes and the way does not.
			var moves := absf(way - last[0]) > TUG_MOVES_M
			last[0] = way
			if moves and way > TUG_FROM * TUG_M and way < TUG_TO * TUG_M:
				lines[back].add(way, pull)
		hand.stepped.connect(feel)
		await hand.move_to(seat.translated(out * TUG_M) if back == 0 else seat, TUG_S)
		hand.stepped.disconnect(feel)
	body.felt.detent_expected_n_m = SeatSense.of(body)[0].stiffness
	body.felt.detent_felt_n_m = 0.5 * (lines[0].slope() + lines[1].slope())


## Pulls it off: the greatest pull felt before it lets go.
func _tear_off(body: TaskBody) -> void:
	var out := _way_out(body)
	_torn_at_n = NAN
	_felt_max_n = 0.0
	var feel := func() -> void:
		var strings: PackedFloat64Array = hand.truth()["strings_wrench"]
		_felt_max_n = maxf(_felt_max_n, Vector3(strings[0], strings[1], strings[2]).length())
	var torn := func(_mate: SpidarGSocket, _pull_n: float) -> void: _torn_at_n = _felt_max_n
	for socket in SeatSense.of(body):
		socket.unlinked.connect(torn)
	hand.stepped.connect(feel)
	await hand.move_to(hand.wanted.translated(out * TEAR_M), TEAR_S)
	hand.stepped.disconnect(feel)
	for socket in SeatSense.of(body):
		socket.unlinked.disconnect(torn)
	await hand.settle(SETTLE_TOLERANCE_M, SETTLE_S)
	body.felt.release_expected_n = SeatSense.of(body)[0].release_force
	body.felt.release_felt_n = _torn_at_n
