## Main-thread cost of SpidarGHand: what a physics tick costs more with the hand than without it, among bodies near and far.
## In real time, for ticks that follow each other at once share a pose of the device and are cheaper. Run by ./dev bench:
## godot --headless --path tests/godot/project -s bench_hand.gd
extends SceneTree

const TICKS_PER_SECOND: int = 120
const TICKS: int = 120
const ROUNDS: int = 2
## Near bodies, and 500 far ones beside them or not.
const SCENES: Array[Vector2i] = [Vector2i(0, 0), Vector2i(1, 0), Vector2i(6, 0), Vector2i(30, 0), Vector2i(0, 500), Vector2i(6, 500)]


class TickClock:
	extends Node
	var at_us: int = 0

	func _physics_process(_delta: float) -> void:
		at_us = Time.get_ticks_usec()


func _initialize() -> void:
	_run()


func _run() -> void:
	await process_frame
	if not ClassDB.class_exists("SpidarGHand"):
		printerr("The spidar_g library is not loaded.")
		quit(1)
		return
	Engine.physics_ticks_per_second = TICKS_PER_SECOND
	print("bodies near, far: median of what nodes take in a physics tick (us) without a hand, with it, and what the hand costs")
	for scene: Vector2i in SCENES:
		var holder := Node3D.new()
		root.add_child(holder)
		_fill(holder, scene.x, scene.y)
		var without: PackedFloat64Array = []
		var with: PackedFloat64Array = []
		for _round: int in ROUNDS:  # in turn, so that both see the same machine
			without.append_array(await _times(false))
			with.append_array(await _times(true))
		var least: float = _median(without)
		var most: float = _median(with)
		print("%3d, %3d: %8.1f %8.1f %8.1f" % [scene.x, scene.y, least, most, most - least])
		holder.free()
		await process_frame
	quit(0)


## Boxes of 30 mm in rows round the grip, none of them touched.
func _fill(holder: Node3D, near: int, far: int) -> void:
	for i: int in near:
		var row: int = i / 5
		_box(holder, Vector3(0.035 * (i % 5) - 0.07, 0.05 + 0.035 * (row % 3), 0.035 * (row / 3)))
	for i: int in far:
		_box(holder, Vector3(5.0 + 0.1 * i, 0.0, 0.0))


func _box(holder: Node3D, at: Vector3) -> void:
	var body := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	var box := BoxShape3D.new()
	box.size = Vector3.ONE * 0.03
	shape.shape = box
	body.add_child(shape)
	body.position = at
	holder.add_child(body)


## The time that nodes take in each tick. Threaded: the servo loop has a thread of its own, as in a game.
func _times(with_hand: bool) -> PackedFloat64Array:
	var device := SpidarG.new()
	device.drive_mode = SpidarG.DRIVE_THREADED
	if with_hand:
		device.add_child(SpidarGHand.new())
	var first := TickClock.new()
	first.process_physics_priority = -1000
	var last := TickClock.new()
	last.process_physics_priority = 1000
	for node: Node in [first, device, last]:
		root.add_child(node)
	while device.get_state() == SpidarG.STATE_CLOSED:  # opened by a thread
		await physics_frame
	for _i: int in 20:
		await physics_frame
	var times: PackedFloat64Array = []
	for _i: int in TICKS:
		await physics_frame  # of the tick before
		times.append(last.at_us - first.at_us)
	for node: Node in [first, device, last]:
		node.free()
	await process_frame
	return times


func _median(times: PackedFloat64Array) -> float:
	var sorted: PackedFloat64Array = times.duplicate()
	sorted.sort()
	return sorted[sorted.size() / 2]
