## SpidarGHand on elastic strings without friction, the hardest plant, with every hand: nothing may buzz.
extends "res://hand_scene.gd"

## The limit at which research calls a contact unstable (peak to peak).
const MOST_TREMBLE_M: float = 0.0004
const PAD_RADIUS: float = 0.012
const HANDS: Dictionary[SpidarG.HandFirmness, String] = {
	SpidarG.HAND_LIGHT: "light", SpidarG.HAND_NORMAL: "normal", SpidarG.HAND_FIRM: "firm"
}


func test_resting_on_the_floor_does_not_tremble() -> void:
	for kind: SpidarG.HandFirmness in HANDS:
		await _set_up(kind)
		await move_to(Vector3(0.0, FLOOR_Y + PAD_RADIUS - 0.02, 0.0), 0.0, 60)
		await physics_frames(60)
		await _check_still("%s hand on the floor" % HANDS[kind])
		await _clear()


func test_carrying_does_not_tremble() -> void:
	for kind: SpidarG.HandFirmness in HANDS:
		for mass: float in [0.05, 0.12, 0.25]:
			await _set_up(kind)
			var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), mass)
			await physics_frames(10)
			# The light hand yields under the floor's and the body's forces: aim where the body is.
			await grasp(body)
			var held: bool = hand.get_held_body() == body
			print("INFO %s hand, %.2f kg: squeeze %.3f N m" % [HANDS[kind], mass, hand.get_squeeze_torque()])
			if held:
				await move_to(at + Vector3(0.0, 0.06, 0.0), SQUEEZE_ANGLE, 40)
				await physics_frames(60)
				await _check_still("%s hand carrying %.2f kg" % [HANDS[kind], mass])
				check_equal(hand.get_held_body(), body, "still held")
			check(held or kind == SpidarG.HAND_LIGHT, "%s hand holds %.2f kg" % [HANDS[kind], mass])
			body.queue_free()
			await _clear()


func test_setting_down_does_not_tremble() -> void:
	for kind: SpidarG.HandFirmness in HANDS:
		await _set_up(kind)
		var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.05)
		await physics_frames(10)
		await grasp(body)
		await move_to(at + Vector3(0.0, 0.04, 0.0), SQUEEZE_ANGLE, 40)
		await move_to(at - Vector3(0.0, 0.05, 0.0), SQUEEZE_ANGLE, 40)
		await physics_frames(60)
		await _check_still("%s hand setting down" % HANDS[kind])
		body.queue_free()
		await _clear()


func _set_up(kind: SpidarG.HandFirmness) -> void:
	elastic = true
	firmness = kind
	at = Vector3.ZERO
	angle = 0.0
	await set_up(Vector3.ZERO)


func _check_still(what: String) -> void:
	var motion: float = await tremble(60)
	print("INFO %s: %.3f mm peak to peak" % [what, 1e3 * motion])
	check(motion < MOST_TREMBLE_M, "%s trembles %.3f mm" % [what, 1e3 * motion])


func _clear() -> void:
	device.queue_free()
	await physics_frames(2)
