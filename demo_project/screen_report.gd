extends Node
## For a scripted user outside the program, who has a mouse and keys but no eyes: where things are in the window (pixels)
## and in the scene (m), in a JSON file that is replaced ten times a second. It only tells; it changes nothing.

const AutoAnimator := preload("res://ui/auto_animator.gd")
const DemoTask := preload("res://tasks/base/demo_task.gd")
const Experiment := preload("res://study/experiment.gd")
const HubKnob := preload("res://hub/hub_knob.gd")
const Hud := preload("res://ui/hud.gd")

const PERIOD_S := 0.1

var path := ""
## What is open: a task, the menu, or the experiment with a task or without.
var scene: Node

var _left_s := 0.0
var _count := 0


func _ready() -> void:
	process_mode = Node.PROCESS_MODE_ALWAYS


func _process(delta: float) -> void:
	_left_s -= delta
	if _left_s > 0.0 or not is_instance_valid(scene) or not scene.is_node_ready():
		return
	_left_s = PERIOD_S
	_count += 1
	var report := {
		"count": _count,
		"scene": scene.name,
		"buttons": _buttons(),
		"paused": get_tree().paused,
		"bodies": [],
		"knobs": [],
	}
	var task := scene as DemoTask
	if scene is Experiment:
		task = (scene as Experiment).open_task() as DemoTask
	if task != null and task.is_node_ready():
		_tell_of(task, report)
	_write(report)


func _tell_of(task: DemoTask, report: Dictionary) -> void:
	var camera := get_viewport().get_camera_3d()
	var held := task.tool_hand.get_held_body()
	report.merge({
		"task": task.task_name,
		"grip": _point(camera, task.spidar.get_grip_transform().origin),
		"grasp_angle_deg": rad_to_deg(task.spidar.get_grasp_angle()),
		"forces": task.spidar.forces_enabled,
		"held": "" if held == null else String(held.name),
		"busy": (task.get_node(^"AutoAnimator") as AutoAnimator).busy,
		"finished": task.is_finished(),
		"level": task.settings.level,
		"hud": ((task.get_node(^"Hud") as Hud).mode),
		"goal": (task.get_node(^"Hud/Screen/Help/Rows/Heading") as Label).text,
		"hint": (task.get_node(^"Hud/%Hint") as Label).text,
		"help": (task.get_node(^"Hud/Screen/Help") as Control).visible,
	})
	for body in task.bodies:
		(report["bodies"] as Array).append({
			"name": body.name,
			"at": _point(camera, body.to_global(body.grasp_offset_m)),
			"goal": _point(camera, body.goal() * body.grasp_offset_m),
			"turn_deg": rad_to_deg(wrapf(body.goal().basis.get_euler().y - body.global_basis.get_euler().y, -PI, PI)),
			"travel_y": (task.get_node(^"Items") as Node3D).global_position.y + body.travel_m,
			"from": _vector(body.global_basis * body.approach_m),
			"way_out": _vector(body.goal().basis * body.approach_m),
			"placed": body.placed,
		})
	for child in task.get_node(^"Items").get_children():
		if child is HubKnob:
			(report["knobs"] as Array).append({
				"name": child.name,
				"at": _point(camera, (child as HubKnob).to_global(Vector3(0.0, 0.022, 0.0))),
			})


## Middles of the buttons on the screen, by what they say.
func _buttons() -> Dictionary:
	var found := {}
	for child in scene.find_children("*", "Button", true, false):
		var button := child as Button
		if button.is_visible_in_tree():
			var at := get_viewport().get_final_transform() * button.get_global_rect().get_center()
			found[button.atr(button.text)] = [at.x, at.y]
	return found


func _point(camera: Camera3D, point: Vector3) -> Dictionary:
	var on_screen := get_viewport().get_final_transform() * camera.unproject_position(point)
	return {"screen": [on_screen.x, on_screen.y], "world": _vector(point)}


func _vector(vector: Vector3) -> Array[float]:
	return [vector.x, vector.y, vector.z]


## Whole or not at all: the reader never sees half of it.
func _write(report: Dictionary) -> void:
	var file := FileAccess.open(path + ".part", FileAccess.WRITE)
	if file == null:
		return
	file.store_string(JSON.stringify(report))
	file.close()
	DirAccess.rename_absolute(path + ".part", path)
