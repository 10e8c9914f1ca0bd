extends "res://plays/play.gd"

var _started: PackedStringArray = []


func play() -> void:
	for name: String in ["Drum/Knock", "Motor/Buzz", "Board/Creak"]:
		var player: SpidarGClipPlayer = scene.get_node(name)
		player.started.connect(func(_who: SpidarG) -> void: _started.append(player.name))
	await move_to(Vector3(-0.13, 0.02, 0.0))
	await _knocks(0.2)
	check_equal(_started, PackedStringArray(["Knock"]), "the drum knocks")
	await move_to(Vector3(-0.13, 0.02, 0.0))
	await move_to(Vector3(0.0, 0.02, 0.0))
	_started.clear()
	await move_to(Vector3(0.0, -0.036, 0.0))
	check_equal(_started, PackedStringArray(["Buzz"]), "the motor buzzes")
	var swing: float = await _swing_n(20)
	print("INFO on the motor: the force swings by %.2f N" % swing)
	check(swing > 0.4, "the buzz is felt: %f N" % swing)
	await ticks(90)
	var rest: float = await _swing_n(20)
	check(rest < 0.5 * swing, "and ends: %f N" % rest)
	await move_to(Vector3(0.0, 0.02, 0.0))
	await move_to(Vector3(0.13, 0.02, -0.04))
	await move_to(Vector3(0.13, -0.055, -0.04))
	_started.clear()
	await _slides(Vector3(0.13, -0.055, 0.02))


## Down onto the drum at so many m/s.
func _knocks(speed: float) -> void:
	for _i: int in ceili(0.07 / speed * 60.0):
		mouse.position_m -= Vector3(0.0, speed / 60.0, 0.0)
		await ticks(1)
	await ticks(30)


## The picture is taken while it creaks.
func _slides(to_m: Vector3) -> void:
	var creak: SpidarGClipPlayer = scene.get_node(^"Board/Creak")
	var from_m: Vector3 = mouse.position_m
	for tick: int in 60:
		mouse.position_m = from_m.lerp(to_m, tick / 60.0)
		await ticks(1)
	check(creak.is_playing(), "the board creaks as the hand slides: %s" % [_started])


## How far the force goes up and down in so many ticks, N.
func _swing_n(count: int) -> float:
	var least: float = INF
	var most: float = -INF
	for _i: int in count:
		await ticks(1)
		var up: float = device.get_simulated_truth()["strings_wrench"][1]
		least = minf(least, up)
		most = maxf(most, up)
	return most - least
