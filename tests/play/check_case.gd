extends SceneTree
## What the checks of the demo's screens share: scenes opened without a person, simulated time, and the counting of checks.
## Prints FAIL lines and "N passed, N failed".

const DemoSettings := preload("res://ui/demo_settings.gd")
const DemoTask := preload("res://tasks/base/demo_task.gd")

const SCENES: Dictionary[String, String] = {
	"hub": "res://hub/hub.tscn",
	"guided_start": "res://hub/guided_start.tscn",
	"pick_and_place": "res://tasks/pick_and_place/pick_and_place.tscn",
	"robot_linking": "res://tasks/robot_linking/robot_linking.tscn",
	"match_linking": "res://tasks/match_linking/match_linking.tscn",
	"free_play": "res://tasks/free_play/free_play.tscn",
}
const SIZES: Array[Vector2i] = [Vector2i(1280, 720), Vector2i(1920, 1080)]

## What the lines of this check begin with.
var about := ""

var _passed := 0
var _failed := 0


func _initialize() -> void:
	_start.call_deferred()


## Coroutine: the checks of one script.
func _run() -> void:
	pass


func _start() -> void:
	await _run()
	print("%d passed, %d failed" % [_passed, _failed])
	quit(0 if _failed == 0 else 1)


func check(condition: bool, message: String) -> void:
	if condition:
		_passed += 1
	else:
		_failed += 1
		print("FAIL %s: %s" % [about, message])


## A scene of SCENES in simulated time. Nothing is written to the user's settings unless the scene does it.
func open(name: String, settings: DemoSettings = DemoSettings.new()) -> DemoTask:
	var task: DemoTask = (load(SCENES[name]) as PackedScene).instantiate()
	task.settings = settings
	(task.get_node(^"SpidarG") as SpidarG).drive_mode = SpidarG.DRIVE_STEPPED
	root.add_child(task)
	return task


## Coroutine.
func close(scene: Node) -> void:
	scene.queue_free()
	await frames(2)


## Coroutine.
func frames(count: int) -> void:
	for _frame in count:
		await process_frame


## Coroutine: one key goes down and up, as from a keyboard.
func press(key: Key, shift: bool = false) -> void:
	for down: bool in [true, false]:
		var event := InputEventKey.new()
		event.physical_keycode = key
		event.keycode = key
		event.shift_pressed = shift
		event.pressed = down
		Input.parse_input_event(event)
		await frames(2)


## Coroutine: the simulated hand goes to `at` (world) in a straight line and stays there.
func move_hand(task: DemoTask, at: Vector3, grasp_rad: float, time_s: float = 1.0) -> void:
	var spidar: SpidarG = task.spidar
	var from := spidar.get_grip_transform().origin
	var ticks := roundi(time_s * Engine.physics_ticks_per_second)
	for tick in ticks:
		var target := Transform3D(spidar.global_basis.orthonormalized(), from.lerp(at, minf(2.0 * (tick + 1) / ticks, 1.0)))
		spidar.set_simulated_hand_target(target, grasp_rad)
		await physics_frame
