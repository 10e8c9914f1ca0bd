## SpidarGClipPlayer by events: what a hand that touches, slips, hits, grasps and lets go feels of the clip.
extends "res://hand_shapes_scene.gd"

const ClipScene := preload("res://clip_scene.gd")
const HZ: float = 100.0
const REST_Y: float = FLOOR_Y + PAD_RADIUS - 0.004
const ABOVE_Y: float = FLOOR_Y + 0.04
const SIZE := Vector3(0.4, 0.1, 0.4)

var player: SpidarGClipPlayer
var floor_body: StaticBody3D
var surface: SpidarGSurface
## What was told: "started" and "finished".
var told: PackedStringArray = []
## Of the last glide(), in each cycle (N, world).
var felt: PackedVector3Array = []


func test_touch_plays_once_for_each_touch() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 1.0, 0.2))
	for count: int in [1, 2, 3]:
		await glide(Vector3(0, REST_Y, 0), 0.1)
		await glide(at, 0.0, 1000)
		check_equal(told.count("started"), count, "touch %d" % count)
		check_equal(told.count("finished"), count, "and its end")
		await glide(Vector3(0, ABOVE_Y, 0), 0.1)
		check_equal(told.count("started"), count, "nothing as it leaves")
	await glide(Vector3(0, REST_Y, 0), 0.1)
	await glide(at, 0.0, 200)
	var buzz_n: float = strongest_n(felt, 0)
	print("INFO touch: %.3f N at %.0f Hz along x" % [buzz_n, HZ])
	check_near(buzz_n, 1.0, 0.1, "felt as strong as the clip")
	_leave()


## A strong clip along the normal shakes a light finger off the surface and onto it again.
func test_a_clip_does_not_start_itself_by_shaking_the_hand_off() -> void:
	const Event := SpidarGClipPlayer.Event
	for event: SpidarGClipPlayer.Event in [Event.TOUCH, Event.TOUCH_END, Event.IMPACT]:
		for case: Array in [
			[15.0, 0.0005, SpidarG.HAND_NORMAL, 0.1], [15.0, 0.002, SpidarG.HAND_NORMAL, 0.1], [60.0, 0.0005, SpidarG.HAND_NORMAL, 0.1],
			[60.0, 0.004, SpidarG.HAND_LIGHT, 0.1], [15.0, 0.004, SpidarG.HAND_LIGHT, 0.5],
		]:
			firmness = case[2]
			await _set_up_floor(event, ClipScene.buzz(case[0], 2.0, 0.4))
			player.clip.along_normal = true
			player.cooldown = case[3]
			var touches: Array[int] = [0]
			surface.touched.connect(func(_who: SpidarGHand, _point: Vector3, _force: float) -> void: touches[0] += 1)
			await glide(Vector3(0, FLOOR_Y + PAD_RADIUS - case[1], 0), 0.1)
			if event == Event.TOUCH_END:
				await glide(at, 0.0, 300)
				await glide(Vector3(0, FLOOR_Y + PAD_RADIUS + 0.001, 0), 0.1)
			await glide(at, 0.0, 3000)
			print("INFO %s, %s: %d touches, started %d times" % [Event.find_key(event), case, touches[0], told.count("started")])
			check_equal(told.count("started"), 1, "%s, %s: once" % [Event.find_key(event), case])
			_leave()
			await physics_frames(2)
	firmness = SpidarG.HAND_NORMAL


func test_touch_end_plays_as_the_hand_leaves() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH_END, ClipScene.buzz(HZ, 1.0, 0.2))
	await glide(Vector3(0, REST_Y, 0), 0.1)
	await glide(at, 0.0, 300)
	check(told.is_empty(), "not while it presses")
	await glide(Vector3(0, ABOVE_Y, 0), 0.1)
	check_equal(told.count("started"), 1, "once")
	check_near(shaken_n(felt.slice(-250), 0), 1.0, 0.35, "felt")
	_leave()


func test_slip_repeats_the_clip_until_the_hand_stands() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.SLIP, ClipScene.buzz(HZ, 0.5, 0.1))
	player.clip.direction = Vector3.BACK
	await glide(Vector3(-0.04, REST_Y, 0), 0.1)
	await glide(at, 0.0, 600)
	check(not player.is_playing(), "not at rest")
	await glide(Vector3(0.04, REST_Y, 0), 0.06)
	print("INFO slip: %d times started in %d ms, %.3f N" % [told.count("started"), felt.size(), shaken_n(felt.slice(-800), 2)])
	check_equal(told.count("started") - told.count("finished"), 1, "still played after %d ms of a clip of 100 ms" % felt.size())
	for from: int in [400, 600, 800, 1000]:
		check_near(shaken_n(felt.slice(from, from + 200), 2), 0.5, 0.06, "as strong at %d ms" % from)
	var ended: Array[int] = [-1]
	surface.slip_ended.connect(func(_who: SpidarGHand) -> void: ended[0] = felt.size())
	await glide(at, 0.0, 600)
	check(ended[0] >= 0, "the hand stands")
	check(not player.is_playing(), "no longer played")
	check(shaken_n(felt.slice(ended[0] + 100), 2) < 0.02, "nothing 0.1 s later: %f N" % shaken_n(felt.slice(ended[0] + 100), 2))
	_leave()


func test_a_slip_ends_with_its_surface() -> void:
	for way: String in ["surface freed", "body freed", "another event", "hand freed", "disabled"]:
		await _set_up_floor(SpidarGClipPlayer.Event.SLIP, ClipScene.buzz(HZ, 0.5, 0.1))
		var own := Node.new() # the player stays when body and surface go
		add(own)
		player.reparent(own)
		player.source_path = player.get_path_to(surface)
		await glide(Vector3(-0.04, REST_Y, 0), 0.1)
		await glide(Vector3(0.02, REST_Y, 0), 0.06)
		check(player.is_playing(), "%s: slips before" % way)
		match way:
			"surface freed":
				surface.free()
			"body freed":
				floor_body.free()
			"another event":
				player.event = SpidarGClipPlayer.Event.TOUCH
			"hand freed":
				hand.free()
			"disabled":
				player.process_mode = Node.PROCESS_MODE_DISABLED
		await glide(Vector3(0.03, REST_Y, 0), 0.06)
		check(not player.is_playing(), "%s: ended" % way)
		check_equal(told.count("started"), told.count("finished"), "%s: in pairs: %s" % [way, told])
		own.free()
		_leave()
		await physics_frames(2)


func test_an_impact_is_felt_by_its_speed() -> void:
	var felt_n: Array[float] = []
	for speed: float in [0.01, 0.08, 0.16, 0.32]:
		await _set_up_floor(SpidarGClipPlayer.Event.IMPACT, ClipScene.buzz(HZ, 1.5, 0.15))
		player.full_impact_speed = 0.32
		check(player.is_physics_processing(), "it reads the speed")
		await glide(Vector3(0, REST_Y, 0), speed)
		await glide(at, 0.0, 200)
		felt_n.append(strongest_n(felt, 0))
		print("INFO impact at %.2f m/s: %.3f N" % [speed, felt_n[-1]])
		_leave()
		await physics_frames(2)
	check(felt_n[0] < 0.05, "a slow touch is no impact: %f N" % felt_n[0])
	check_near(felt_n[2] / felt_n[1], 2.0, 0.4, "twice the speed")
	check_near(felt_n[3] / felt_n[2], 2.0, 0.4, "twice the speed again")
	check_near(felt_n[3], 1.5, 0.2, "in full")


func test_an_impact_has_a_limit_and_may_be_the_same_for_all_speeds() -> void:
	for case: Array in [[true, 0.4, 1.0], [false, 0.1, 1.0]]:
		await _set_up_floor(SpidarGClipPlayer.Event.IMPACT, ClipScene.buzz(HZ, 1.0, 0.15))
		player.full_impact_speed = 0.2
		player.scale_by_impulse = case[0]
		await glide(Vector3(0, REST_Y, 0), case[1])
		await glide(at, 0.0, 200)
		check_near(strongest_n(felt, 0), case[2], 0.15, "%s" % [case])
		_leave()
		await physics_frames(2)


func test_a_body_that_hits_the_hand_is_an_impact() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.IMPACT, ClipScene.buzz(HZ, 1.0, 0.15))
	var ball: RigidBody3D = add_box(Vector3(0.14, 0.03, 0.06), Vector3(0, 0.05, 0), 0.1) as RigidBody3D
	ball.gravity_scale = 0.0
	player.reparent(ball)
	ball.add_child(SpidarGSurface.new())
	await glide(Vector3(0, -0.03, 0), 0.1)
	check(told.is_empty(), "nothing yet")
	ball.linear_velocity = Vector3(0, -0.3, 0)
	await physics_frames(40)
	check_equal(told.count("started"), 1, "hit at 0.3 m/s: %s" % [told])
	ball.free()
	_leave()


func test_a_cooldown_keeps_touches_apart_and_does_not_count_for_play() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 1.0, 0.05))
	player.cooldown = 1.0
	var touches: Array[int] = [0]
	surface.touched.connect(func(_who: SpidarGHand, _point: Vector3, _force: float) -> void: touches[0] += 1)
	for _i: int in 2:
		await press(0.2)
		await glide(Vector3(0, ABOVE_Y, 0), 0.2)
	check(touches[0] >= 2, "two touches or, with a bounce, more: %d" % touches[0])
	check_equal(told.count("started"), 1, "one clip within a second")
	check(player.play(), "by script at once")
	await glide(at, 0.0, 1200)
	await press(0.2)
	check_equal(told.count("started"), 3, "and by a touch after it")
	_leave()


func test_the_normal_of_what_is_touched_is_the_direction() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 0.6, 0.3))
	player.clip.along_normal = true
	player.clip.direction = Vector3.BACK
	await glide(Vector3(0, REST_Y, 0), 0.1)
	await glide(at, 0.0, 200)
	print("INFO along the normal of the floor: %.3f N, across %.3f N" % [shaken_n(felt, 1), shaken_n(felt, 0)])
	check(shaken_n(felt, 1) > 0.4 and shaken_n(felt, 0) < 0.05 and shaken_n(felt, 2) < 0.05, "up and down")
	await glide(Vector3(0, ABOVE_Y, 0), 0.1)
	await glide(at, 0.0, 500)
	player.play()
	await glide(at, 0.0, 200)
	check_near(shaken_n(felt.slice(50), 2), 0.6, 0.06, "in the air along its own direction")
	_leave()


func test_grasp_and_release_of_a_body_and_of_a_hand() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	var other: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1, 0.15)
	var events: Array[SpidarGClipPlayer.Event] = [SpidarGClipPlayer.Event.GRASP, SpidarGClipPlayer.Event.RELEASE]
	var counts: Dictionary[String, int] = {}
	for parent: Node in [body, other, hand, device]:
		for event: SpidarGClipPlayer.Event in events:
			var made := SpidarGClipPlayer.new()
			made.event = event
			made.clip = ClipScene.buzz(HZ, 0.6, 0.2)
			made.clip.direction = Vector3.BACK
			made.clip.along_normal = false
			made.cooldown = 0.0
			parent.add_child(made)
			check_equal(made._get_configuration_warnings(), PackedStringArray(), "no warning")
			var key: String = "%s %s" % [parent.get_class() if parent != other else "other", SpidarGClipPlayer.Event.find_key(event)]
			counts[key] = 0
			made.started.connect(func(who: SpidarG) -> void: counts[key] += int(who == device))
	await physics_frames(10)
	await grasp(body)
	check_equal(hand.get_held_body(), body, "held")
	for key: String in counts:
		check_equal(counts[key], int(key.contains("GRASP") and not key.contains("other")), "held: %s" % key)
	await move_to(at, 0.0, 20)
	await physics_frames(10)
	check_equal(hand.get_held_body(), null, "let go")
	for key: String in counts:
		check_equal(counts[key], int(not key.contains("other")), "let go: %s" % key)
	device.free()


func test_a_grasp_is_felt() -> void:
	await set_up(Vector3.ZERO)
	var body: RigidBody3D = add_free_box(Vector3(0.03, 0.04, 0.03), 0.1)
	_add_player(body, SpidarGClipPlayer.Event.GRASP, ClipScene.buzz(HZ, 0.8, 0.2))
	player.clip.direction = Vector3.BACK
	await move_to(body.global_position, 0.0, 60)
	felt.clear()
	for _i: int in 40:
		await move_to(at, angle + SQUEEZE_ANGLE / 40.0, 1)
		if player.is_playing():
			break
	check_equal(hand.get_held_body(), body, "held")
	await glide(at, 0.0, 150)
	print("INFO grasp: %.3f N along z" % shaken_n(felt, 2))
	check_near(shaken_n(felt, 2), 0.8, 0.12, "felt")
	await glide(at, 0.0, 300)
	check(shaken_n(felt.slice(-150), 2) < 0.03, "and ends")
	device.free()


func test_only_the_hand_that_touches_is_shaken() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 1.0, 0.2))
	var first: SpidarG = device
	var second: SpidarG = ideal_device()
	second.forces_enabled = true
	second.add_child(SpidarGHand.new())
	add(second)
	await physics_frames(ARMING_FRAMES)
	var who: Array[SpidarG] = []
	player.started.connect(func(spidar: SpidarG) -> void: who.append(spidar))
	await press(0.1)
	check_equal(who, [first] as Array[SpidarG], "the first alone")
	await physics_frames(30)
	player.play()
	check_equal(who.size(), 3, "by script both")
	player.play(second)
	check_equal(who[-1], second, "by script the one that is named")
	second.free()
	_leave()


func test_a_disabled_player_does_not_answer() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 1.0, 0.2))
	player.process_mode = Node.PROCESS_MODE_DISABLED
	await press(0.1)
	check(told.is_empty() and not player.is_playing(), "not started")
	check(shaken_n(felt, 0) < 0.05, "nothing felt: %f N" % shaken_n(felt, 0))
	check(not player.play(), "nor by script")
	await glide(Vector3(0, ABOVE_Y, 0), 0.1)
	player.process_mode = Node.PROCESS_MODE_INHERIT
	await press(0.1)
	check_equal(told.count("started"), 1, "enabled again, it does")
	_leave()


func test_a_surface_or_a_hand_that_comes_later_counts() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.TOUCH, ClipScene.buzz(HZ, 1.0, 0.1))
	surface.free()
	await press(0.1)
	check(told.is_empty(), "without a surface nothing")
	await glide(Vector3(0, ABOVE_Y, 0), 0.1)
	floor_body.add_child(SpidarGSurface.new())
	await press(0.1)
	check_equal(told.count("started"), 1, "with a new one")
	await glide(Vector3(0, ABOVE_Y, 0), 0.1)
	floor_body.remove_child(player)
	await press(0.1)
	check_equal(told.count("started"), 1, "removed, it hears nothing")
	player.free()
	_leave()


func test_a_body_that_leaves_and_comes_back_is_hit_again() -> void:
	await _set_up_floor(SpidarGClipPlayer.Event.IMPACT, ClipScene.buzz(HZ, 1.0, 0.1))
	floor_body.move_child(player, 0) # before its surface
	for count: int in [1, 2]:
		await press(0.2)
		check_equal(told.count("started"), count, "hit %d" % count)
		await glide(Vector3(0, ABOVE_Y, 0), 0.2)
		tree.root.remove_child(floor_body)
		await physics_frames(5)
		tree.root.add_child(floor_body)
		await physics_frames(5)
	_leave()


func test_each_event_without_a_source_has_a_warning_with_a_remedy() -> void:
	var body := StaticBody3D.new()
	var free := RigidBody3D.new()
	free.freeze = true
	var lone_device: SpidarG = ideal_device()
	var lone_hand := SpidarGHand.new()
	lone_device.add_child(lone_hand)
	for node: Node in [body, free, lone_device]:
		add(node)
	const Event := SpidarGClipPlayer.Event
	for case: Array in [
		[tree.root, Event.NONE, ""], [tree.root, Event.TOUCH, "SpidarGSurface"], [tree.root, Event.GRASP, "RigidBody3D"],
		[body, Event.TOUCH, "SpidarGSurface"], [body, Event.GRASP, "only a RigidBody3D"], [body, Event.IMPACT, "SpidarGSurface"],
		[free, Event.RELEASE, ""], [free, Event.SLIP, "SpidarGSurface"], [lone_hand, Event.GRASP, ""],
		[lone_device, Event.RELEASE, ""], [lone_hand, Event.TOUCH, "SpidarGSurface"],
	]:
		var made := SpidarGClipPlayer.new()
		made.clip = SpidarGClip.new()
		made.event = case[1]
		(case[0] as Node).add_child(made)
		var texts: PackedStringArray = made._get_configuration_warnings()
		check((texts.is_empty() and case[2] == "") or (texts.size() == 1 and case[2] != "" and texts[0].contains(case[2])), "%s: %s" % [case, texts])
		made.free()
	var lost := SpidarGClipPlayer.new()
	add(lost)
	lost.source_path = ^"nowhere"
	lost.event = Event.GRASP
	var texts: PackedStringArray = lost._get_configuration_warnings()
	check("\n".join(texts).contains("nowhere") and "\n".join(texts).contains("clip is empty"), "told: %s" % texts)
	lost.source_path = lost.get_path_to(lone_hand)
	lost.clip = SpidarGClip.new()
	check_equal(lost._get_configuration_warnings(), PackedStringArray(), "a path to a hand heals it")
	for node: Node in [lost, body, free, lone_device]:
		node.free()
	await physics_frames(1)


func _set_up_floor(event: SpidarGClipPlayer.Event, clip: SpidarGClip) -> void:
	at = Vector3.ZERO
	angle = 0.0
	await set_up_empty(0.3 if event == SpidarGClipPlayer.Event.SLIP else 0.0)
	await go(Vector3(0, ABOVE_Y, 0), 20)
	floor_body = Solids.static_body(Solids.box(SIZE), Transform3D(Basis.IDENTITY, Vector3(0, -0.5 * SIZE.y, 0)))
	floor_body.position.y = FLOOR_Y
	surface = SpidarGSurface.new()
	floor_body.add_child(surface)
	_add_player(floor_body, event, clip)
	add(floor_body)
	await physics_frames(5)


## The clip shakes along its own direction.
func _add_player(parent: Node, event: SpidarGClipPlayer.Event, clip: SpidarGClip) -> void:
	player = SpidarGClipPlayer.new()
	player.clip = clip
	player.clip.along_normal = false
	player.event = event
	parent.add_child(player)
	told.clear()
	player.started.connect(func(who: SpidarG) -> void: told.append("started" if who == device else "?"))
	player.finished.connect(func(_who: SpidarG) -> void: told.append("finished"))


func _leave() -> void:
	device.free()
	if is_instance_valid(floor_body):
		floor_body.free()


## The hand goes to `to` at so many m/s, or rests for `rest` cycles: the force in each servo cycle. The game has a tick each 16.
func glide(to: Vector3, speed: float, rest: int = 0) -> void:
	felt.clear()
	var from: Vector3 = at
	var count: int = rest if rest > 0 else ceili(1000.0 * from.distance_to(to) / speed)
	Engine.physics_ticks_per_second = 1000
	for i: int in count:
		at = from.lerp(to, float(i + 1) / count)
		device.set_simulated_hand_target(Transform3D(Basis.IDENTITY, at), angle)
		if i % 16 == 0:
			await physics_frames(1)
		else:
			device.advance_cycles(1)
		felt.append(force_of(device.get_simulated_truth()["strings_wrench"]))
	Engine.physics_ticks_per_second = 60


## Onto the floor, and until the hand has come to rest there.
func press(speed: float) -> void:
	await glide(Vector3(0, REST_Y, 0), speed)
	await glide(at, 0.0, 200)


## Amplitude of what shakes at HZ, along an axis.
static func shaken_n(forces: PackedVector3Array, axis: int) -> float:
	var whole: int = forces.size() - forces.size() % 10 # periods
	var sum := Vector2.ZERO
	for i: int in whole:
		sum += forces[i][axis] * Vector2.from_angle(TAU * HZ * 0.001 * i)
	return 2.0 * sum.length() / maxf(whole, 1.0)


## The largest of that over any 50 cycles.
static func strongest_n(forces: PackedVector3Array, axis: int) -> float:
	var most: float = 0.0
	for from: int in range(0, forces.size() - 50, 10):
		most = maxf(most, shaken_n(forces.slice(from, from + 50), axis))
	return most
