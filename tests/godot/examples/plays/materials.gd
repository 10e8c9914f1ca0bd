extends "res://plays/play.gd"

## Device metres. Of a pad; the closed fingers are two of them, side by side.
const PAD_M: float = 0.012
const TOP_M: float = 0.0075 # of a sample, over its middle
const CLEAR_M: float = 0.025 # over a sample, where nothing is felt of it
const DEPTH_M: float = 0.006 # how deep the hand wants to press
const SLIDE_M_S: float = 0.06
const WAY_M := Vector3(0.0075, 0.0, 0.015) # from the middle of a sample to both sides
const LIFT_M_S: float = 0.02
const LEAST_SHAKE_N: float = 0.03 # root mean square

## Of the grip in each servo cycle of the last glide.
var _places: PackedVector3Array = []


func play() -> void:
	# Of the strings only the pull is left: friction and stretch of the samples' device would be measured with the samples.
	device.config.simulated_friction = 0.0
	device.config.simulated_elastic = false
	await ticks(150)
	press(mouse.grasp_action, true)
	await ticks(100)
	await _gives_way("Hard", 0.6 * device.get_stiffness_limits().x)
	await _gives_way("Soft", _material("Soft").stiffness)
	await _damps(_material("Damped").damping)
	await _rubs("Ice", 0.01)
	await _rubs("Rubber", 0.05 * _material("Rubber").dynamic_friction)
	await _sticks_and_slips()
	await _attracts()
	check(absf(await _pull_n("Hard")) < 0.05, "nothing holds the fingers on the hard sample")
	var glued: float = 2.0 * _material("Glue").adhesion # two pads
	# At its top for a few milliseconds alone: then the fingers come off.
	check_near(await _pull_n("Glue"), glued, 0.1 * glued, "the glue's pull on the way up, N")
	await _has_texture("Sandpaper", Vector3.BACK)
	await _has_texture("Ribs", Vector3.RIGHT)
	await move_to(mouse.position_m - Vector3(0.015, 0.0, 0.0))


func _gives_way(name: String, due_n_m: float) -> void:
	var free: Vector3 = await _over(name)
	await _rest_on(name)
	check_near((await felt_n() - free).y / _depth_m(name), due_n_m, 0.05 * due_n_m, "%s gives way, N/m" % name)


## The damped sample is as hard as the hard one: what more is felt of it at speed is its damping.
func _damps(due_n_s_m: float) -> void:
	var damping: float = await _damping_n_s_m("Damped") - await _damping_n_s_m("Hard")
	check_near(damping, due_n_s_m, 0.05 * due_n_s_m, "Damped damps more than Hard, N s/m")


func _rubs(name: String, tolerance: float) -> void:
	var free: Vector3 = await _over(name)
	var felt: Vector3 = mean_of((await _slide(name, Vector3.BACK)).slice(-150)) - free
	check_near(-felt.z / felt.y, _material(name).dynamic_friction, tolerance, "friction of %s" % name)


func _sticks_and_slips() -> void:
	var free: Vector3 = await _over("Rosin")
	var ratios: PackedFloat64Array = []
	for force: Vector3 in (await _slide("Rosin", Vector3.BACK)).slice(-150):
		ratios.append(-(force - free).z / (force - free).y)
	ratios.sort()
	var rosin: SpidarGMaterial = _material("Rosin")
	check_near(ratios[-1], rosin.static_friction, 0.05, "Rosin holds up to")
	check(ratios[0] < rosin.dynamic_friction + 0.1, "and then gives way: down to %.3f" % ratios[0])


func _attracts() -> void:
	await _over("Magnet")
	var magnet: SpidarGMaterial = _material("Magnet")
	var free: Vector3 = await felt_n()
	for gap_m: float in [0.0095, 0.008, 0.0065]:
		await move_to(_top("Magnet") + Vector3(0.0, gap_m, 0.0))
		var felt: Vector3 = await felt_n() - free
		var due_n: float = 2.0 * magnet.magnet_force * (1.0 + _depth_m("Magnet") / (magnet.magnet_range / device.workspace_scale))
		check_near(-felt.y, due_n, 0.05 * due_n, "Magnet, %.1f mm over it, pulls, N" % [-1e3 * _depth_m("Magnet")])


## How hard a sample holds the fingers that lift off.
func _pull_n(name: String) -> float:
	var free: Vector3 = await _over(name)
	await _rest_on(name)
	var most: float = 0.0
	for force: Vector3 in await _glide(Vector3(0.0, LIFT_M_S, 0.0), 1600):
		most = maxf(most, (free - force).y)
	return most


## Drawn over it, the fingers are shaken once at each crest, and more than on ice.
func _has_texture(name: String, along: Vector3) -> void:
	await _over("Ice")
	var calm_n: float = _shake_n(_last(await _slide("Ice", along)), along)
	await _over(name)
	var felt: PackedVector3Array = _last(await _slide(name, along))
	var shake_n: float = _shake_n(felt, along)
	print("INFO %s shakes by %.3f N, Ice by %.3f N" % [name, shake_n, calm_n])
	check(shake_n > LEAST_SHAKE_N and shake_n > 3.0 * calm_n, "%s shakes: %.3f N, and ice %.3f N" % [name, shake_n, calm_n])
	var due_m: float = _material(name).texture_wavelength / device.workspace_scale
	check_near(1e3 * _felt_wave_m(felt, along, due_m), 1e3 * due_m, 50.0 * due_m, "%s from crest to crest, mm" % name)


## The wavelength that is strongest in the force along the way, over the last places of the grip, within a third of `near_m`.
func _felt_wave_m(forces: PackedVector3Array, along: Vector3, near_m: float) -> float:
	var mean: float = mean_of(forces).dot(along)
	var places: PackedVector3Array = _places.slice(-forces.size())
	var best := Vector2.ZERO # wavelength, strength
	for step: int in range(-60, 61):
		var wave_m: float = near_m * (1.0 + step / 180.0)
		var sum := Vector2.ZERO
		for i: int in forces.size():
			var window: float = 1.0 - cos(TAU * i / forces.size())
			sum += window * (forces[i].dot(along) - mean) * Vector2.from_angle(TAU * places[i].dot(along) / wave_m)
		best = Vector2(wave_m, sum.length()) if sum.length() > best.y else best
	return best.x


## Where the fingers slip, which takes some way at first.
static func _last(forces: PackedVector3Array) -> PackedVector3Array:
	return forces.slice(roundi(0.4 * forces.size()))


func _material(name: String) -> SpidarGMaterial:
	return (scene.get_node(name + "/Surface") as SpidarGSurface).material


## Goes to a place clear over the sample; what is felt there.
func _over(name: String) -> Vector3:
	await move_to(Vector3(mouse.position_m.x, 0.02, mouse.position_m.z))
	await move_to(_top(name) + Vector3(0.0, CLEAR_M, 0.0))
	return await felt_n()


func _rest_on(name: String) -> void:
	await move_to(_top(name) - Vector3(0.0, DEPTH_M, 0.0))


## Where the middle of the closed fingers is when they just touch the sample, in device metres.
func _top(name: String) -> Vector3:
	return in_device((scene.get_node(name) as Node3D).position) + Vector3(0.0, TOP_M + PAD_M, 0.0)


func _depth_m(name: String) -> float:
	return _top(name).y - _grip_m().y


func _grip_m() -> Vector3:
	return in_device((device.get_simulated_truth()["grip_transform"] as Transform3D).origin)


## From one end of the sample to the other: the force in each servo cycle.
func _slide(name: String, along: Vector3) -> PackedVector3Array:
	await move_to(_top(name) + Vector3(0.0, CLEAR_M, 0.0) - WAY_M * along)
	await move_to(_top(name) - Vector3(0.0, DEPTH_M, 0.0) - WAY_M * along)
	return await _glide(SLIDE_M_S * along, roundi(2.0 * (WAY_M * along).length() / SLIDE_M_S / 0.001))


## The hand goes on at this speed: what it feels in each servo cycle.
func _glide(speed: Vector3, cycle_count: int) -> PackedVector3Array:
	var felt: PackedVector3Array = []
	_places.clear()
	Engine.physics_ticks_per_second = 1000
	for i: int in cycle_count:
		mouse.position_m += speed * 0.001
		await _cycle(i)
		felt.append(_felt_now_n())
		_places.append(_grip_m())
	Engine.physics_ticks_per_second = 60
	return felt


## The game has a tick each 16 cycles.
func _cycle(i: int) -> void:
	if i % 16 == 0:
		await ticks(1)
	else:
		device.set_simulated_hand_target(mouse.get_target(), mouse.grasp_angle_rad)
		device.advance_cycles(1)


func _felt_now_n() -> Vector3:
	var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
	return Vector3(felt[0], felt[1], felt[2])


## The hand presses on the sample by a sine of 1 Hz. Over a whole swing depth and speed have nothing in common: what of the
## force goes with the speed is the damping.
func _damping_n_s_m(name: String) -> float:
	await _over(name)
	await _rest_on(name)
	var force_by_speed: float = 0.0
	var speed_squared: float = 0.0
	Engine.physics_ticks_per_second = 1000
	for i: int in 2000:
		var before_m: float = _depth_m(name)
		mouse.position_m.y = _top(name).y - 0.012 - 0.008 * sin(TAU * i * 0.001)
		await _cycle(i)
		if i >= 1000:
			var speed_m_s: float = (_depth_m(name) - before_m) / 0.001
			force_by_speed += speed_m_s * _felt_now_n().y
			speed_squared += speed_m_s * speed_m_s
	Engine.physics_ticks_per_second = 60
	return force_by_speed / speed_squared


## Root mean square of the force along the way, without its mean.
static func _shake_n(forces: PackedVector3Array, along: Vector3) -> float:
	var mean: Vector3 = mean_of(forces)
	var sum: float = 0.0
	for force: Vector3 in forces:
		sum += (force - mean).dot(along) ** 2 / forces.size()
	return sqrt(sum)


static func mean_of(forces: PackedVector3Array) -> Vector3:
	var sum := Vector3.ZERO
	for force: Vector3 in forces:
		sum += force / forces.size()
	return sum
