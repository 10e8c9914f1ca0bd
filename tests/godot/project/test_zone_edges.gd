## SpidarGZone: no jolt at its surface, nothing left behind it, and what it refuses.
extends "res://zone_scene.gd"

## Largest change of force from one servo cycle to the next, N.
const NO_JOLT_N: float = 0.3
const ENDS_CYCLES: int = 200


func test_entering_and_leaving_never_jolts() -> void:
	for kind: Zone.Kind in Zone.Kind.values():
		for edge: float in [0.0, 0.02]:
			await set_up(kind, Vector3(0.1, 0.2, 0.2))
			_strong(edge)
			await go(Vector3(-0.09, 0.01, 0.01))
			var most: float = 0.0
			var most_felt: float = 0.0
			var strongest: float = 0.0
			for to: Vector3 in [Vector3(0.09, 0.01, 0.01), Vector3(-0.09, 0.01, 0.01)]:
				await run(56, to)
				most = maxf(most, largest_step(asked))
				most_felt = maxf(most_felt, largest_step(felt))
				for force: Vector3 in asked:
					strongest = maxf(strongest, force.length())
			print("INFO %s, edge %s m: steps of %.3f N asked, %.3f N felt, at most %.2f N" % [Zone.Kind.keys()[kind], edge, most, most_felt, strongest])
			check(strongest > 0.3, "%s is felt: %f N" % [Zone.Kind.keys()[kind], strongest])
			check(most < NO_JOLT_N, "%s, edge %s m: a step of %f N is asked for" % [Zone.Kind.keys()[kind], edge, most])
			check(most_felt < NO_JOLT_N, "%s, edge %s m: a step of %f N is felt" % [Zone.Kind.keys()[kind], edge, most_felt])
			await leave()


func test_a_hand_that_jumps_out_is_let_go_over_the_fade_time() -> void:
	await set_up(Zone.Kind.WIND)
	zone.wind_force = Vector3(2, 0, 0)
	zone.fade_time = 0.2
	await go(Vector3.ZERO)
	zone.position.y = 5.0
	await run(30)
	check(largest_step(asked) < 0.03, "a step of %f N" % largest_step(asked))
	check(asked[100].length() > 0.5, "it fades: %s" % asked[100])
	check_near(asked[-1].length(), 0.0, 1e-6, "and ends")
	await leave()


func test_nothing_is_left_when_a_zone_goes() -> void:
	for way: String in ["freed", "removed", "not enabled", "disabled", "paused", "its shape is disabled", "another kind", "the game hangs"]:
		await set_up(Zone.Kind.WIND)
		await go(Vector3.ZERO)
		check_near(mean(felt, 320).x, 1.0, 0.06, "%s: felt before" % way)
		match way:
			"freed":
				zone.free()
			"removed":
				tree.root.remove_child(zone)
			"not enabled":
				zone.enabled = false
			"disabled":
				zone.process_mode = Node.PROCESS_MODE_DISABLED
			"paused":
				tree.paused = true
			"its shape is disabled":
				(zone.get_child(0) as CollisionShape3D).disabled = true
				await run(7)
			"another kind":
				zone.kind = Zone.Kind.VISCOSITY
		var before: Vector3 = _force(device.get_requested_wrench())
		var most: float = 0.0
		for _cycle: int in ENDS_CYCLES:
			device.advance_cycles(1)
			var now: Vector3 = _force(device.get_requested_wrench())
			most = maxf(most, now.distance_to(before))
			before = now
		check(most < NO_JOLT_N, "%s: ends with a step of %f N" % [way, most])
		check_near(before.length(), 0.0, 1e-6, "%s: nothing is asked for after 0.2 s" % way)
		var left: Vector3 = _force(device.get_simulated_truth()["strings_wrench"])
		check(left.length() < 0.12, "%s: nothing is felt after 0.2 s: %s" % [way, left])
		tree.paused = false
		if way == "removed":
			check(not zone.is_hand_inside(device), "removed: nobody is inside")
		await leave()


func test_hands_are_told_as_they_come_and_go() -> void:
	await set_up(Zone.Kind.VISCOSITY)
	var told: PackedStringArray = []
	zone.hand_entered.connect(func(who: SpidarG) -> void: told.append("in" if who == device else "?"))
	zone.hand_exited.connect(func(who: SpidarG) -> void: told.append("out" if who == device else "?"))
	await go(Vector3(0, 0.1, 0))
	told.clear()
	await run(20)
	check(told.is_empty(), "nothing while the hand stays outside")
	await go(Vector3.ZERO)
	check_equal(told, PackedStringArray(["in"]), "inside")
	check(zone.is_hand_inside(device), "asked")
	check_near(zone.get_strength(device), 1.0, 1e-6, "in full")
	await go(Vector3(0, 0.1, 0))
	check_equal(told, PackedStringArray(["in", "out"]), "outside again")
	check(not zone.is_hand_inside(device) and zone.get_strength(device) == 0.0, "asked")
	await go(Vector3.ZERO)
	zone.enabled = false
	check_equal(told, PackedStringArray(["in", "out", "in", "out"]), "each in has its out")
	zone.enabled = true
	await run(3)
	device.enabled = false
	await physics_frames(2)
	check_equal(told.count("out"), 3, "a closed device is out")
	device.enabled = true
	await physics_frames(2)
	device.advance_cycles(1600)
	await run(3)
	check_equal(told.count("in"), 4, "and in when it is open again")
	device.free()
	check_equal(told.count("out"), 4, "a freed device is out")
	check(not zone.is_physics_processing(), "a zone that nobody can feel costs nothing")
	device = ideal_device()
	add(device)
	await physics_frames(1)
	check(zone.is_physics_processing(), "until a device comes")
	await leave()


func test_a_hand_at_the_surface_does_not_swing() -> void:
	for firmness: SpidarG.HandFirmness in [SpidarG.HAND_LIGHT, SpidarG.HAND_NORMAL, SpidarG.HAND_FIRM]:
		for told: Array in [[Zone.Kind.WIND, 1.5], [Zone.Kind.WIND, -1.5], [Zone.Kind.MAGNET_POINT, 1.0]]:
			await set_up(told[0], Vector3(0.1, 0.2, 0.2))
			device.set_simulated_hand_firmness(firmness)
			zone.wind_force = Vector3(told[1], 0, 0)
			zone.stiffness = 60.0
			await go(Vector3(0.05, 0, 0))
			await run(60)
			print("INFO %s %s, firmness %s: trembles by %.2f mm" % [Zone.Kind.keys()[told[0]], told[1], firmness, 1000.0 * tremble()])
			check(tremble() < 0.001, "%s, firmness %s: swings by %f m" % [told, firmness, tremble()])
			await leave()


func test_a_wind_too_strong_for_its_edge_is_warned_about() -> void:
	zone = Zone.new()
	zone.kind = Zone.Kind.WIND
	check(zone._get_configuration_warnings().is_empty(), "not as it comes: %s" % zone._get_configuration_warnings())
	zone.wind_force = Vector3(0, 2.5, 0)
	check(zone._get_configuration_warnings()[0].contains("edge_width 0.025"), "the remedy: %s" % zone._get_configuration_warnings())
	zone.free()


func test_more_zones_than_effects_are_told_by_name() -> void:
	await set_up(Zone.Kind.WIND)
	zone.wind_force = Vector3(0.2, 0, 0)
	var others: Array[Zone] = []
	for i: int in 6:
		others.append(add_zone(Zone.Kind.WIND))
		others[i].wind_force = Vector3(0.2, 0, 0)
		others[i].name = "Overlapping%d" % i
	var rejected: Array[String] = []
	device.request_rejected.connect(func(message: String) -> void: rejected.append(message))
	await go(Vector3.ZERO)
	check(rejected.size() > 0 and rejected.size() < 8, "asked again now and then: %d times" % rejected.size())
	check_near(mean(asked, 320).x, 6 * 0.2, 0.01, "six are felt")
	others[0].free()
	await run(60)
	check_near(mean(asked, 640).x, 6 * 0.2, 0.01, "the seventh takes the place of one that ends")
	var ids: Dictionary[int, bool] = {zone.get_effect_id(): true}
	for i: int in range(1, 6):
		ids[others[i].get_effect_id()] = true
		check(others[i].get_effect_id() >= Zone.FIRST_ID, "in the range of zones")
	check_equal(ids.size(), 6, "each has an id of its own")
	for i: int in range(1, 6):
		others[i].free()
	await run(20)
	check(device.set_force_effect(1, Vector3(0, 0.3, 0), Vector3.ZERO, 0.0, 2.0), "the game's own")
	zone.free()
	await run(20)
	check_near(asked[-1].y, 0.3, 1e-6, "is not ended by a zone that goes")
	await leave()


func test_one_device_may_be_chosen() -> void:
	await set_up(Zone.Kind.WIND)
	var other: SpidarG = ideal_device()
	other.forces_enabled = true
	add(other)
	zone.spidar_path = zone.get_path_to(other)
	await go(Vector3.ZERO)
	check_near(mean(asked, 320).length(), 0.0, 1e-6, "not this one")
	check(zone.is_hand_inside(other), "but the other")
	zone.spidar_path = ^"nowhere"
	check(zone._get_configuration_warnings()[0].contains("nowhere"), "a path to nothing is told")
	zone.spidar_path = ^""
	await run(60)
	check_near(mean(asked, 640).x, 1.0, 1e-3, "all")
	check(zone.is_hand_inside(other) and zone.is_hand_inside(device), "both are inside")
	other.free()
	await leave()


func test_bad_values_are_refused() -> void:
	zone = Zone.new()
	for field: String in ["viscosity", "viscosity_angular", "viscosity_grasp", "stiffness", "vibration_frequency", "detent_spacing", "detent_force", "max_force", "fade_time", "edge_width"]:
		var good: float = zone.get(field)
		for bad: float in [NAN, INF, -1.0]:
			zone.set(field, bad)
			check_equal(zone.get(field), good, "%s = %s" % [field, bad])
	for field: String in ["wind_force", "vibration_force"]:
		var good: Vector3 = zone.get(field)
		zone.set(field, Vector3(0, NAN, 0))
		check_equal(zone.get(field), good, field)
	zone.free()


func _strong(edge: float) -> void:
	zone.edge_width = edge
	zone.wind_force = Vector3(0, 3, 0)
	zone.viscosity = 10.0
	zone.stiffness = 100.0
	# A wave of its own has steps of 2 pi times frequency and amplitude: 0.13 N in a cycle.
	zone.vibration_force = Vector3(0, 0.5, 0)
	zone.vibration_frequency = 40.0
	zone.detent_force = 0.5
