## Draws the diagnosis panel of a device whose hand presses on a floor, and saves it: --resolution 800x900
## -s panel_picture.gd -- FILE. Needs a display of that size. The picture of docs/reference/recording.md is made so.
extends SceneTree

const PANEL: String = "res://addons/spidar_g/nodes/spidar_g_panel.tscn"
const FRAMES: int = 400


func _initialize() -> void:
	_run()


func _run() -> void:
	var arguments: PackedStringArray = OS.get_cmdline_user_args()
	if arguments.size() != 1:
		push_error("panel_picture.gd: give one file to save.")
		quit(2)
		return
	var device := SpidarG.new()
	device.forces_enabled = true
	device.add_child(SpidarGHand.new())
	root.add_child(device)
	var floor_below := StaticBody3D.new()
	var shape := CollisionShape3D.new()
	shape.shape = WorldBoundaryShape3D.new()
	floor_below.add_child(shape)
	floor_below.position.y = -0.03
	root.add_child(floor_below)
	var layer := CanvasLayer.new()
	var panel: SpidarGPanel = load(PANEL).instantiate()
	panel.device = device
	panel.size = Vector2(640, 840)
	layer.add_child(panel)
	root.add_child(layer)
	for frame: int in FRAMES:
		var time_s: float = frame / 60.0
		device.set_simulated_hand_target(
			Transform3D(Basis(), Vector3(0.02 * sin(2.0 * time_s), -0.02 - 0.02 * sin(5.0 * time_s), 0.0)), 0.3)
		if frame % 90 == 0:
			device.request_wrench(Vector3.ZERO, Vector3(0.02, 0.0, 0.03), 0.02, 0.4)
		if frame == 100:
			panel.toggle_recording()
		await process_frame
	await RenderingServer.frame_post_draw
	var picture: Image = root.get_texture().get_image()
	var error: Error = picture.get_region(Rect2i(panel.get_global_rect())).save_png(arguments[0])
	panel.toggle_recording()
	DirAccess.remove_absolute(panel.recording_path)
	layer.free()
	floor_below.free()
	device.free()
	quit(0 if error == OK else 1)
