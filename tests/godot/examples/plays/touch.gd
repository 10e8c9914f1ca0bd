extends "res://plays/play.gd"

## Of a pad, and of its rounded edge. Meters of the scene, as all lengths here.
const PAD_M: float = 0.024
const ROUND_M: float = 0.006
const HILL_M: float = 0.03


func play() -> void:
	press(mouse.grasp_action, true)
	await ticks(100)
	await _rides_over_hills()
	for z: float in [0.01, -0.01]:
		await _touches("Cylinder", Vector3(0.0, 0.06, z), Vector3.UP)
	await _touches("Cylinder", Vector3(0.0, 0.005, 0.06), Vector3.BACK)
	await _touches("Box", Vector3(0.0, 0.0575, 0.0), Vector3.UP)
	await _touches("Box", Vector3(0.0, 0.005, 0.06), Vector3.BACK)
	for lean: Vector3 in [Vector3.UP, Vector3(0.0, 1.0, 1.0), Vector3(0.0, 1.0, -1.0)] as Array[Vector3]:
		await _touches("Ball", 0.06 * lean.normalized(), lean.normalized())


## The hand goes from a place beside a body against it, and is pushed back along `out` by that body alone.
func _touches(name: String, beside: Vector3, out: Vector3) -> void:
	var body: Node3D = scene.get_node(name)
	var from: Vector3 = body.position + beside
	await move_to(Vector3(mouse.position_m.x, 0.03, mouse.position_m.z + 0.01))
	await move_to(in_device(Vector3(from.x, 0.08, from.z + 0.02)))
	var felt: Vector3 = await presses(in_device(from), in_device(from - 0.03 * out), 1.0)
	check(rad_to_deg(felt.angle_to(out)) < 10.0, "%s pushes out of itself: %s N, %s" % [name, felt, out])
	for point: Dictionary in hand.get_touch_points():
		if not (point["force"] as Vector3).is_zero_approx():
			check_equal(point["collider"], body, "it is the %s that is felt" % name)


## The closed fingers are drawn along between two rows of hills, and ride where discs of their size would. A crest would spread them.
func _rides_over_hills() -> void:
	var sheet: Node3D = scene.get_node(^"Bumps")
	await move_to(in_device(sheet.position + Vector3(-0.5 * HILL_M, 0.08, -HILL_M)))
	await _until_ready()
	await presses(mouse.position_m, in_device(sheet.position + Vector3(-0.5 * HILL_M, 0.018, -HILL_M)), 1.0)
	var most_off_m: float = 0.0
	for step: int in 97:
		mouse.position_m.z = in_device(sheet.position).z + lerpf(-HILL_M, HILL_M, step / 96.0) / device.workspace_scale
		await ticks(3)
		var at: Vector3 = hand.get_proxy_transform().origin - sheet.position
		most_off_m = maxf(most_off_m, absf(at.y - _height_of_discs_m(at.x, at.z)))
	print("INFO over the hills: the fingers are at most %.2f mm off where discs would lie" % [1e3 * most_off_m])
	check(most_off_m < 0.0006, "the fingers ride over the hills: %.5f m off" % most_off_m)


## A large mesh is made ready beside the game, which a play runs ahead of.
func _until_ready() -> void:
	var deadline_ms: int = Time.get_ticks_msec() + 5000
	while hand.get_touch_statistics()["shapes_cooking"] > 0 and Time.get_ticks_msec() < deadline_ms:
		OS.delay_msec(1)
		await ticks(1)


## How high the middle of two discs, side by side, lies over the foot of the hills. Their edges are rounded by half their thickness.
func _height_of_discs_m(x: float, z: float) -> float:
	var height: float = 0.0
	for across: int in range(-12, 13):
		var from_middle: float = fposmod(absf(across) * 0.001, 2.0 * ROUND_M) - ROUND_M
		var rim: float = PAD_M - ROUND_M + sqrt(ROUND_M * ROUND_M - from_middle * from_middle)
		for along: int in range(-22, 23):
			var dz: float = 0.001 * along
			if absf(dz) < rim:
				height = maxf(height, _hill_m(x + 0.001 * across, z + dz) + sqrt(rim * rim - dz * dz))
	return height


## As examples/touch/bumps.gd has them.
static func _hill_m(x: float, z: float) -> float:
	return 0.0025 * (1.0 + cos(TAU * x / HILL_M)) * (1.0 + cos(TAU * z / HILL_M))
