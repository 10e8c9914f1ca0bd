## Strings of known stiffness: the pose follows what the tensions stretch, so a wall is as stiff as asked.
extends "res://test_case.gd"

const WALL: float = 350.0
const EA: float = 3000.0


## A firm hand leans on a wall: the error of the pose (m), and of the wall's force (relative).
func _lean(calibration: SpidarGCalibration) -> Vector2:
	var device: SpidarG = ideal_device()
	device.config.simulated_elastic = true
	device.config.simulated_string_stiffness = EA
	device.config.simulated_hand_firmness = SpidarG.HAND_FIRM
	device.calibration = calibration
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(1600)
	device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, Vector3(0, -0.03, 0)), 0.0)
	var wall := PackedFloat64Array([0, 1, 0, 0, 0, 0, 0, WALL, 2.0, 0.0, SpidarG.CONTACT_CENTER, 1])
	for _i: int in 100:
		device.set_contacts(wall)
		device.advance_cycles(20)
	check_equal(device.get_state(), SpidarG.STATE_ACTIVE, "active")
	var truth: Transform3D = device.get_simulated_truth()["grip_transform"]
	var force: float = device.get_requested_wrench()[1]
	var result := Vector2(
		truth.origin.distance_to(device.get_grip_transform().origin), force / (WALL * -truth.origin.y) - 1.0
	)
	device.free()
	return result


func test_known_stiffness_takes_the_stretch_out_of_a_wall() -> void:
	var known := SpidarGCalibration.new()
	known.string_stiffnesses = PackedFloat64Array([EA, EA, EA, EA, EA, EA, EA, EA])
	var raw: Vector2 = await _lean(null)
	var corrected: Vector2 = await _lean(known)
	print("INFO stretch: pose %.3f mm, force %.1f %%; known: %.3f mm, %.1f %%" % [1e3 * raw.x, 1e2 * raw.y,
		1e3 * corrected.x, 1e2 * corrected.y])
	check(raw.y < -0.02, "unknown, the wall gives way more than asked: %f" % raw.y)
	check(absf(corrected.y) < 0.01, "known, it is as stiff as asked: %f" % corrected.y)
	check(corrected.x < 0.3 * raw.x, "and the pose is true: %f of %f m" % [corrected.x, raw.x])


func test_calibrating_keeps_winding_and_stretch() -> void:
	var given := SpidarGCalibration.new()
	given.winding_curvatures = PackedFloat64Array([0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, -0.07])
	given.string_stiffnesses = PackedFloat64Array([EA, EA, 0, EA, EA, EA, EA, 2.0 * EA])
	given.hidden_lengths = PackedFloat64Array([0.1, 0, 0, 0, 0, 0, 0, 0.2])
	given.calibration_tensions = PackedFloat64Array([0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5])
	var calibrator := SpidarGCalibrator.new()
	check(calibrator.open(SpidarGConfig.new(), given, true), "opens: %s" % calibrator.get_problem())
	calibrator.advance(0.5)
	check(calibrator.take_zero(), "zero: %s" % calibrator.get_problem())
	var made: SpidarGCalibration = calibrator.make_calibration()
	check(made != null, calibrator.get_problem())
	if made != null:
		for property: String in ["winding_curvatures", "string_stiffnesses", "hidden_lengths", "calibration_tensions"]:
			check_equal(made.get(property), given.get(property), property)
	calibrator.close()
