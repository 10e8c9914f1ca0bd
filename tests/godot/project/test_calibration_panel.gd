## The inspector's calibration, without its controls: the session that leads through the steps, in simulated time; what
## an accepted result changes, and that it can be undone.
extends "res://test_case.gd"

const Session := preload("res://addons/spidar_g/editor/calibration/calibration_session.gd")
const Target := preload("res://addons/spidar_g/editor/calibration/calibration_target.gd")
const Plot := preload("res://addons/spidar_g/editor/calibration/residual_plot.gd")

const FRAME_S: float = 0.1


func _practice_target(seed_number: int) -> Target:
	var target := Target.new()
	target.node = SpidarG.new()
	var random := RandomNumberGenerator.new()
	random.seed = seed_number
	target.draw_practice_errors(random)
	return target


func _open(target: Target) -> Session:
	var session := Session.new()
	session.stepped = true
	session.open_device(target.get_config(), target.get_calibration())
	check(session.is_open(), "open: %s" % session.message)
	return session


## Simulated time until the condition holds; false: not within limit_s.
func _update_until(session: Session, condition: Callable, limit_s: float) -> bool:
	var time_s: float = 0.0
	while not condition.call() and time_s < limit_s:
		session.update(FRAME_S)
		time_s += FRAME_S
		if session.calibrator.is_computing():
			await tree.process_frame
			OS.delay_msec(5)
	return condition.call()


func test_the_steps_lead_to_a_calibration() -> void:
	var history := UndoRedo.new()
	var target: Target = _practice_target(11)
	var session: Session = _open(target)
	session.check_wiring()
	check(await _update_until(session, func() -> bool: return not session.is_task_running(), 60.0), "wiring ends")
	check(session.is_done(Session.Step.WIRING), "wired rightly: %s" % [session.wiring])
	session.update(1.0)
	check_equal(session.calibrator.get_live()["motors_on"], false, "motors off after it")
	session.start_motion()
	check(not session.moving and session.message_is_problem, "no motion before the zero: %s" % session.message)
	for _i: int in 3:
		session.read_zero()
		session.update(FRAME_S)
	check(session.is_done(Session.Step.ZERO), "zero")
	check_equal(session.is_done(Session.Step.RESULT), false, "no result yet")
	session.start_motion()
	check(session.moving, "moves: %s" % session.message)
	check(await _update_until(session, func() -> bool: return session.is_done(Session.Step.RESULT), 20.0), "estimate on the way")
	check(await _update_until(session, func() -> bool: return not session.moving, 60.0), "enough poses")
	check_near(session.get_progress(), 1.0, 1e-9, "the bar is full")
	await _update_until(session, func() -> bool: return not session.calibrator.is_computing(), 600.0)
	check(not session.message_is_problem, session.message)
	session.weigh_all(2.0)
	check(await _update_until(session, func() -> bool: return not session.is_task_running(), 120.0), "weighing ends")
	check(session.is_done(Session.Step.WEIGHTS), "all weighed: %s" % session.message)

	var before: SpidarGCalibration = target.get_calibration()
	var made: SpidarGCalibration = session.make_calibration()
	target.accept(history, made)
	check(target.node.calibration == made, "accepted")
	for i: int in 8:
		var gain: float = target.get_config().simulated_gain_errors[i]
		check_near(made.string_scales[i] * (1.0 + gain) / 2.513274122871834e-5, 1.0, 1.5e-3, "scale %d" % i)
		check_near(made.tension_gains[i], target.get_config().simulated_tension_gains[i], 0.02, "motor %d" % i)
	history.undo()
	check(target.node.calibration == before, "undone")
	history.redo()
	check(target.node.calibration == made, "redone")
	session.close_device()
	check_equal(session.is_busy(), false, "closed")
	target.node.free()
	history.free()


func test_a_resource_takes_values_and_gives_them_back() -> void:
	var history := UndoRedo.new()
	var target := Target.new()
	target.resource = SpidarGCalibration.new()
	target.resource.tension_gains = PackedFloat64Array([2, 2, 2, 2, 2, 2, 2, 2])
	var made := SpidarGCalibration.new()
	made.string_scales = PackedFloat64Array([1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5])
	made.tension_gains = PackedFloat64Array([1, 1, 1, 1, 1, 1, 1, 1])
	target.accept(history, made)
	check_equal(target.resource.string_scales, made.string_scales, "taken")
	history.undo()
	check_equal(target.resource.string_scales, PackedFloat64Array(), "given back: none")
	check_equal(target.resource.tension_gains[0], 2.0, "given back: the old ones")
	history.redo()
	check_equal(target.resource.tension_gains, made.tension_gains, "taken again")
	history.free()


func test_practice_leaves_no_trace() -> void:
	var target := Target.new()
	target.node = SpidarG.new()
	var own := SpidarGConfig.new()
	own.transport = SpidarGConfig.TRANSPORT_DEVICE
	own.frame_size = Vector3(0.5, 0.5, 0.5)
	for config: SpidarGConfig in [own, null]:
		target.node.config = config
		var random := RandomNumberGenerator.new()
		target.draw_practice_errors(random)
		check(target.is_practice(), "practising")
		check_equal(target.get_config().transport, SpidarGConfig.TRANSPORT_SIMULATED, "with a simulated device")
		check_equal(target.get_config().simulated_offset_errors.size(), 8, "that has errors")
		if config != null:
			check_equal(target.get_config().frame_size, own.frame_size, "in the same frame")
		check(target.node.config == config, "the node keeps its config")
		check_equal(own.transport, SpidarGConfig.TRANSPORT_DEVICE, "and the config its transport")
		check_equal(own.simulated_offset_errors.size(), 0, "and has no errors")
		target.end_practice()
		check(not target.is_practice() and target.get_config() == config, "over")
	target.node.free()


func test_a_preset_makes_a_config_and_takes_it_away_again() -> void:
	var history := UndoRedo.new()
	var target := Target.new()
	target.node = SpidarG.new()
	target.set_preset(history, 1)
	check_equal(target.node.config.preset, 1, "made with the preset")
	target.set_preset(history, 2)
	check_equal(target.node.config.preset, 2, "changed")
	history.undo()
	check_equal(target.node.config.preset, 1, "undone")
	history.undo()
	check(target.node.config == null, "no config, as before")
	target.node.free()
	history.free()


func test_what_goes_wrong_is_said() -> void:
	var history := UndoRedo.new()
	var target: Target = _practice_target(4)
	target.get_config().simulated_gain_errors = PackedFloat64Array([1.0])
	var session := Session.new()
	session.stepped = true
	session.open_device(target.get_config(), null)
	check(session.message_is_problem and session.message.contains("simulated_gain_errors"), session.message)
	check_equal(session.is_busy(), false, "stays closed")
	target.get_config().simulated_gain_errors = PackedFloat64Array()
	session.open_device(target.get_config(), null)
	check(session.is_open(), session.message)
	check(session.make_calibration() == null and session.message_is_problem, "nothing to accept: %s" % session.message)
	session.read_length(0, 5.0)
	check(session.message_is_problem and session.message.contains("length_m"), session.message)
	session.weigh(0, 1.0)
	session.stop()
	session.update(0.5)
	check_equal(session.calibrator.get_live()["motors_on"], false, "stopped")
	session.close_device()
	target.node.free()
	history.free()


func test_the_plot_is_logarithmic_and_bounded() -> void:
	check_near(Plot.height_of(1e-3) - Plot.height_of(1e-4), Plot.height_of(1e-2) - Plot.height_of(1e-3), 1e-9, "decades")
	check_equal(Plot.height_of(0.0), 0.0, "nothing")
	check_equal(Plot.height_of(5.0), 1.0, "more than shown")
	check_equal(Plot.height_of(NAN), 1.0, "no pose fits")
