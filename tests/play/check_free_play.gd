extends SceneTree
## The blocks of air of free play, felt by the simulated hand in simulated time: each gives the force that its name says,
## and none outside; then a recording and its replay. Prints FAIL lines and "N passed, N failed".

const DemoSettings := preload("res://ui/demo_settings.gd")
const FieldZone := preload("res://tasks/free_play/field_zone.gd")
const FreePlay := preload("res://tasks/free_play/free_play.gd")
const MouseHand := preload("res://ui/mouse_hand.gd")

const TICK_S := 1.0 / 60.0
const ARMING_LIMIT_TICKS := 300
const REACH_TICKS := 90
const OUTSIDE_M := Vector3(0.0, 0.045, 0.0)
## Of a force against what the zone asks for.
const TOLERANCE_N := 0.15
## Strings that only pull draw the grip a little to the middle; towards the rim of the frame so much.
const BIAS_LIMIT_N := 0.45

var _passed := 0
var _failed := 0
var _task: FreePlay
var _spidar: SpidarG
var _mouse: MouseHand
## Beside the zone, without it.
var _bias_n := Vector3.ZERO


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	_open(DemoSettings.new())
	_spidar.forces_enabled = true
	var ticks := 0
	while _spidar.get_state() != SpidarG.STATE_ACTIVE and ticks < ARMING_LIMIT_TICKS:
		await physics_frame
		ticks += 1
	_check(_spidar.get_state() == SpidarG.STATE_ACTIVE, "the device is not active: " + _spidar.get_state_text())
	_check(_task.zones.size() == FieldZone.Kind.size(), "%d zones" % _task.zones.size())
	for zone in _task.zones:
		await _check_zone(zone)
	await _check_replay()
	print("%d passed, %d failed" % [_passed, _failed])
	quit(0 if _failed == 0 else 1)


func _open(settings: DemoSettings) -> void:
	_task = (load("res://tasks/free_play/free_play.tscn") as PackedScene).instantiate()
	_task.settings = settings
	_spidar = _task.get_node(^"SpidarG")
	_mouse = _task.get_node(^"MouseHand")
	_spidar.drive_mode = SpidarG.DRIVE_STEPPED
	root.add_child(_task)


func _check_zone(zone: FieldZone) -> void:
	var text := String(FieldZone.Kind.keys()[zone.kind])
	await _go(zone.global_position + OUTSIDE_M)
	_bias_n = Vector3.ZERO
	_check(_force().length() < BIAS_LIMIT_N, "%s: %s N above it" % [text, _force()])
	_bias_n = _force()
	await _go(zone.global_position)
	match zone.kind:
		FieldZone.Kind.VISCOUS:
			_check(_force().length() < TOLERANCE_N, "%s: %s N in the still hand" % [text, _force()])
			await _check_drag(zone)
		FieldZone.Kind.VIBRATION:
			await _check_buzz()
		FieldZone.Kind.DETENTS:
			await _check_notches(zone)
		FieldZone.Kind.SPRING:
			await _go(zone.global_position + Vector3(0.0, 0.0, 0.015))
			var way := zone.global_position - _spidar.get_grip_transform().origin
			var pull := FieldZone.SPRING_N_M * way
			_check(pull.length() > 2.0 * TOLERANCE_N, "%s: only %s m out" % [text, way])
			_near(pull, text)
		FieldZone.Kind.FORCE:
			_near(FieldZone.FORCE_N, text)
		FieldZone.Kind.WRENCH:
			_near(FieldZone.WRENCH_N, text)


## The drag goes against the way, and grows with the speed as it should: there and back, so that the bias drops out.
func _check_drag(zone: FieldZone) -> void:
	var half := Vector3(0.020, 0.0, 0.0)
	var ticks := 16
	var asked_n := 0.0
	var given_n := 0.0
	var speed_m_s := 0.0
	for way: float in [1.0, -1.0]:
		await _go(zone.global_position - half * way)
		var last := _spidar.get_grip_transform().origin.x
		for tick in ticks:
			_aim(zone.global_position + half * way * (2.0 * (tick + 1) / ticks - 1.0))
			await physics_frame
			var now := _spidar.get_grip_transform().origin.x
			asked_n += way * _spidar.get_requested_wrench()[0]
			given_n += way * _force().x
			speed_m_s += way * (now - last) / TICK_S
			last = now
	var drag := -asked_n / speed_m_s
	_check(
		absf(drag - FieldZone.VISCOUS_N_S_M) < 0.2 * FieldZone.VISCOUS_N_S_M,
		"thick air: %.2f N s/m, not %.2f" % [drag, FieldZone.VISCOUS_N_S_M]
	)
	_check(
		absf(given_n - asked_n) < 0.35 * absf(asked_n),
		"thick air: the strings give %.2f of the drag" % (given_n / asked_n)
	)


## 80 Hz seen 60 times a second: another frequency, the same size.
func _check_buzz() -> void:
	var squares := 0.0
	var count := 60
	for tick in count:
		await physics_frame
		squares += _force().y ** 2
	var amplitude := sqrt(2.0 * squares / count)
	_check(
		absf(amplitude - FieldZone.VIBRATION_N) < 0.3 * FieldZone.VIBRATION_N,
		"buzz: amplitude %.2f N, not %.2f" % [amplitude, FieldZone.VIBRATION_N]
	)


## L records, and the settings' source replay plays that file: the grip goes where it went, without a hand.
func _check_replay() -> void:
	await _press(KEY_L)
	_check(_spidar.is_recording(), "L does not record")
	var away := _spidar.global_position + Vector3(0.05, 0.0, 0.02)
	await _go(away)
	var went_to := _spidar.get_grip_transform().origin
	await _press(KEY_L)
	_check(not _spidar.is_recording(), "L does not end the recording")
	_task.free()
	var settings := DemoSettings.new()
	settings.source = DemoSettings.REPLAY
	settings.recording = DemoSettings.recordings()[0]
	_open(settings)
	_check(_spidar.is_replaying(), "no replay of %s" % settings.recording)
	var ended: Array[String] = []
	_spidar.replay_finished.connect(func(identical: bool, message: String) -> void:
		ended.append("%s %s" % [identical, message]))
	var ticks := 0
	while ended.is_empty() and ticks < 2 * REACH_TICKS:
		await physics_frame
		ticks += 1
	_check(not ended.is_empty() and ended[0].begins_with("true"), "the replay: %s" % [ended])
	var now := _spidar.get_grip_transform().origin
	_check(now.distance_to(went_to) < 1e-4, "the replay ends at %s, not at %s" % [now, went_to])
	DirAccess.remove_absolute(DemoSettings.RECORDINGS.path_join(settings.recording))


func _press(key: Key) -> void:
	for pressed: bool in [true, false]:
		var event := InputEventKey.new()
		event.physical_keycode = key
		event.pressed = pressed
		Input.parse_input_event(event)
		await physics_frame
		await process_frame


## Slowly through: the push changes its sign in every valley and on every ridge.
func _check_notches(zone: FieldZone) -> void:
	var from := zone.global_position - Vector3(0.020, 0.0, 0.0)
	await _go(from)
	var changes := 0
	var most_n := 0.0
	var side := 0.0
	for tick in 160:
		_aim(from + Vector3(0.00025 * tick, 0.0, 0.0))
		await physics_frame
		var push := _force().x
		most_n = maxf(most_n, absf(push))
		if absf(push) > TOLERANCE_N:
			changes += int(side != 0.0 and signf(push) != side)
			side = signf(push)
	_check(changes >= 5, "notches: the push changes its sign %d times on 40 mm" % changes)
	_check(
		most_n > 0.5 * FieldZone.DETENT_N and most_n < FieldZone.DETENT_N + TOLERANCE_N,
		"notches: at most %.2f N of %.2f" % [most_n, FieldZone.DETENT_N]
	)


func _go(to: Vector3) -> void:
	_aim(to)
	for tick in REACH_TICKS:
		await physics_frame


func _aim(at: Vector3) -> void:
	_mouse.position_m = _spidar.to_local(at) / _spidar.workspace_scale


## What the strings give beyond their bias, world.
func _force() -> Vector3:
	var given := _spidar.get_achieved_wrench()
	return Vector3(given[0], given[1], given[2]) - _bias_n


func _near(wanted: Vector3, text: String) -> void:
	_check(_force().distance_to(wanted) < TOLERANCE_N, "%s: %s N, not %s" % [text, _force(), wanted])


func _check(condition: bool, message: String) -> void:
	if condition:
		_passed += 1
	else:
		_failed += 1
		print("FAIL free play: " + message)
