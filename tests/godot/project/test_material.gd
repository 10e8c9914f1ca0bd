## SpidarGMaterial and SpidarGSurface: each property is measured as a force on the simulated hand.
extends "res://material_floor.gd"


func test_one_material_decides_friction_of_touch_and_of_grasp() -> void:
	var material := SpidarGMaterial.new()
	material.dynamic_friction = 0.2
	await _set_up_floor(material)
	var physics := PhysicsMaterial.new()
	physics.friction = 0.05
	_floor.physics_material_override = physics
	for game_cycles: int in GAME_CYCLES:
		await _check_friction(0.2, "the material goes before the body's physics material", game_cycles)
	material.dynamic_friction = 0.6
	await _check_friction(0.6, "changed while playing")
	material.dynamic_friction = -1.0
	await _check_friction(0.05, "not said: the physics material's")
	_floor.physics_material_override = null
	await _check_friction(0.4, "not said at all: the hand's")
	_surface.free()
	await _check_friction(0.4, "without a surface: the hand's")


func test_a_slippery_body_is_not_lifted_and_a_rough_one_is() -> void:
	for friction: float in [0.05, 0.9]:
		at = Vector3.ZERO
		angle = 0.0
		await set_up(Vector3.ZERO)
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.15)
		var material := SpidarGMaterial.new()
		material.dynamic_friction = friction
		_give(body, material)
		var reasons: Array[String] = []
		hand.grasp_refused.connect(func(_body: Node, reason: String) -> void: reasons.append(reason))
		await physics_frames(10)
		await grasp(body)
		check_equal(hand.get_held_body() == body, friction > 0.5, "friction %.2f: held" % friction)
		check_equal(reasons.is_empty(), friction > 0.5, "friction %.2f: %s" % [friction, reasons])
		device.free()
		body.free()
		await physics_frames(2)


func test_static_friction_is_overcome_before_it_slips() -> void:
	var material := SpidarGMaterial.new()
	material.dynamic_friction = 0.2
	material.static_friction = 0.7
	await _set_up_floor(material)
	var most: float = 0.0
	for force: Vector3 in await _slide(Vector3(0.02, 0.0, 0.0), 800):
		most = maxf(most, -force.x / force.y)
	# Fast, so that the hand's own springs do not let it stand again.
	var last: Vector3 = mean_of((await _slide(Vector3(0.1, 0.0, 0.0), 800)).slice(-400))
	check_near(most, 0.7, 0.035, "the largest ratio of drag and press")
	check_near(-last.x / last.y, 0.2, 0.01, "while it slips")


func test_stick_slip_creaks_at_the_rate_of_its_way() -> void:
	var material := SpidarGMaterial.new()
	material.dynamic_friction = 0.2
	material.static_friction = 0.8
	material.stick_slip = true
	await _set_up_floor(material)
	var cycles: PackedVector3Array = (await _slide(Vector3(0.04, 0.0, 0.0), 2000)).slice(500)
	var press: float = mean_of(cycles).y
	# The spring of the friction and that of the hand, one behind the other.
	var hand_n_m: float = press / (device.get_grip_transform().origin.y - at.y)
	var friction_n_m: float = 0.6 * device.get_stiffness_limits().x
	var way_m: float = 0.6 * press * (1.0 / hand_n_m + 1.0 / friction_n_m)
	var due_hz: float = 1.0 / (way_m / 0.04 + 0.003 + 0.005) # the end of the hold, and the slip itself
	var felt_hz: float = peak_hz(cycles, 0, due_hz)
	print("INFO stick-slip: %.1f Hz, due %.1f Hz" % [felt_hz, due_hz])
	check_near(felt_hz, due_hz, 0.15 * due_hz, "creaks")


func test_a_texture_is_felt_at_speed_over_wavelength() -> void:
	# Games of 144, 60 and 30 ticks a second.
	for game_cycles: int in GAME_CYCLES:
		var wavelength: float = 0.003 if game_cycles == 16 else 0.006
		var material := SpidarGMaterial.new()
		material.dynamic_friction = 0.0
		material.texture_wavelength = wavelength
		material.texture_depth = 0.0003
		material.texture_direction = Vector3.BACK # both pads in step
		await _set_up_floor(material)
		var cycles: PackedVector3Array = (await _slide(Vector3(0.0, 0.0, 0.06), 1800, game_cycles)).slice(300)
		var due_hz: float = 0.06 / wavelength
		check_near(peak_hz(cycles, 1, due_hz), due_hz, 0.02 * due_hz, "%.0f mm: press" % (1e3 * wavelength))
		check_near(peak_hz(cycles, 2, due_hz), due_hz, 0.02 * due_hz, "%.0f mm: along" % (1e3 * wavelength))
		_free_all()
		await physics_frames(2)


func test_a_magnet_pulls_within_its_range_alone() -> void:
	var material := SpidarGMaterial.new()
	material.magnet_force = 1.0
	material.magnet_range = 0.02
	await _set_up_floor(material)
	for gap: float in [0.03, 0.02, 0.016, 0.012]:
		await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS + gap, 0.0), 60)
		await physics_frames(30)
		var felt: Vector3 = force_of(await mean_felt(20))
		var height: float = device.get_grip_transform().origin.y - FLOOR_Y - PAD_RADIUS
		check(height > 0.0, "still over it: %.1f mm" % (1e3 * height))
		var due: float = 2.0 * 1.0 * clampf(1.0 - height / 0.02, 0.0, 1.0) # two pads
		check_near(-felt.y, due, 0.05 * due + 0.02, "%.1f mm over it" % (1e3 * height))


func test_adhesion_holds_what_has_touched() -> void:
	var material := SpidarGMaterial.new()
	material.adhesion = 1.0
	await _set_up_floor(material)
	await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS + 0.0006, 0.0), 60)
	await physics_frames(20)
	check_near(force_of(await mean_felt(20)).y, 0.0, 0.02, "not touched yet")
	await _rest()
	var most: float = 0.0
	for force: Vector3 in await _glide(Vector3(0.0, 0.01, 0.0), 2000):
		most = maxf(most, -force.y)
	check_near(most, 2.0, 0.1, "two pads come off at 1 N each")
	check_near(force_of(await mean_felt(20)).y, 0.0, 0.02, "and then are free")


func test_a_surface_tells_of_touch_and_slip() -> void:
	var material := SpidarGMaterial.new()
	material.dynamic_friction = 0.2
	await _set_up_floor(material)
	var told: Array[String] = []
	_surface.touched.connect(func(who: SpidarGHand, point: Vector3, force: float) -> void:
		check(who == hand and force > 0.0, "touched by the hand with %.2f N" % force)
		check_near(point.y, FLOOR_Y, 1e-3, "on the floor")
		told.append("touched"))
	_surface.slip_started.connect(func(_who: SpidarGHand, speed: float) -> void:
		check(speed > 0.005, "slips at %.3f m/s" % speed)
		told.append("slips"))
	_surface.slip_ended.connect(func(_who: SpidarGHand) -> void: told.append("stands"))
	_surface.touch_ended.connect(func(_who: SpidarGHand) -> void: told.append("ended"))
	check(not _surface.is_touched(), "in the air")
	await _rest()
	check_equal(told, ["touched"] as Array[String], "resting")
	check_near(_surface.get_touch_force(), force_of(await mean_felt(10)).y, 0.1, "presses as hard")
	await _slide(Vector3(0.04, 0.0, 0.0), 1000)
	check_equal(told, ["touched", "slips"] as Array[String], "sliding")
	check_near(_surface.get_slip_speed(), 0.04, 0.01, "as fast as the hand")
	await physics_frames(30)
	await go(Vector3(0.0, FLOOR_Y + 0.06, 0.0), 40)
	check(told.count("touched") == 1 and told.count("slips") == told.count("stands") and told.back() == "ended", "lifted: %s" % [told])
	hand.free()
	check(not _surface.is_touched(), "no hand, no touch")


func test_metadata_of_earlier_versions_still_counts_behind_a_material() -> void:
	await _set_up_floor(null)
	_floor.set_meta(&"spidar_friction", 0.15)
	await _check_friction(0.15, "metadata of an earlier version")
	var material := SpidarGMaterial.new()
	material.stiffness = 300.0
	_surface.material = material
	await _check_friction(0.15, "the material does not say any")
	material.dynamic_friction = 0.3
	await _check_friction(0.3, "the material says one")


func test_a_surface_without_a_body_or_material_says_so() -> void:
	var surface := SpidarGSurface.new()
	add(surface)
	check_equal(surface.get_warnings().size(), 2, "no body, no material: %s" % [surface.get_warnings()])
	var body := StaticBody3D.new()
	add(body)
	_give(body, SpidarGMaterial.new())
	check_equal((body.get_child(0) as SpidarGSurface).get_warnings().size(), 0, "good")
	_give(body, SpidarGMaterial.new())
	check_equal((body.get_child(1) as SpidarGSurface).get_warnings().size(), 1, "two on one body")


func test_bad_values_are_refused_and_the_old_ones_stay() -> void:
	var material := SpidarGMaterial.new()
	for bad: Array in [["stiffness", -1.0], ["damping", NAN], ["adhesion", 1e9], ["magnet_range", -0.1],
			["dynamic_friction", -0.5], ["texture_depth", INF], ["texture_direction", Vector3(NAN, 0.0, 0.0)]]:
		var before: Variant = material.get(bad[0] as String)
		material.set(bad[0] as String, bad[1])
		check_equal(material.get(bad[0] as String), before, "%s = %s" % bad)
