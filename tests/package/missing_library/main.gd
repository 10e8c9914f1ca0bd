## A game that names the add-on's classes as types and as values, with the device in a scene of its own: as
## docs/how_to/export.md says.
extends Node3D

const DEVICE_SCENE: String = "res://device.tscn"
const PANEL_SCENE: String = "res://addons/spidar_g/nodes/spidar_g_panel.tscn"
const FRAMES: int = 60

var device: SpidarG
var hand: SpidarGHand
var calibrator: SpidarGCalibrator = SpidarGCalibrator.new()
var workspace: SpidarGWorkspace = SpidarGWorkspace.new()
var state: SpidarG.State = SpidarG.STATE_CLOSED
var frames: int = 0


func _ready() -> void:
	if ClassDB.class_exists(&"SpidarG"):
		device = (load(DEVICE_SCENE) as PackedScene).instantiate()
		hand = device.get_node(^"Hand")
	else:
		device = SpidarG.new()
		device.config = SpidarGConfig.new()
		hand = SpidarGHand.new()
		device.add_child(hand)
	device.calibration = SpidarGCalibration.new()
	device.config.max_force = 4.0
	add_child(device)
	device.add_child(SpidarGView.new())
	device.add_child(SpidarGMonitors.new())
	device.add_child(SpidarGMouseHand.new())
	device.add_child(SpidarGGrip.new())
	device.add_child(SpidarGTracker.new())
	device.add_child(SpidarGZone.new())
	var body := StaticBody3D.new()
	body.add_child(SpidarGSocket.new())
	var surface := SpidarGSurface.new()
	surface.material = SpidarGMaterial.new()
	body.add_child(surface)
	var player := SpidarGClipPlayer.new()
	player.clip = SpidarGClip.new()
	player.event = SpidarGClipPlayer.Event.TOUCH
	body.add_child(player)
	add_child(body)
	var panel: SpidarGPanel = (load(PANEL_SCENE) as PackedScene).instantiate()
	panel.device = device
	add_child(panel)
	hand.body_grasped.connect(_on_body_grasped)
	player.play()
	device.set_forces_enabled(true)


func _on_body_grasped(_body: RigidBody3D) -> void:
	pass


func _physics_process(_delta: float) -> void:
	device.set_simulated_hand_target(Transform3D(Basis(), Vector3(0, -0.05, 0)), deg_to_rad(30.0))
	device.request_wrench(Vector3(0, -1.5, 0), Vector3.ZERO, 0.0)
	device.set_contacts([0, 1, 0, -0.02, 0, 0, 0, 350, 2, 0.3, SpidarG.CONTACT_CENTER, 1])
	state = device.get_state()
	frames += 1
	if frames < FRAMES:
		return
	var is_there: bool = state != SpidarG.STATE_CLOSED and device.config.max_force == 4.0 and device.are_forces_enabled()
	print("PLAYED %d frames, the library is %s" % [frames, "there" if is_there else "missing"])
	print(device.get_state_text(), " ", SpidarG.list_devices().size(), " ", workspace.get_box(), calibrator.get_class())
	get_tree().quit()
