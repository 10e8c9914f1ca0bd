## A node on serial motor boards at the port given after "--": zeroed, armed, and pulling until somebody ends it.
## Each line on the output is a word for tests/serial/run_serial_game.py.
extends SceneTree

const FORCE_N := Vector3(0.0, 2.0, 0.0)
## A busy machine may hold the boards' answers up until the loop stops itself: it is tried again after this.
const AFTER_FAULT_TICKS := 30


## A node that runs right before or right behind the device in each physics tick.
class Clock extends Node:
	signal ticked

	func _physics_process(_delta: float) -> void:
		ticked.emit()


var _device: SpidarG
var _told_state := -1
var _asked := false
var _armed := false
var _fault_ticks := 0
## Of the game's time since it began, what the device's node took.
var _began_us := Time.get_ticks_usec()
var _device_began_us := 0
var _device_us := 0


func _initialize() -> void:
	_device = SpidarG.new()
	_device.config = SpidarGConfig.new()
	_device.config.transport = SpidarGConfig.TRANSPORT_SERIAL
	_device.config.serial_port = OS.get_cmdline_user_args()[0]
	_device.config.arming_time = 0.1
	_device.drive_mode = SpidarG.DRIVE_THREADED
	_device.release_on_focus_loss = false
	_device.fault_raised.connect(func(_code: int, message: String) -> void: print("refused %s" % message))
	_add_clock(-1).ticked.connect(func() -> void: _device_began_us = Time.get_ticks_usec())
	_add_clock(1).ticked.connect(func() -> void: _device_us += Time.get_ticks_usec() - _device_began_us)
	root.add_child(_device)
	_began_us = Time.get_ticks_usec() # the first look, in the scene's start, may take its time


func _add_clock(priority: int) -> Clock:
	var clock := Clock.new()
	clock.process_physics_priority = priority
	root.add_child(clock)
	return clock


func _physics_process(_delta: float) -> bool:
	_device.request_wrench(FORCE_N, Vector3.ZERO, 0.0)
	var state := _device.get_state()
	if state != _told_state:
		_told_state = state
		print("state %d %s %s" % [state, _device.get_state_text(), _device.get_fault_text()])
	match state:
		SpidarG.STATE_CONNECTED:
			_ask()
		SpidarG.STATE_CALIBRATED when not _armed:
			_device.arm()
			_armed = true
		SpidarG.STATE_ACTIVE when Engine.get_physics_frames() % 30 == 0:
			print("active")
		SpidarG.STATE_FAULT, SpidarG.STATE_CLOSED:
			_begin_again(state)
	return false


func _ask() -> void:
	if _asked:
		return
	var info := _device.get_device_info()
	print("share %d" % (100 * _device_us / (Time.get_ticks_usec() - _began_us)))
	print("latency_us %d" % (1e6 * info["latency_s"]))
	print("stiffness %d" % _device.get_stiffness_limits().x)
	print("device %s at %s, rate %.0f, remarks \"%s\"" % [info["product"], info["path"], info["highest_rate_hz"], info["remarks"]])
	_device.forces_enabled = true
	_device.zero_at_home()
	_asked = true


func _begin_again(state: SpidarG.State) -> void:
	_asked = false
	_armed = false
	_fault_ticks += 1
	if state == SpidarG.STATE_FAULT and _fault_ticks % AFTER_FAULT_TICKS == 0:
		_device.clear_fault()
