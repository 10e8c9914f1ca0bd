extends Node
## Keys that every task shares. Forces start off, come on by one key and ramp up while the device arms,
## and go off at once on the panic key or when the window loses the focus.

const DemoSettings := preload("res://ui/demo_settings.gd")
const Hud := preload("res://ui/hud.gd")
const MouseHand := preload("res://ui/mouse_hand.gd")
const SettingsForm := preload("res://ui/settings_form.gd")

signal restart_wanted
signal leave_wanted

var interactive := false

var _spidar: SpidarG
var _hud: Hud
var _mouse: MouseHand
var _settings: DemoSettings
## Where the grip stood when the clutch was pressed.
var _clutched_at := Vector3.INF
var _zeroing := false
var _steps_left := 0
var _task_name := ""
var _actions: Dictionary[StringName, Callable] = {
	&"demo_forces": toggle_forces,
	&"demo_restart": func() -> void: restart_wanted.emit(),
	&"demo_help": func() -> void: _hud.toggle_help(),
	&"demo_display": func() -> void: _hud.next_mode(),
	&"demo_pause": _toggle_pause,
	&"demo_step": _step_once,
	&"demo_record": _toggle_recording,
	&"demo_leave": _leave,
}


func setup(spidar: SpidarG, hud: Hud, mouse: MouseHand, settings: DemoSettings, task_name: String) -> void:
	_task_name = task_name
	_spidar = spidar
	_spidar.request_rejected.connect(_hud_says)
	_spidar.fault_raised.connect(func(_status: int, message: String) -> void: _hud_says(message))
	_hud = hud
	_mouse = mouse
	_settings = settings
	process_mode = Node.PROCESS_MODE_ALWAYS # Pause and single step work while everything else stands.


func _hud_says(message: String) -> void:
	if interactive:
		_hud.show_notice(message)


func _exit_tree() -> void:
	get_tree().paused = false


func _physics_process(_delta: float) -> void:
	_arm_when_zeroed()
	if _steps_left > 0:
		_steps_left -= 1
		get_tree().paused = _steps_left == 0
	if _clutched_at.is_finite() and _settings.source in [DemoSettings.DEVICE, DemoSettings.SERIAL]:
		# A real hand goes on; the device's frame gives way, so that the grip stays in the scene.
		_spidar.global_position += _clutched_at - _spidar.get_grip_transform().origin


func _clutch(pressed: bool) -> void:
	_mouse.clutched = pressed
	_clutched_at = _spidar.get_grip_transform().origin if pressed else Vector3.INF


## The panic key comes before everything else: a button that has the focus would take Space for itself.
func _input(event: InputEvent) -> void:
	if not interactive or not event.is_action_pressed(&"demo_panic", true):
		return
	if _spidar.forces_enabled:
		_cut_forces("NOTICE_STOPPED")
		get_viewport().set_input_as_handled()
	elif get_viewport().gui_get_focus_owner() is BaseButton:
		get_viewport().set_input_as_handled() # Pressed once too often, it chooses nothing in a menu.


func _unhandled_key_input(event: InputEvent) -> void:
	if not interactive:
		return
	if _settings.clutch == DemoSettings.CLUTCHES[0]:
		if event.is_action_released(&"demo_clutch"):
			_clutch(false)
		elif event.is_action_pressed(&"demo_clutch"):
			_clutch(true)
	elif event.is_action_pressed(&"demo_clutch"):
		_clutch(not _mouse.clutched)
	for action in _actions:
		if event.is_action_pressed(action):
			_actions[action].call()


func _toggle_pause() -> void:
	get_tree().paused = not get_tree().paused
	_hud.show_notice("NOTICE_PAUSED" if get_tree().paused else "")


func _step_once() -> void:
	if get_tree().paused:
		_steps_left = 2 # This frame may be over already.
		get_tree().paused = false


## The help is closed first.
func _leave() -> void:
	if _hud.is_help_shown():
		_hud.toggle_help()
		return
	_spidar.disarm()
	leave_wanted.emit()


func _notification(what: int) -> void:
	if what == NOTIFICATION_APPLICATION_FOCUS_OUT and interactive and _spidar.forces_enabled:
		_cut_forces("NOTICE_FOCUS_LOST")


func toggle_forces() -> void:
	if _spidar.forces_enabled:
		_cut_forces("NOTICE_FORCES_OFF")
		return
	if not _settings.may_have_forces():
		_hud.show_notice("NOTICE_FORCES_FORBIDDEN" if not _settings.forces_allowed else (
			tr("NOTICE_NO_FORCES") % tr(SettingsForm.WORDS[_settings.source])
		))
		return
	_hud.show_notice("")
	_spidar.clear_fault()
	_spidar.forces_enabled = true
	if _settings.source == DemoSettings.SERIAL:
		_zeroing = _spidar.zero_at_home()
		_hud.show_notice("NOTICE_ZERO")
		return
	# A real device arms only when told; a simulated one has armed itself by now.
	_spidar.arm()


## Motor boards count from anywhere: their zero is taken first.
func _arm_when_zeroed() -> void:
	if _zeroing and _spidar.get_state() == SpidarG.STATE_CALIBRATED:
		_zeroing = false
		_hud.show_notice("")
		_spidar.arm()


func _toggle_recording() -> void:
	if _spidar.is_recording():
		_spidar.stop_recording()
		_hud.show_notice("NOTICE_RECORDED")
	elif not _spidar.is_replaying() and _spidar.start_recording(DemoSettings.new_recording(_task_name)):
		_hud.show_notice("")


func _cut_forces(notice: String) -> void:
	_spidar.disarm()
	_spidar.forces_enabled = false
	_hud.show_notice(notice)
