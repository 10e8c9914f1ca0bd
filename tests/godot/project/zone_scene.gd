## Base of the SpidarGZone tests: an ideal device, a zone, and what the simulated hand feels in each servo cycle.
extends "res://test_case.gd"

const Zone := preload("res://addons/spidar_g/nodes/spidar_g_zone.gd")
const ARMING_CYCLES: int = 1600
const CYCLES_A_TICK: int = 16
## Of a force that should be none: strings that only pull are drawn a little to the middle, N.
const BIAS_N: float = 0.06

var device: SpidarG
var zone: Zone
var at := Vector3.ZERO
## What the strings gave the hand, and what was asked for, in each cycle of the last run() (N, world).
var felt: PackedVector3Array = []
var asked: PackedVector3Array = []
var velocities: PackedVector3Array = []
var places: PackedVector3Array = []


## A box of so many scene metres at the origin.
func set_up(kind: Zone.Kind, size := Vector3(0.12, 0.12, 0.12), workspace_scale: float = 1.0) -> void:
	device = ideal_device()
	device.workspace_scale = workspace_scale
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(ARMING_CYCLES)
	# Its cycles are run one by one, between the ticks of the zone.
	device.process_mode = Node.PROCESS_MODE_DISABLED
	zone = add_zone(kind, size)


func add_zone(kind: Zone.Kind, size := Vector3(0.12, 0.12, 0.12)) -> Zone:
	var made := Zone.new()
	made.kind = kind
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	made.add_child(shape)
	add(made)
	return made


func leave() -> void:
	if is_instance_valid(zone):
		zone.free()
	device.free()
	at = Vector3.ZERO
	await physics_frames(2)


## Moves the hand's target to `to` in so many ticks, and keeps what was felt in each cycle.
func run(ticks: int, to: Vector3 = at) -> void:
	felt.clear()
	asked.clear()
	velocities.clear()
	places.clear()
	var from: Vector3 = at
	for tick: int in ticks:
		at = from.lerp(to, float(tick + 1) / ticks)
		device.set_simulated_hand_target(device.global_transform * Transform3D(Basis.IDENTITY, at), 0.0)
		await physics_frames(1)
		for _cycle: int in CYCLES_A_TICK:
			device.advance_cycles(1)
			var truth: Dictionary = device.get_simulated_truth()
			felt.append(_force(truth["strings_wrench"]))
			asked.append(_force(device.get_requested_wrench()))
			velocities.append(_force(truth["twist"]))
			places.append((truth["grip_transform"] as Transform3D).origin)


## Goes to `to` at so many metres a second of the device, and lets the hand settle.
func go(to: Vector3, speed_m_s: float = 0.1) -> void:
	await run(ceili(at.distance_to(to) / device.workspace_scale / speed_m_s * 1000.0 / CYCLES_A_TICK) + 1, to)
	await run(40)


func mean(of: PackedVector3Array, from: int = 0) -> Vector3:
	var sum := Vector3.ZERO
	for i: int in range(from, of.size()):
		sum += of[i] / (of.size() - from)
	return sum


## Largest change from one cycle to the next.
func largest_step(of: PackedVector3Array) -> float:
	var most: float = 0.0
	for i: int in range(1, of.size()):
		most = maxf(most, of[i].distance_to(of[i - 1]))
	return most


## Largest extent of the hand's way in the last run.
func tremble() -> float:
	var least := Vector3.INF
	var most := -Vector3.INF
	for place: Vector3 in places:
		least = least.min(place)
		most = most.max(place)
	return (most - least).length()


func _force(wrench: PackedFloat64Array) -> Vector3:
	return Vector3(wrench[0], wrench[1], wrench[2])
