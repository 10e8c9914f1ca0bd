## Base of the tests of a hand's time: one play of grasp, lift, swing and press, timed by the device's own clock, so that it is
## the same at every time scale, tick rate, frame rate and drive mode.
extends "res://hand_scene.gd"

const MASS: float = 0.1
## The most of it that is felt as inertia (held_load.gd).
const FELT_MASS: float = 0.05
const SIZE := Vector3(0.03, 0.04, 0.03)
const SWING_HZ: float = 0.5
const SWING_M: float = 0.06
## Frames of uneven lengths make the felt acceleration uneven: at 15 a second two swings are off by up to 3.7 %, by the frames drawn.
const SWINGS: float = 6.0
const TOLERANCE: float = 0.03
const CYCLES_OF_A_TICK: int = 3


## Least squares for the sine and cosine of a swing, after its first half: way in x, force in y.
class Swing:
	var began_s: float
	var last_s: float
	var _sine := Vector2.ZERO
	var _cosine := Vector2.ZERO
	var _time_s: float = 0.0

	func _init(now_s: float) -> void:
		began_s = now_s
		last_s = now_s

	func phase_at(now_s: float) -> float:
		return TAU * SWING_HZ * (now_s - began_s)

	func look(now_s: float, here: Vector2) -> void:
		var phase: float = phase_at(now_s)
		if phase > PI:
			_sine += sin(phase) * (now_s - last_s) * here
			_cosine += cos(phase) * (now_s - last_s) * here
			_time_s += now_s - last_s
		last_s = now_s

	func amplitudes() -> Vector2:
		return 2.0 / _time_s * Vector2(Vector2(_sine.x, _cosine.x).length(), Vector2(_sine.y, _cosine.y).length())


var body: RigidBody3D
var drive_mode: SpidarG.DriveMode = SpidarG.DRIVE_STEPPED
## Not 0: a stepped device goes on from drawn frame to drawn frame, of uneven lengths, as one in a thread does. Ticks of one
## frame then read one pose.
var frames_per_s: int = 0
## In real time the hand's target moves by uneven steps: its acceleration is then no longer the swing's.
var with_inertia: bool = true
var rejected: PackedStringArray = []

var _ticks_due: float = 0.0
var _cycles_ahead: int = 0
var _random := RandomNumberGenerator.new()
## Moves `at` and `angle` to where the hand's target is at a time of the device.
var _move := Callable()
## Looks at the device after each of its cycles, or after each tick where it steps by itself.
var _look := Callable()


## Everything that a hand measures, once, at this time scale. `label` begins every message.
func play(time_scale: float, label: String) -> void:
	await _prepare()
	if time_scale > 0.0:
		Engine.time_scale = time_scale
	await glide(body.global_position, 0.0, 0.5)
	await glide(body.global_position, SQUEEZE_ANGLE, 0.5)
	await rest(0.4)
	Engine.time_scale = time_scale
	if check(hand.get_held_body() == body, "%s: held" % label):
		await _squeeze(label)
		await _weight(label)
		if with_inertia:
			await _inertia(label)
		if time_scale == 0.0:
			await _back_to_one(label)
			Engine.time_scale = 0.0
		await _break(label)
	check_equal(rejected, PackedStringArray(), "%s: nothing was refused" % label)
	Engine.time_scale = 1.0
	device.free()
	body.free()
	await physics_frames(2)


## Moves the hand's target in a straight line, in seconds of the device.
func glide(to: Vector3, to_angle: float, time_s: float) -> void:
	var from: Vector3 = at
	var from_angle: float = angle
	var began_s: float = device.get_device_time()
	_move = func(now_s: float) -> void:
		var part: float = minf((now_s - began_s) / time_s, 1.0)
		at = from.lerp(to, part)
		angle = lerpf(from_angle, to_angle, part)
	while device.get_device_time() - began_s < time_s:
		await tick()
	_move.call(began_s + time_s)
	_move = Callable()  # It holds on to this test.


func rest(time_s: float) -> void:
	await glide(at, angle, time_s)


## One physics tick, and before it the drawn frame that it belongs to.
func tick() -> void:
	if frames_per_s > 0:
		while _ticks_due < 1.0:
			var cycles: int = roundi(1000.0 / frames_per_s * _random.randf_range(0.8, 1.2))
			_ticks_due += 0.001 * cycles * Engine.physics_ticks_per_second
			_run_device(maxi(cycles - _cycles_ahead, 0))
			_cycles_ahead = 0
		_ticks_due -= 1.0
		if _ticks_due >= 1.0:  # The ticks of one frame take some time too.
			_run_device(CYCLES_OF_A_TICK)
			_cycles_ahead += CYCLES_OF_A_TICK
	else:
		_move_hand()
	await physics_frames(1)
	if frames_per_s == 0 and _look.is_valid():
		_look.call()


func _run_device(cycles: int) -> void:
	for _i: int in cycles:
		_move_hand()
		device.advance_cycles(1)
		if _look.is_valid():
			_look.call()


## Mean of what is called once a tick, over seconds of the device: a tick counts for the time that it took.
func mean_of(value: Callable, time_s: float) -> float:
	var began_s: float = device.get_device_time()
	var last_s: float = began_s
	var sum: float = 0.0
	while last_s - began_s < time_s:
		await tick()
		var now_s: float = device.get_device_time()
		var now: float = value.call()
		sum += now * (now_s - last_s)
		last_s = now_s
	return sum / (last_s - began_s)


func asked(component: int) -> float:
	return device.get_requested_wrench()[component]


func _move_hand() -> void:
	if _move.is_valid():
		_move.call(device.get_device_time())
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), angle)


func _prepare() -> void:
	at = Vector3(0.0, FLOOR_Y + 0.06, 0.0)
	angle = 0.0
	rejected.clear()
	_random.seed = 1
	_ticks_due = 0.0
	_cycles_ahead = 0
	device = ideal_device()
	device.drive_mode = drive_mode
	device.forces_enabled = true
	device.request_rejected.connect(func(message: String) -> void: rejected.append(message))
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	device.set_physics_process_internal(frames_per_s == 0)
	if not tree.root.has_node(^"Floor"):
		add_box(Vector3(1.0, 0.1, 1.0), Vector3(0.0, FLOOR_Y - 0.05, 0.0), 0.0).name = "Floor"
	body = add_free_box(SIZE, MASS)
	await physics_frames(2)
	while device.get_state() != SpidarG.STATE_ACTIVE:
		await rest(0.1)


func _squeeze(label: String) -> void:
	var felt: float = await mean_of(func() -> float: return -asked(6), 0.3)
	var measured: float = await mean_of(hand.get_squeeze_torque, 0.3)
	check(felt > 0.05, "%s: the fingers squeeze: %f N m" % [label, felt])
	check_near(measured / felt, 1.0, TOLERANCE, "%s: squeeze, of what is asked of the device" % label)


func _weight(label: String) -> void:
	await glide(at + Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 0.5)
	await rest(0.4)
	var force: float = await mean_of(asked.bind(1), 0.3)
	check_near(force / (-MASS * GRAVITY), 1.0, TOLERANCE, "%s: weight" % label)


func _inertia(label: String) -> void:
	var middle: Vector3 = at
	var swing := Swing.new(device.get_device_time())
	_move = func(now_s: float) -> void:
		at = middle + Vector3(SWING_M * sin(swing.phase_at(now_s)), 0.0, 0.0)
	# Each cycle counts: the middle of a long frame is as much of the swing as its end.
	_look = func() -> void:
		swing.look(device.get_device_time(), Vector2(device.get_grip_transform().origin.x - middle.x, asked(0)))
	while swing.last_s - swing.began_s < (0.5 + SWINGS) / SWING_HZ:
		await tick()
	_look = Callable()
	var way_and_force: Vector2 = swing.amplitudes()
	var force_n: float = way_and_force.y
	var expected_n: float = FELT_MASS * pow(TAU * SWING_HZ, 2.0) * way_and_force.x
	check_near(force_n / expected_n, 1.0, TOLERANCE, "%s: inertia, of mass times the hand's acceleration" % label)
	_move = Callable()
	at = middle
	await rest(0.2)


func _back_to_one(label: String) -> void:
	Engine.time_scale = 1.0
	await rest(0.3)
	check(hand.get_held_body() == body, "%s: still held when time goes on" % label)
	var force: float = await mean_of(asked.bind(1), 0.2)
	check_near(force / (-MASS * GRAVITY), 1.0, TOLERANCE, "%s: its weight is back" % label)


func _break(label: String) -> void:
	await glide(Vector3(at.x, FLOOR_Y + 0.5 * SIZE.y - 0.008, at.z), SQUEEZE_ANGLE, 0.5)
	await rest(0.3)
	var press: float = MASS * GRAVITY + await mean_of(asked.bind(1), 0.3)
	check(press > 1.0, "%s: the body is pressed to the floor: %f N" % [label, press])
	var released: Array[int] = [0]
	hand.body_released.connect(func(_body: RigidBody3D) -> void: released[0] += 1)
	hand.break_force = press * (1.0 + TOLERANCE)
	await rest(0.3)
	check_equal(released[0], 0, "%s: held at a little less than the force that breaks" % label)
	hand.break_force = press * (1.0 - TOLERANCE)
	await rest(0.2)
	check(released[0] > 0, "%s: broken at a little more" % label)
