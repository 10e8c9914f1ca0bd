## A node on serial motor boards at the port given after "--": zeroed, armed, and pulling until somebody ends it.
## Each line on the output is a word for tests/serial/run_serial_game.py.
extends SceneTree

const FORCE_N := Vector3(0.0, 2.0, 0.0)

var _device: SpidarG
var _told_state := -1
var _asked := false
var _armed := false


func _initialize() -> void:
	_device = SpidarG.new()
	_device.config = SpidarGConfig.new()
	_device.config.transport = SpidarGConfig.TRANSPORT_SERIAL
	_device.config.serial_port = OS.get_cmdline_user_args()[0]
	_device.config.arming_time = 0.1
	_device.drive_mode = SpidarG.DRIVE_THREADED
	_device.release_on_focus_loss = false
	root.add_child(_device)


func _physics_process(_delta: float) -> bool:
	_device.request_wrench(FORCE_N, Vector3.ZERO, 0.0)
	var state := _device.get_state()
	if state != _told_state:
		_told_state = state
		print("state %d %s %s" % [state, _device.get_state_text(), _device.get_fault_text()])
	if state == SpidarG.STATE_CONNECTED and not _asked:
		var info := _device.get_device_info()
		print("device %s at %s, rate %.0f, remarks \"%s\"" % [info["product"], info["path"], info["highest_rate_hz"], info["remarks"]])
		_device.forces_enabled = true
		_device.zero_at_home()
		_asked = true
	if state == SpidarG.STATE_CALIBRATED and not _armed:
		_device.arm()
		_armed = true
	if state == SpidarG.STATE_ACTIVE and _told_state == state and Engine.get_physics_frames() % 30 == 0:
		print("active")
	return false
