## Base of the SpidarGHand tests: a stepped device, a hand, a floor and boxes, at 1:1 scale.
extends "res://test_case.gd"

## Top of the floor in the world, and so the rest height of a box's underside.
const FLOOR_Y: float = -0.08
const GRAVITY: float = 9.8
## Closes past any stop, so that the hand squeezes.
const SQUEEZE_ANGLE: float = 1.4
## Arming takes one second.
const ARMING_FRAMES: int = 70

var device: SpidarG
var hand: SpidarGHand
## Of the simulated device, before set_up().
var elastic: bool = false
var friction_n: float = 0.0
var firmness: SpidarG.HandFirmness = SpidarG.HAND_NORMAL
var preset: int = 0
var scale: float = 1.0
var grasp_source: SpidarGConfig.GraspSource = SpidarGConfig.GRASP_AUTOMATIC
var at: Vector3 = Vector3.ZERO
var angle: float = 0.0


## A device with forces on, its hand at `start`, settled.
func set_up(start: Vector3, forces: bool = true) -> void:
	device = ideal_device()
	device.config.simulated_elastic = elastic
	device.config.simulated_friction = friction_n
	device.config.simulated_hand_firmness = firmness
	device.config.preset = preset
	device.config.grasp_source = grasp_source
	device.workspace_scale = scale
	device.forces_enabled = forces
	hand = SpidarGHand.new()
	device.add_child(hand)
	add(device)
	add_box(Vector3(1.0, 0.1, 1.0), Vector3(0.0, FLOOR_Y - 0.05, 0.0), 0.0)
	await move_to(start, 0.0, 10)
	await physics_frames(ARMING_FRAMES)


## mass 0: a static body.
func add_box(size: Vector3, position: Vector3, mass: float) -> PhysicsBody3D:
	var body: PhysicsBody3D
	if mass > 0.0:
		var rigid := RigidBody3D.new()
		rigid.mass = mass
		body = rigid
	else:
		body = StaticBody3D.new()
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = size
	shape.shape = box
	body.add_child(shape)
	body.position = position
	add(body)
	return body


## A free box standing on the floor under (x, z).
func add_free_box(size: Vector3, mass: float, x: float = 0.0, z: float = 0.0) -> RigidBody3D:
	return add_box(size, Vector3(x, FLOOR_Y + 0.5 * size.y + 0.0005, z), mass) as RigidBody3D


## Moves the simulated hand's target in a straight line.
func move_to(to: Vector3, to_angle: float, frame_count: int) -> void:
	var from: Vector3 = at
	var from_angle: float = angle
	for i: int in frame_count:
		var part: float = float(i + 1) / frame_count
		at = from.lerp(to, part)
		angle = lerpf(from_angle, to_angle, part)
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), angle)
		await physics_frames(1)


## Mean of what the hand feels over some frames: [fx fy fz mx my mz grasp_torque].
func mean_felt(frame_count: int) -> PackedFloat64Array:
	var sum: PackedFloat64Array = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
	for _i: int in frame_count:
		await physics_frames(1)
		var felt: PackedFloat64Array = device.get_simulated_truth()["strings_wrench"]
		for k: int in 7:
			sum[k] += felt[k] / frame_count
	return sum


## Reaches round `body` from above and closes on it.
func grasp(body: RigidBody3D) -> void:
	await move_to(body.global_position, 0.0, 60)
	await move_to(body.global_position, SQUEEZE_ANGLE, 40)
	await physics_frames(40)


## Largest peak-to-peak motion of the true grip (m) over some frames, its target at rest.
func tremble(frame_count: int) -> float:
	var least := Vector3.INF
	var most := -Vector3.INF
	for _i: int in frame_count:
		await physics_frames(1)
		var grip: Transform3D = device.get_simulated_truth()["grip_transform"]
		least = least.min(grip.origin)
		most = most.max(grip.origin)
	return (most - least).length()


## Ids of the shapes that push the tool now.
func touched() -> Array:
	var ids: Array = []
	for point: Dictionary in hand.get_touch_points():
		var force: Vector3 = point["force"]
		if not force.is_zero_approx() and not ids.has(point["id"]):
			ids.append(point["id"])
	return ids
