## SpidarGHand under a hand that flails among bodies: whatever it does, forces stay finite and bounded, nothing is thrown.
extends "res://hand_scene.gd"

## As far as fingers go; closing to the hinge's stop (1.4 rad) off-centre can end in the device's speed limit.
const CLOSED_ANGLE: float = 1.0
const SEEDS: int = 8
const FRAMES: int = 600
## A body this fast was thrown by the solver, not by a hand that moves below 1 m/s (device default: cut at 2 m/s).
const MOST_SPEED_M_S: float = 2.5


func test_a_flailing_hand_stays_bounded() -> void:
	var all_grasps: int = 0
	for seed_value: int in range(1, SEEDS + 1):
		var random := RandomNumberGenerator.new()
		random.seed = seed_value
		at = Vector3.ZERO
		angle = 0.0
		elastic = true
		friction_n = 0.05  # The device as it comes; without any, squeezing hard in a far corner saturates and faults.
		await set_up(Vector3.ZERO)
		var bodies: Array[RigidBody3D] = []
		for i: int in 6:
			var size := Vector3(random.randf_range(0.01, 0.06), random.randf_range(0.02, 0.05), random.randf_range(0.01, 0.06))
			var spot := Vector2.from_angle(TAU * i / 6.0) * 0.08
			bodies.append(add_free_box(size, random.randf_range(0.02, 0.3), spot.x, spot.y))
		add_box(Vector3(0.02, 0.1, 0.3), Vector3(0.13, FLOOR_Y + 0.05, 0.0), 0.0)
		var grasps: Array[int] = [0]
		hand.body_grasped.connect(func(_body: RigidBody3D) -> void: grasps[0] += 1)
		var worst_force: float = 0.0
		var worst_speed: float = 0.0
		var finite: bool = true
		var wild: bool = false
		var goal := Vector3.ZERO
		var aim := Vector3.ZERO
		var close: float = 0.0
		for frame: int in FRAMES:
			# Every other round an honest try: above a body, down, close, up; else anywhere, open or closed.
			if frame % 120 == 0:
				wild = random.randf() < 0.4
				goal = bodies[random.randi() % bodies.size()].global_position
			if wild and frame % 30 == 0:
				aim = Vector3(
					random.randf_range(-0.12, 0.12), random.randf_range(-0.11, 0.1), random.randf_range(-0.12, 0.12)
				)
				close = CLOSED_ANGLE if random.randf() < 0.5 else 0.0
			elif not wild:
				var part: int = (frame % 120) / 30
				aim = goal if part == 1 or part == 2 else Vector3(goal.x, 0.0, goal.z)
				close = CLOSED_ANGLE if part >= 2 else 0.0
			at = at.move_toward(aim, 0.008)
			angle = move_toward(angle, close, 0.06)
			var tilt := Basis(Vector3.UP, 0.6 * sin(0.02 * frame))
			device.set_simulated_hand_target(Transform3D(tilt, at), angle)
			if frame % 150 == 149:
				var doomed: RigidBody3D = bodies.pop_back()
				doomed.free()  # Held or not.
			await physics_frames(1)
			var asked: PackedFloat64Array = device.get_requested_wrench()
			var force := Vector3(asked[0], asked[1], asked[2])
			finite = finite and force.is_finite()
			worst_force = maxf(worst_force, force.length())
			for body: RigidBody3D in bodies:
				finite = finite and body.global_position.is_finite()
				worst_speed = maxf(worst_speed, body.linear_velocity.length())
		print("INFO seed %d: %d grasps, worst force %.2f N, worst speed %.2f m/s" % [seed_value, grasps[0], worst_force, worst_speed])
		check(finite, "seed %d: all stays finite" % seed_value)
		check(device.get_state() == SpidarG.STATE_ACTIVE, "seed %d: %s" % [seed_value, device.get_fault_text()])
		check(worst_force <= device.config.max_force + 1e-6, "seed %d: force %f N" % [seed_value, worst_force])
		check(worst_speed < MOST_SPEED_M_S, "seed %d: speed %f m/s" % [seed_value, worst_speed])
		all_grasps += grasps[0]
		for node: Node in tree.root.get_children():
			if node is Node3D:
				node.queue_free()
		await physics_frames(2)
	check(all_grasps > 0, "some tries grasp")
