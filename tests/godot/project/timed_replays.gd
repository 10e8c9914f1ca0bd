## A recording of a device in its own thread repeats in the scene: grasped, lifted, placed and let go in the same physics
## ticks, the box where it was. Environment variable SPIDAR_REPLAYS: how many recordings.
extends "res://hand_scene.gd"

const PATH: String = "user://timed_replay.rec"
const RECORDINGS: int = 4
const SIZE := Vector3(0.03, 0.04, 0.03)
## Physics ticks of a play.
const TICKS: int = 150
## Drawn frames a second, in turn. A replay has another rate than its recording.
const FRAME_RATES: Array[int] = [60, 25, 144, 40]

## What happened: [tick, what]; and where the box was in each tick.
class Story:
	var events: Array = []
	var places: Array[Transform3D] = []


func test_every_replay_grasps_lifts_and_places_as_the_recording_did() -> void:
	var wanted: int = OS.get_environment("SPIDAR_REPLAYS").to_int()
	var count: int = wanted if wanted > 0 else RECORDINGS
	var alike: int = 0
	var to_the_bit: int = 0
	add_box(Vector3(1.0, 0.1, 1.0), Vector3(0.0, FLOOR_Y - 0.05, 0.0), 0.0)
	for number: int in count:
		Engine.max_fps = FRAME_RATES[number % FRAME_RATES.size()]
		var recorded: Story = await _record(number)
		var names: Array = recorded.events.map(func(event: Array) -> String: return event[1])
		check_equal(names, ["grasped", "released"], "recording %d: what happened" % number)
		check(recorded.places[-1].origin.x > 0.02, "recording %d: carried away: %s" % [number, recorded.places[-1]])
		Engine.max_fps = FRAME_RATES[(number + 1) % FRAME_RATES.size()]
		var replayed: Story = await _replay(number)
		check_equal(replayed.events, recorded.events, "replay %d: the same events in the same ticks" % number)
		alike += 1 if replayed.events == recorded.events else 0
		to_the_bit += 1 if replayed.places == recorded.places else 0
		var apart_m: float = replayed.places[-1].origin.distance_to(recorded.places[-1].origin)
		check(apart_m < 1e-4, "replay %d: the box is %.6f m from where it was" % [number, apart_m])
	print("INFO %d of %d replays with the same events, %d with the box in the same place to the bit in every tick"
		% [alike, count, to_the_bit])


func _record(number: int) -> Story:
	device = ideal_device()
	device.drive_mode = SpidarG.DRIVE_THREADED
	device.forces_enabled = true
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	at = Vector3(0.0, -0.03 + 0.0003 * number, 0.0)
	angle = 0.0
	while device.get_state() != SpidarG.STATE_ACTIVE:
		await move_to(at, 0.0, 1)
	# The fingers rest on something before, so that the device has numbered contacts already.
	var above: Vector3 = at
	await move_to(Vector3(0.1, FLOOR_Y - 0.01, 0.0), 0.0, 20)
	await move_to(above, 0.0, 20)
	await move_to(above, 0.0, 5 + number % 7)
	check(device.start_recording(PATH), "the recording starts")
	var story: Story = await _play(_move.bind(above))
	device.stop_recording()
	check_equal(device.get_recording_statistics()["lost_cycles"], 0, "nothing is lost")
	device.free()
	return story


func _replay(number: int) -> Story:
	device = ideal_device()
	device.drive_mode = SpidarG.DRIVE_THREADED
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	await physics_frames(3)
	var ends: Array = []
	device.replay_finished.connect(
		func(identical: bool, message: String) -> void: ends.append([identical, message]))
	check(device.start_replay(PATH), "the replay starts")
	var story: Story = await _play(func(_tick: int) -> void: pass)
	await physics_frames(3)
	check(ends.size() == 1 and ends[0][0], "replay %d: identical: %s" % [number, ends])
	device.free()
	return story


## The scene of a play, from the moment when the recording or the replay has started.
func _play(move: Callable) -> Story:
	var story := Story.new()
	var tick: Array[int] = [0]
	hand.body_grasped.connect(func(_body: RigidBody3D) -> void: story.events.append([tick[0], "grasped"]))
	hand.body_released.connect(func(_body: RigidBody3D) -> void: story.events.append([tick[0], "released"]))
	var box: RigidBody3D = add_free_box(SIZE, 0.1)
	for number: int in TICKS:
		tick[0] = number
		move.call(number)
		await physics_frames(1)
		story.places.append(box.global_transform)
	box.free()
	return story


## Reaches round the box, closes, lifts it aside, puts it down and opens.
func _move(tick: int, above: Vector3) -> void:
	var low := Vector3(0.0, FLOOR_Y + 0.5 * SIZE.y, 0.0)
	var aside := Vector3(0.05, 0.0, 0.0)
	var up := Vector3(0.0, 0.04, 0.0)
	# Until which tick, where to, and how far closed.
	var ways: Array = [
		[20, low, 0.0], [40, low, SQUEEZE_ANGLE], [55, low, SQUEEZE_ANGLE], [75, low + up, SQUEEZE_ANGLE],
		[90, low + up + aside, SQUEEZE_ANGLE], [105, low + aside, SQUEEZE_ANGLE], [115, low + aside, 0.0],
		[135, low + up + aside, 0.0], [TICKS, low + up + aside, 0.0]]
	var from: Vector3 = above
	var from_angle: float = 0.0
	var began: int = 0
	for way: Array in ways:
		if tick < way[0]:
			var part: float = float(tick - began + 1) / (way[0] - began)
			device.set_simulated_hand_target(
				Transform3D(Basis.IDENTITY, from.lerp(way[1], part)), lerpf(from_angle, way[2], part))
			return
		began = way[0]
		from = way[1]
		from_angle = way[2]
