## SpidarGMouseHand: what brings the grip under the cursor, what keeps it away from the cursor, and what turns it upright. No
## motion of the mouse makes the grip jump.
extends "res://mouse_hand_scene.gd"

const Pointer := preload("res://addons/spidar_g/nodes/mouse_hand/pointer.gd")
const Turning := preload("res://addons/spidar_g/nodes/mouse_hand/turning.gd")
const TICK_S: float = 1.0 / 60.0
## The target is single precision: its way in a tick may differ by this, m.
const ROUND_M: float = 1e-6
## The smallest motion of a cursor: the window of a headless Godot has few pixels, and each of them is 14 mm at the grip.
const NUDGE_PX: float = 0.1
const NUDGE_M: float = 0.002


func test_at_the_first_motion_the_grip_glides_under_the_cursor() -> void:
	await set_up_mouse()
	var wanted: Vector3 = Vector3(0.1, 0.04, 0.0)
	point_at(wanted)
	var fastest: float = await _fastest(10)
	check_near(fastest, Pointer.GLIDE_M_S, 1e-3, "at first it glides, m/s")
	check(mouse.position_m.distance_to(wanted) > 0.05, "after 10 ticks it is on its way: %s" % mouse.position_m)
	await settle()
	check_grip_at(wanted, "at the end it is under the cursor")
	point_at(wanted + Vector3(-0.01, 0.0, 0.0))
	await physics_frames(1)
	check_near(mouse.position_m.x, wanted.x - 0.01, ROUND_M, "then it goes with the cursor at once")


func test_the_glide_goes_on_with_a_moving_cursor() -> void:
	await set_up_mouse()
	for tick: int in 10:
		point_at(Vector3(0.1 - 0.002 * tick, 0.0, 0.0))
		await physics_frames(1)
	check_near(mouse.position_m.x, 10.0 * Pointer.GLIDE_M_S * TICK_S - 0.018, 1e-4, "glide and cursor add up")
	await settle()
	check_grip_at(Vector3(0.082, 0.0, 0.0), "and it comes under the cursor")


func test_the_cursor_does_not_throw_the_grip() -> void:
	await set_up_mouse()
	point_at(Vector3(-0.08, 0.0, 0.0))
	await settle()
	point_at(Vector3(0.1, 0.0, 0.0))
	var fastest: float = await _fastest(5)
	check_near(fastest, Pointer.HAND_M_S, 1e-3, "no faster than a hand, m/s")
	await physics_frames(7)
	check_near(mouse.position_m.x, 0.1, ROUND_M, "and there after 180 ms")


func test_a_cursor_out_of_reach_at_first_does_not_carry_the_grip_away() -> void:
	await set_up_mouse()
	move_cursor(Vector2(1e4, 0.5 * tree.root.get_visible_rect().size.y))
	await physics_frames(10)
	point_at(Vector3(0.05, 0.0, 0.0))
	await settle()
	check_grip_at(Vector3(0.05, 0.0, 0.0), "back in reach it is under the cursor")


func test_after_keys_the_grip_keeps_its_distance_to_the_cursor() -> void:
	for moved_before: bool in [true, false]:
		await set_up_mouse()
		var when: String = "after a motion" if moved_before else "before any motion"
		var at_px: Vector2 = camera.unproject_position(Vector3(0.05, 0.0, 0.0))
		if moved_before:
			move_cursor(at_px)
			await settle()
		await hold_key(KEY_E, 31)
		var raised: Vector3 = mouse.position_m
		check_near(raised.y, 0.062, 0.004, "%s: E raises the grip, m" % when)
		move_cursor(at_px + Vector2(NUDGE_PX, 0.0))
		await settle()
		check_near(mouse.position_m.distance_to(raised), 0.0, NUDGE_M, "%s: the smallest motion moves it as little" % when)
		var before: Vector3 = mouse.position_m
		move_cursor(at_px + Vector2(4.0 + NUDGE_PX, 0.0))
		await settle()
		var way_px: Vector2 = camera.unproject_position(mouse.position_m) - camera.unproject_position(before)
		check_near(way_px.distance_to(Vector2(4.0, 0.0)), 0.0, 0.01, "%s: 4 px move it by 4 px" % when)
		mouse.recenter()
		point_at(Vector3(0.02, 0.01, 0.0))
		await settle()
		check_grip_at(Vector3(0.02, 0.01, 0.0), "%s: recenter() brings it under the cursor again" % when)
		device.free()
		await frames(2)


func test_a_key_takes_the_grip_from_a_cursor_out_of_reach() -> void:
	await set_up_mouse()
	point_at(Vector3(0.05, 0.0, 0.0))
	mouse.reach = 0.1
	await settle()
	var far_px: Vector2 = camera.unproject_position(Vector3(0.2, 0.0, 0.0))
	move_cursor(far_px)
	await settle()
	check_near(mouse.position_m.x, 0.1, ROUND_M, "at the limit, m")
	await hold_key(KEY_A, 30)
	var left: Vector3 = mouse.position_m
	check_near(left.x, 0.04, 0.004, "A moves it from there, m")
	move_cursor(far_px + Vector2(-NUDGE_PX, 0.0))
	await settle()
	check_near(mouse.position_m.distance_to(left), 0.0, NUDGE_M, "the smallest motion does not bring it back")


func test_after_the_wheel_the_grip_glides_under_the_cursor() -> void:
	await set_up_mouse()
	add_camera(Vector3(0.0, 0.3, 0.5), Vector3.ZERO)
	point_at(Vector3.ZERO)
	await settle()
	notch(MOUSE_BUTTON_WHEEL_UP, 10)
	await settle()
	check_near(mouse.position_m.distance_to(Vector3(0.0, 0.0, -0.06)), 0.0, 1e-5, "ten notches")
	var middle_px: Vector2 = camera.unproject_position(Vector3.ZERO)
	move_cursor(middle_px + Vector2(0.0, NUDGE_PX))
	var fastest: float = await _fastest(3)
	check(fastest < Pointer.GLIDE_M_S + NUDGE_M / TICK_S, "the smallest motion does not throw it: %.2f m/s" % fastest)
	move_cursor(middle_px)
	await settle()
	var off_px: float = camera.unproject_position(mouse.position_m).distance_to(middle_px)
	check_near(off_px, 0.0, 0.01, "under the cursor, px")


func test_home_turns_the_grip_upright() -> void:
	await set_up_mouse()
	mouse.turn_rad = Vector3(0.3, -0.5, 0.2)
	await settle()
	key(KEY_HOME, true)
	key(KEY_HOME, false)
	await physics_frames(9)
	check_near(mouse.turn_rad.distance_to(0.5 * Vector3(0.3, -0.5, 0.2)), 0.0, 0.05, "half of it in half of the time")
	await physics_frames(ceili(0.5 * Turning.UPRIGHT_S / TICK_S) + 2)
	check_equal(mouse.turn_rad, Vector3.ZERO, "all in all of the time")
	await settle()
	check_near(grip().basis.get_rotation_quaternion().get_angle(), 0.0, 0.02, "and so does the grip, rad")
	await hold_key(KEY_LEFT, 30)
	check_near(mouse.turn_rad.y, 0.45, 0.05, "afterwards keys turn it, rad")


func test_another_turn_takes_over_from_home() -> void:
	await set_up_mouse()
	mouse.turn_rad = Vector3(0.0, 0.5, 0.0)
	key(KEY_HOME, true)
	key(KEY_HOME, false)
	await physics_frames(6)
	await hold_key(KEY_LEFT, 2)
	var turned: Vector3 = mouse.turn_rad
	check(turned.y > 0.2, "turned half upright: %s" % turned)
	await settle()
	check_equal(mouse.turn_rad, turned, "the key has ended it")
	key(KEY_HOME, true)
	key(KEY_HOME, false)
	await physics_frames(2)
	button(MOUSE_BUTTON_RIGHT, true)
	move_cursor(Vector2(300.0, 200.0), Vector2(10.0, 0.0))
	button(MOUSE_BUTTON_RIGHT, false)
	turned = mouse.turn_rad
	await settle()
	check_equal(mouse.turn_rad, turned, "and so does a drag")


## The largest way of the target in one of so many ticks, m/s.
func _fastest(ticks: int) -> float:
	var most: float = 0.0
	for _tick: int in ticks:
		var before: Vector3 = mouse.position_m
		await physics_frames(1)
		most = maxf(most, mouse.position_m.distance_to(before) / TICK_S)
	return most
