## A wide floor with a material under the hand, and slides over it whose force is read in every servo cycle.
extends "res://hand_shapes_scene.gd"

const DEPTH_M: float = 0.006
const SIZE := Vector3(0.4, 0.1, 0.4)
## Servo cycles a tick of games of 144, 60 and 30 ticks a second.
const GAME_CYCLES: Array[int] = [16, 7, 33]

var _floor: StaticBody3D
var _surface: SpidarGSurface


func _give(body: CollisionObject3D, material: SpidarGMaterial) -> SpidarGSurface:
	var surface := SpidarGSurface.new()
	surface.material = material
	body.add_child(surface)
	return surface


func _set_up_floor(material: SpidarGMaterial) -> void:
	at = Vector3.ZERO
	angle = 0.0
	await set_up_empty(0.4)
	await go(Vector3(0.0, FLOOR_Y + 0.06, 0.0), 20)
	_floor = Solids.static_body(Solids.box(SIZE), Transform3D(Basis.IDENTITY, Vector3(0.0, -0.5 * SIZE.y, 0.0)))
	_floor.position.y = FLOOR_Y
	_surface = _give(_floor, material)
	add(_floor)
	await physics_frames(5)


func _free_all() -> void:
	device.free()
	_floor.free()


func _rest() -> void:
	await go(Vector3(0.0, FLOOR_Y + PAD_RADIUS - DEPTH_M, 0.0), 60)
	await physics_frames(30)


## Rests on the floor and slides at this speed: the force in each servo cycle. The game has a tick each `game_cycles` of them.
func _slide(speed: Vector3, cycle_count: int, game_cycles: int = 16) -> PackedVector3Array:
	await _rest()
	return await _glide(speed, cycle_count, game_cycles)


func _glide(speed: Vector3, cycle_count: int, game_cycles: int = 16) -> PackedVector3Array:
	Engine.physics_ticks_per_second = 1000
	var felt: PackedVector3Array = []
	for i: int in cycle_count:
		at += speed * 0.001
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), angle)
		if i % game_cycles == 0:
			await physics_frames(1)
		else:
			device.advance_cycles(1)
		felt.append(force_of(device.get_simulated_truth()["strings_wrench"]))
	Engine.physics_ticks_per_second = 60
	return felt


func _check_friction(due: float, what: String, game_cycles: int = 16) -> void:
	await physics_frames(20)
	var last: Vector3 = mean_of((await _slide(Vector3(0.04, 0.0, 0.0), 1000, game_cycles)).slice(-500))
	check_near(-last.x / last.y, due, 0.05 * due, what)
	await go(Vector3(0.0, FLOOR_Y + 0.06, 0.0), 20)


static func mean_of(forces: PackedVector3Array) -> Vector3:
	var sum := Vector3.ZERO
	for force: Vector3 in forces:
		sum += force / forces.size()
	return sum


## The frequency that is strongest within 40 % of `near_hz`, in a force of 1000 values a second.
static func peak_hz(forces: PackedVector3Array, axis: int, near_hz: float) -> float:
	var mean: float = mean_of(forces)[axis]
	var best_hz: float = 0.0
	var best: float = -1.0
	for step: int in 161:
		var hz: float = near_hz * (0.6 + 0.005 * step)
		var sum := Vector2.ZERO
		for i: int in forces.size():
			var window: float = 1.0 - cos(TAU * i / forces.size())
			sum += window * (forces[i][axis] - mean) * Vector2.from_angle(TAU * hz * 0.001 * i)
		if sum.length() > best:
			best = sum.length()
			best_hz = hz
	return best_hz
