## Each property of a SpidarGMaterial as a force on the simulated hand, in games of 30, 60 and 144 ticks a second; and what
## changes while the hand touches.
extends "res://material_floor.gd"

## In a servo cycle. Without a fade the changes below step by 0.6 N and more.
const MOST_STEP_N: float = 0.2


func test_a_soft_surface_gives_way_by_its_stiffness() -> void:
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.stiffness = 200.0
		await _set_up_floor(material)
		await _rest()
		var felt: Vector3 = mean_of(await _glide(Vector3.ZERO, 400, game_cycles))
		var depth: float = FLOOR_Y + PAD_RADIUS - device.get_grip_transform().origin.y
		check(depth > 0.001, "pressed in by %.1f mm" % (1e3 * depth))
		check_near(felt.y, 200.0 * depth, 0.05 * felt.y, "200 N/m under both pads, %d cycles a tick" % game_cycles)
		_free_all()
		await physics_frames(2)


func test_damping_is_felt_while_the_hand_presses() -> void:
	for game_cycles: int in GAME_CYCLES:
		var found: Array[float] = []
		for damping: float in [0.0, 0.8]:
			var material := SpidarGMaterial.new()
			material.stiffness = 200.0
			material.damping = damping
			await _set_up_floor(material)
			await _rest()
			var still: Vector3 = mean_of(await _glide(Vector3.ZERO, 400, game_cycles))
			var n_m: float = still.y / (FLOOR_Y + PAD_RADIUS - device.get_grip_transform().origin.y)
			# Slow enough to be steady, and for a while, so that the encoders' steps do not count.
			var beyond: float = 0.0
			var speed: float = 0.0
			for _i: int in 300:
				var felt: Vector3 = (await _glide(Vector3(0.0, -0.03, 0.0), 1, game_cycles))[0]
				beyond += felt.y - n_m * (FLOOR_Y + PAD_RADIUS - device.get_grip_transform().origin.y)
				speed -= device.get_linear_velocity().y
			found.append(beyond / speed)
			_free_all()
			await physics_frames(2)
		check_near(found[1] - found[0], 0.8, 0.12, "N s/m more: %.2f and %.2f, %d cycles a tick" % [found[0], found[1], game_cycles])


func test_static_friction_at_each_rate() -> void:
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.dynamic_friction = 0.2
		material.static_friction = 0.7
		await _set_up_floor(material)
		var most: float = 0.0
		for force: Vector3 in await _slide(Vector3(0.02, 0.0, 0.0), 800, game_cycles):
			most = maxf(most, -force.x / force.y)
		check_near(most, 0.7, 0.035, "%d cycles a tick" % game_cycles)
		_free_all()
		await physics_frames(2)


func test_stick_slip_at_each_rate() -> void:
	var rates: Array[float] = []
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.dynamic_friction = 0.2
		material.static_friction = 0.8
		material.stick_slip = true
		await _set_up_floor(material)
		var cycles: PackedVector3Array = (await _slide(Vector3(0.04, 0.0, 0.0), 2000, game_cycles)).slice(500)
		rates.append(_slips_hz(cycles))
		_free_all()
		await physics_frames(2)
	print("INFO stick-slip at 60, 144, 30 ticks: %s Hz" % [rates])
	for hz: float in rates:
		check_near(hz, rates[0], 0.1 * rates[0], "as at 60 ticks")


func test_adhesion_at_each_rate() -> void:
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.adhesion = 1.0
		await _set_up_floor(material)
		await _rest()
		var most: float = 0.0
		for force: Vector3 in await _glide(Vector3(0.0, 0.01, 0.0), 2000, game_cycles):
			most = maxf(most, -force.y)
		check_near(most, 2.0, 0.1, "two pads come off at 1 N each, %d cycles a tick" % game_cycles)
		_free_all()
		await physics_frames(2)


func test_a_magnet_at_each_rate() -> void:
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.magnet_force = 1.0
		material.magnet_range = 0.02
		await _set_up_floor(material)
		await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS + 0.014, 0.0), 60)
		await physics_frames(30)
		var felt: Vector3 = mean_of(await _glide(Vector3.ZERO, 400, game_cycles))
		var height: float = device.get_grip_transform().origin.y - FLOOR_Y - PAD_RADIUS
		var due: float = 2.0 * clampf(1.0 - height / 0.02, 0.0, 1.0)
		check_near(-felt.y, due, 0.05 * due + 0.02, "%.1f mm over it" % (1e3 * height))
		_free_all()
		await physics_frames(2)


func test_ridges_of_an_image_are_felt_at_their_rate() -> void:
	for game_cycles: int in GAME_CYCLES:
		var material := SpidarGMaterial.new()
		material.dynamic_friction = 0.0
		material.texture_image = _ridges(64, 4)
		material.texture_wavelength = 0.024 # four ridges: 6 mm each
		material.texture_depth = 0.0003
		await _set_up_floor(material)
		var cycles: PackedVector3Array = (await _slide(Vector3(0.0, 0.0, 0.06), 1800, game_cycles)).slice(300)
		var due_hz: float = 0.06 / 0.006
		check_near(peak_hz(cycles, 1, due_hz), due_hz, 0.02 * due_hz, "press")
		check_near(peak_hz(cycles, 2, due_hz), due_hz, 0.02 * due_hz, "along")
		_free_all()
		await physics_frames(2)


func test_an_image_that_is_ready_later_or_unusable() -> void:
	var material := SpidarGMaterial.new()
	material.texture_wavelength = 0.024
	material.texture_depth = 0.0003
	var changes: Array[int] = [0]
	material.changed.connect(func() -> void: changes[0] += 1)
	var image := ImageTexture.new() # nothing in it yet
	material.texture_image = image
	check_equal(changes[0], 1, "one change")
	await _set_up_floor(material)
	await _rest()
	check(force_of(await mean_felt(10)).y > 0.3, "felt without it")
	image.set_image(_ridges(64, 4).get_image())
	check_equal(changes[0], 2, "and one when the image came")
	await physics_frames(10)
	check(force_of(await mean_felt(10)).y > 0.3, "felt with it")
	material.texture_image = ImageTexture.create_from_image(Image.create_empty(2, 2, false, Image.FORMAT_L8))
	await physics_frames(5)
	check(force_of(await mean_felt(10)).y > 0.3, "an image of 2 by 2 pixels is refused, and the floor is there")
	material.texture_image = null
	await physics_frames(5)
	check(force_of(await mean_felt(10)).y > 0.3, "and without any")


func test_a_change_while_the_hand_rests_comes_without_a_jolt() -> void:
	for change: Dictionary in [
		{"stiffness": 200.0}, {"damping": 2.0}, {"dynamic_friction": 1.5}, {"adhesion": 2.0}, {"magnet_force": 2.0},
		{"texture_wavelength": 0.005, "texture_depth": 0.0005},
	]:
		var material := SpidarGMaterial.new()
		material.dynamic_friction = 0.3
		await _set_up_floor(material)
		var usual: float = _most_step((await _slide(Vector3(0.02, 0.0, 0.0), 400)).slice(200))
		for property: String in change:
			material.set(property, change[property])
		var felt: PackedVector3Array = await _glide(Vector3(0.02, 0.0, 0.0), 200)
		check(_most_step(felt) < usual + MOST_STEP_N, "%s: steps of %.3f N, %.3f N before" % [change, _most_step(felt), usual])
		_free_all()
		await physics_frames(2)
	for stiffness: float in [150.0, 0.0]:
		await _set_up_floor(null)
		hand.contact_stiffness = 0.0 if stiffness > 0.0 else 150.0
		var usual: float = _most_step((await _slide(Vector3(0.02, 0.0, 0.0), 400)).slice(200))
		hand.contact_stiffness = stiffness
		var felt: PackedVector3Array = await _glide(Vector3(0.02, 0.0, 0.0), 200)
		check(_most_step(felt) < usual + MOST_STEP_N, "the hand's stiffness: steps of %.3f N, %.3f N before" % [_most_step(felt), usual])
		_free_all()
		await physics_frames(2)


## How often the drag falls through half of what it holds.
static func _slips_hz(felt: PackedVector3Array) -> float:
	var falls: PackedInt32Array = []
	var held: bool = false
	for i: int in felt.size():
		var ratio: float = -felt[i].x / felt[i].y
		if held and ratio < 0.4:
			falls.append(i)
		held = ratio > 0.6 or (held and ratio >= 0.4)
	return 1000.0 * (falls.size() - 1) / (falls[-1] - falls[0]) if falls.size() > 1 else 0.0


static func _most_step(felt: PackedVector3Array) -> float:
	var most: float = 0.0
	for i: int in range(1, felt.size()):
		most = maxf(most, felt[i].distance_to(felt[i - 1]))
	return most


## Waves downwards in the image, which lie along Z on a floor.
static func _ridges(pixels: int, waves: int) -> ImageTexture:
	var image := Image.create_empty(pixels, pixels, false, Image.FORMAT_L8)
	for y: int in pixels:
		var height: float = 0.5 + 0.5 * cos(TAU * waves * y / pixels)
		for x: int in pixels:
			image.set_pixel(x, y, Color(height, height, height))
	return ImageTexture.create_from_image(image)
