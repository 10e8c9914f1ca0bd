extends "res://plays/play.gd"


func play() -> void:
	var controller: XRController3D = scene.get_node(^"XROrigin3D/XRController3D")
	var label: Label3D = scene.get_node(^"Label3D")
	await move_to(Vector3(-0.04, 0.03, 0.02))
	var apart: float = controller.global_position.distance_to(device.get_grip_transform().origin)
	check(controller.get_is_active() and apart < 1e-4, "the controller is where the grip is: %f m apart" % apart)
	check((scene.get_node(^"Dot") as Node3D).visible, "it points at the wall")
	press(mouse.grasp_action, true)
	await ticks(100)
	check(controller.is_button_pressed("grip_click"), "closing the grasp is its grip: %f" % controller.get_float("grip"))
	check(controller.get_float("trigger") > 0.3, "and its trigger: %f" % controller.get_float("trigger"))
	check(label.text.ends_with("pressed"), "the scene was told: %s" % label.text)
