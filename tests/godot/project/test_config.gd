## SpidarGConfig by itself: presets and the check of a geometry.
extends "res://test_case.gd"


func test_the_papers_device_is_sound() -> void:
	var told: Dictionary = SpidarGConfig.new().check_geometry()
	check_equal(told["sound"], true, "sound: %s" % [told["complaints"]])
	check_equal(told["rank"], 7, "rank")
	check_equal(told["closed_at_rest"], true, "closed")
	var force_n: float = told["force_capacity_n"]
	check(force_n > 5.0 and force_n < 60.0, "force in every direction: %f N" % force_n)


func test_rigid_presets_have_six_degrees() -> void:
	var config := SpidarGConfig.new()
	for preset: int in [2, 3]:
		config.preset = preset
		check_equal(config.get_problem(), "", "preset %d opens" % preset)
		var told: Dictionary = config.check_geometry()
		check_equal(told["degrees_of_freedom"], 6, "preset %d is rigid" % preset)
		check_equal(told["rank"], 6, "preset %d has full rank" % preset)


func test_a_wrong_preset_is_refused_with_the_field() -> void:
	var config := SpidarGConfig.new()
	config.preset = 17
	check(config.get_problem().contains("preset"), "names the field: %s" % config.get_problem())
	check_equal(config.check_geometry()["sound"], false, "not sound")
