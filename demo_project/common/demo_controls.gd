class_name DemoControls
extends Node
## Keys that every task shares. Forces start off, come on by one key and ramp up while the device arms,
## and go off at once on the panic key or when the window loses the focus.

signal restart_wanted

var interactive := false

var _spidar: SpidarG
var _hud: Hud


func setup(spidar: SpidarG, hud: Hud) -> void:
	_spidar = spidar
	_hud = hud


func _unhandled_key_input(event: InputEvent) -> void:
	var key := event as InputEventKey
	if not interactive or not key.pressed or key.echo:
		return
	match key.physical_keycode:
		KEY_SPACE:
			_cut_forces("Stopped. F turns the forces on again.")
		KEY_F:
			_toggle_forces()
		KEY_R:
			restart_wanted.emit()
		KEY_H:
			_hud.toggle_help()
		KEY_TAB:
			_hud.next_mode()
		KEY_ESCAPE:
			_spidar.disarm()
			get_tree().quit()


func _notification(what: int) -> void:
	if what == NOTIFICATION_APPLICATION_FOCUS_OUT and interactive and _spidar.forces_enabled:
		_cut_forces("Forces went off with the window's focus. F turns them on.")


func _toggle_forces() -> void:
	if _spidar.forces_enabled:
		_cut_forces("Forces are off. F turns them on.")
		return
	_hud.show_notice("")
	_spidar.clear_fault()
	_spidar.forces_enabled = true
	# A real device arms only when told; a simulated one has armed itself by now.
	_spidar.arm()


func _cut_forces(notice: String) -> void:
	_spidar.disarm()
	_spidar.forces_enabled = false
	_hud.show_notice(notice)
