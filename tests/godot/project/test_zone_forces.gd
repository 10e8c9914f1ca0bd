## SpidarGZone: what the simulated hand feels inside of each kind of zone.
extends "res://zone_scene.gd"


func test_thick_air_resists_by_the_velocity() -> void:
	for workspace_scale: float in [1.0, 4.0]:
		await set_up(Zone.Kind.VISCOSITY, Vector3(0.3, 0.2, 0.2) * workspace_scale, workspace_scale)
		zone.viscosity = 5.0
		await go(Vector3(-0.08, 0, 0) * workspace_scale)
		var still: Vector3 = mean(felt, 320)
		check(still.length() < BIAS_N, "nothing in a still hand: %s" % still)
		await run(50, Vector3(0.08, 0, 0) * workspace_scale)
		# The strings' own bias drops out against the same way without a zone.
		var with_zone: Vector3 = _mean_in_the_middle(felt, workspace_scale)
		var speed: float = _mean_in_the_middle(velocities, workspace_scale).x
		zone.enabled = false
		await go(Vector3(-0.08, 0, 0) * workspace_scale)
		await run(50, Vector3(0.08, 0, 0) * workspace_scale)
		var drag: float = _mean_in_the_middle(felt, workspace_scale).x - with_zone.x
		print("INFO viscosity at scale %s: %.3f N at %.3f m/s" % [workspace_scale, drag, speed])
		check(speed > 0.15, "the hand moves: %f m/s" % speed)
		check_near(drag, 5.0 * speed, 0.05 * 5.0 * speed, "gain times velocity, scale %s" % workspace_scale)
		await leave()


func test_wind_blows_along_the_axes_of_the_zone() -> void:
	await set_up(Zone.Kind.WIND)
	zone.wind_force = Vector3(1.2, 0, 0)
	for turn: float in [0.0, PI / 2.0, 0.7]:
		zone.basis = Basis(Vector3.UP, turn)
		await go(Vector3.ZERO)
		var wanted: Vector3 = zone.basis * zone.wind_force
		var blown: Vector3 = mean(felt, 320)
		check_near(blown.distance_to(wanted), 0.0, 0.05 * 1.2, "turned by %s rad: %s N" % [turn, blown])
	zone.basis = Basis.IDENTITY
	zone.scale = Vector3(2, 2, 2)
	await go(Vector3.ZERO)
	check_near(mean(felt, 320).length(), 1.2, 0.05 * 1.2, "the zone's scale is none of the force")
	zone.scale = Vector3.ONE
	await go(Vector3(0, 0.09, 0))
	check(mean(felt, 320).length() < BIAS_N, "zero outside: %s" % mean(felt, 320))
	check_near(mean(asked, 320).length(), 0.0, 1e-6, "and nothing asked for")
	await leave()


func test_a_magnet_pulls_to_the_zones_origin() -> void:
	for workspace_scale: float in [1.0, 3.0]:
		await set_up(Zone.Kind.MAGNET_POINT, Vector3.ONE * 0.12 * workspace_scale, workspace_scale)
		zone.stiffness = 60.0
		zone.position = Vector3(0.01, 0, 0) * workspace_scale
		await go(Vector3(0.01, 0.03, -0.02) * workspace_scale)
		var away: Vector3 = (mean(places, 320) - zone.position) / workspace_scale
		check(away.length() > 0.02, "away: %s m" % away)
		var pull: Vector3 = mean(felt, 320)
		check_near(pull.distance_to(-60.0 * away), 0.0, 0.05 * 60.0 * away.length(), "scale %s: pulls %s N" % [workspace_scale, pull])
		await go(Vector3(0.01, 0.09, 0) * workspace_scale)
		check(mean(felt, 320).length() < BIAS_N, "zero outside: %s" % mean(felt, 320))
		check_near(mean(asked, 320).length(), 0.0, 1e-6, "and nothing asked for")
		await leave()


func test_a_magnet_to_an_axis_is_free_along_it() -> void:
	for tilt: Vector3 in [Vector3.ZERO, Vector3(PI / 2.0, 0, 0), Vector3(0, 0, 0.6), Vector3(0.5, 0.3, 0.4)]:
		await set_up(Zone.Kind.MAGNET_AXIS, Vector3(0.12, 0.24, 0.12))
		zone.stiffness = 100.0
		zone.basis = Basis.from_euler(tilt)
		var axis: Vector3 = zone.basis.y
		var across: Vector3 = zone.basis.x
		await go(across * 0.03)
		var away: Vector3 = mean(places, 320)
		away -= axis * axis.dot(away)
		var pull: Vector3 = mean(felt, 320)
		check(away.length() > 0.015, "tilt %s: away %s m" % [tilt, away])
		check_near(pull.distance_to(-100.0 * away), 0.0, 0.05 * 100.0 * away.length() + 0.02, "tilt %s: pulls %s N, away %s m" % [tilt, pull, away])
		await go(axis * -0.05)
		await run(32, axis * 0.05)
		var along: float = 0.0
		for i: int in range(120, felt.size()):
			along = maxf(along, absf(asked[i].dot(axis)))
		print("INFO tilt %s: %.3f N across, at most %.3f N along the axis at 0.2 m/s" % [tilt, pull.length(), along])
		check(along < 0.12, "tilt %s: free along the axis: %f N" % [tilt, along])
		await leave()


func test_a_vibration_has_its_frequency_and_amplitude() -> void:
	await set_up(Zone.Kind.VIBRATION)
	for told: Array in [[30.0, 1.0], [80.0, 0.8]]:
		zone.vibration_frequency = told[0]
		zone.vibration_force = Vector3(0, told[1], 0)
		await go(Vector3.ZERO)
		await run(60)
		var crossings: int = 0
		var squares: float = 0.0
		var asked_squares: float = 0.0
		for i: int in range(1, felt.size()):
			crossings += int(felt[i].y > 0.0 and felt[i - 1].y <= 0.0)
			squares += felt[i].y ** 2
			asked_squares += asked[i].y ** 2
		var hz: float = crossings * 1000.0 / felt.size()
		var amplitude: float = sqrt(2.0 * squares / felt.size())
		print("INFO vibration of %s Hz, %s N: %.1f Hz, %.3f N felt, %.3f N asked" % [told[0], told[1], hz, amplitude, sqrt(2.0 * asked_squares / felt.size())])
		check_near(hz, told[0], 1.5, "frequency")
		check_near(amplitude, told[1], 0.1 * told[1], "amplitude")
	await leave()


func test_detents_have_their_spacing() -> void:
	await set_up(Zone.Kind.DETENTS)
	zone.detent_spacing = 0.01
	zone.detent_force = 0.4
	# Its x axis along the device's z.
	zone.basis = Basis(Vector3.UP, PI / 2.0)
	await go(Vector3(0, 0, -0.03))
	await run(240, Vector3(0, 0, 0.03))
	var changes: int = 0
	var most: float = 0.0
	var side: float = 0.0
	for i: int in asked.size():
		most = maxf(most, absf(asked[i].z))
		if absf(asked[i].z) > 0.15:
			changes += int(side != 0.0 and signf(asked[i].z) != side)
			side = signf(asked[i].z)
		check(absf(asked[i].x) < 1e-6, "nothing across")
	check(changes >= 8 and changes <= 14, "%d changes of sign on 60 mm" % changes)
	check_near(most, 0.4, 0.02, "as strong as told")
	await leave()


func test_no_force_is_larger_than_the_largest() -> void:
	for kind: Zone.Kind in [Zone.Kind.WIND, Zone.Kind.MAGNET_POINT, Zone.Kind.MAGNET_AXIS, Zone.Kind.VISCOSITY, Zone.Kind.VIBRATION, Zone.Kind.DETENTS]:
		await set_up(kind, Vector3(0.2, 0.2, 0.2))
		zone.max_force = 0.6
		zone.wind_force = Vector3(5, 0, 0)
		zone.stiffness = 200.0
		zone.viscosity = 10.0
		zone.vibration_force = Vector3(0, 2, 0)
		zone.detent_force = 3.0
		await go(Vector3(-0.05, 0, 0))
		await run(50, Vector3(0.05, 0, 0))
		var most: float = 0.0
		for force: Vector3 in asked:
			most = maxf(most, force.length())
		# The viscosity meets a hand that starts at once.
		var share: float = 1.33 if kind == Zone.Kind.VISCOSITY else 1.1
		check(most > 0.4 and most < 0.6 * share, "%s: %f N" % [Zone.Kind.keys()[kind], most])
		await leave()


## Of the cycles in which the hand is near the middle of its way.
func _mean_in_the_middle(of: PackedVector3Array, workspace_scale: float) -> Vector3:
	var sum := Vector3.ZERO
	var count: int = 0
	for i: int in of.size():
		if absf(places[i].x) < 0.03 * workspace_scale:
			sum += of[i]
			count += 1
	return sum / maxi(1, count)
