@tool
extends VBoxContainer
## This is the calibration panel of the inspector. It shows the device, its live readings, and one step of the calibration at a
## time. The session holds the state, so the inspector may remove and recreate the panel at any time.

const CalibrationSession := preload("calibration_session.gd")
const CalibrationTarget := preload("calibration_target.gd")
const CalibrationPages := preload("calibration_pages.gd")
const BoardParameters := preload("board_parameters.gd")

## The time between two refreshes of the numbers, in seconds.
const REFRESH_S: float = 0.1
## The device of a session without a panel is closed after this time, in seconds. The inspector needs less time to recreate a
## panel.
const GRACE_S: float = 0.6
const PRESETS: PackedStringArray = ["Custom", "Paper", "SpidarG6X3R", "SpidarG6X3L", "SpidarG6X5R", "SpidarG6X5L", "SpidarG6X4"]
const SMALL_FONT: int = 12

var _session: CalibrationSession
var _target: CalibrationTarget
var _history: Object
var _pages: CalibrationPages
var _since_refresh_s: float = REFRESH_S

var _fold: Button = Button.new()
var _body: VBoxContainer = VBoxContainer.new()
var _preset: OptionButton = OptionButton.new()
var _practice: Button = Button.new()
var _open: Button = Button.new()
var _boards: BoardParameters = BoardParameters.new()
var _state: Label = Label.new()
var _live: Label = Label.new()
var _quality: Label = Label.new()
var _title: Label = Label.new()
var _back: Button = Button.new()
var _next: Button = Button.new()
var _message: Label = Label.new()


func set_up(session: CalibrationSession, target: CalibrationTarget, history: Object) -> void:
	_session = session
	_target = target
	_history = history
	_build()


func _enter_tree() -> void:
	if _session != null:
		_session.set_meta("holders", int(_session.get_meta("holders", 0)) + 1)
		_session.changed.connect(_refresh)
		_refresh()


func _exit_tree() -> void:
	if _session == null:
		return
	_session.changed.disconnect(_refresh)
	_session.set_meta("holders", int(_session.get_meta("holders", 0)) - 1)
	get_tree().create_timer(GRACE_S).timeout.connect(_close_unheld.bind(_session))


# Closes the device if no panel shows its session any more.
static func _close_unheld(session: CalibrationSession) -> void:
	if session.get_meta("holders", 0) == 0:
		session.close_device()


func _process(delta: float) -> void:
	_session.update(delta)
	_since_refresh_s += delta
	if _since_refresh_s >= REFRESH_S:
		_refresh()


func _build() -> void:
	name = "SpidarGCalibrationPanel"
	_fold.text = "Calibration"
	_fold.name = "Fold"
	_fold.toggle_mode = true
	_fold.button_pressed = _session.is_busy() or _session.has_meta("unfolded")
	_fold.tooltip_text = "Measures this device: wiring, zero, string lengths and motors."
	_fold.toggled.connect(_show_body)
	add_child(_fold)
	add_child(_body)
	_body.visible = _fold.button_pressed
	_build_device()
	_live.add_theme_font_size_override("font_size", SMALL_FONT)
	_live.name = "Live"
	_body.add_child(_live)
	_wrap(_quality)
	_quality.name = "Quality"
	_quality.add_theme_font_size_override("font_size", SMALL_FONT)
	_body.add_child(_quality)
	_body.add_child(HSeparator.new())
	_build_steps()
	_wrap(_message)
	_message.name = "Message"
	_body.add_child(_message)


func _show_body(shown: bool) -> void:
	_body.visible = shown
	_session.set_meta("unfolded", true)
	if not shown:
		_session.remove_meta("unfolded")
		_session.close_device()
	_refresh()


func _build_device() -> void:
	var choice: HBoxContainer = HBoxContainer.new()
	_body.add_child(choice)
	var label: Label = Label.new()
	label.text = "Preset"
	choice.add_child(label)
	for preset: String in PRESETS:
		_preset.add_item(preset)
	_preset.name = "Preset"
	_preset.tooltip_text = "Selects the device. Sets the preset of the node's config, and creates a config if there is none."
	_preset.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_preset.item_selected.connect(
		func(index: int) -> void:
			_target.end_practice()
			_target.set_preset(_history, index)
	)
	choice.add_child(_preset)
	_practice.text = "Practice: unknown errors"
	_practice.name = "Practice"
	_practice.tooltip_text = "Gives the simulated device unknown errors, which the calibration has to find."
	_practice.pressed.connect(_draw_errors)
	_body.add_child(_practice)
	var row: HBoxContainer = HBoxContainer.new()
	_body.add_child(row)
	_boards.set_up(_session, _target.get_config)
	_body.add_child(_boards)
	_open.name = "Open"
	_open.tooltip_text = "Opens or closes the device. Opening it moves no motor. The device closes when this panel is closed."
	_open.pressed.connect(_open_or_close)
	row.add_child(_open)
	_state.name = "State"
	_state.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_state.clip_text = true
	row.add_child(_state)


func _build_steps() -> void:
	var row: HBoxContainer = HBoxContainer.new()
	_body.add_child(row)
	_back.text = "<"
	_back.name = "Back"
	_back.tooltip_text = "Goes to the previous step. A task that runs is stopped."
	_back.pressed.connect(func() -> void: _session.go_to(_session.step - 1))
	row.add_child(_back)
	_title.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_title.horizontal_alignment = HORIZONTAL_ALIGNMENT_CENTER
	_title.clip_text = true
	_title.name = "Title"
	row.add_child(_title)
	_next.text = ">"
	_next.name = "Next"
	_next.tooltip_text = "Goes to the next step. A task that runs is stopped."
	_next.pressed.connect(func() -> void: _session.go_to(_session.step + 1))
	row.add_child(_next)
	_pages = CalibrationPages.new()
	_pages.set_up(_session)
	_pages.accepted.connect(_accept)
	_pages.saved.connect(_save)
	_body.add_child(_pages)


func _wrap(label: Label) -> void:
	label.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	label.custom_minimum_size = Vector2(120, 0)


func _draw_errors() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.randomize()
	_target.draw_practice_errors(random)
	_session.message_is_problem = false
	_session.message = "The practice is prepared: open the device. Your scene keeps its settings, and closing the device ends the practice."
	_refresh()


func _open_or_close() -> void:
	if _session.is_busy():
		_session.close_device()
		_target.end_practice()
	else:
		_session.open_device(_target.get_config(), _target.get_calibration())
	_refresh()


func _accept() -> void:
	var made: SpidarGCalibration = _session.make_calibration()
	if made != null:
		_target.accept(_history, made)
		_session.message = "The calibration was accepted; Ctrl+Z undoes it. Save it to use it in other scenes."
		if _target.is_practice():
			_session.message = "The calibration of a simulated device was accepted. Undo it with Ctrl+Z before you use a real device."
		_refresh()


func _save() -> void:
	var dialog: EditorFileDialog = EditorFileDialog.new()
	dialog.name = "SaveCalibration"
	dialog.file_mode = EditorFileDialog.FILE_MODE_SAVE_FILE
	dialog.add_filter("*.tres", "SpidarGCalibration")
	dialog.current_path = "res://spidar_g_calibration.tres"
	dialog.file_selected.connect(_save_to)
	dialog.visibility_changed.connect(
		func() -> void:
			if not dialog.visible:
				dialog.queue_free()
	)
	EditorInterface.popup_dialog_centered(dialog, Vector2i(760, 520))


func _save_to(path: String) -> void:
	var calibration: SpidarGCalibration = _target.get_calibration()
	var error: Error = ResourceSaver.save(calibration, path) if calibration != null else ERR_DOES_NOT_EXIST
	if error == OK:
		calibration.take_over_path(path)
		EditorInterface.get_resource_filesystem().update_file(path)
	_session.message_is_problem = error != OK
	_session.message = "Saved: %s" % path if error == OK else "%s: %s" % [path, error_string(error)]
	_refresh()


func _refresh() -> void:
	_since_refresh_s = 0.0
	var busy: bool = _session.is_busy()
	set_process(busy)
	var config: SpidarGConfig = _target.get_config()
	_preset.select(config.preset if config != null else 0)
	var has_node: bool = is_instance_valid(_target.node)
	_preset.disabled = busy or not has_node
	_practice.disabled = busy or not has_node
	_open.text = "Close device" if busy else "Open device"
	_state.text = _state_text()
	var is_open: bool = _session.is_open()
	_live.visible = is_open and _session.step != CalibrationSession.Step.RESULT
	_quality.visible = is_open
	if is_open:
		_show_live()
	_title.text = "%d/%d  %s%s" % [
		_session.step + 1,
		CalibrationSession.Step.size(),
		CalibrationSession.STEP_NAMES[_session.step],
		"  (done)" if _session.is_done(_session.step) else ""
	]
	_back.disabled = _session.step == 0
	_next.disabled = _session.step == CalibrationSession.Step.size() - 1
	_message.text = _session.message
	_message.visible = not _session.message.is_empty()
	var colour: String = "error_color" if _session.message_is_problem else "success_color"
	_message.add_theme_color_override("font_color", get_theme_color(colour, "Editor"))
	_boards.refresh()
	_pages.refresh(_target.get_calibration() != null)


func _state_text() -> String:
	match _session.calibrator.get_device_state():
		SpidarGCalibrator.DEVICE_OPENING:
			return "opening ..."
		SpidarGCalibrator.DEVICE_OPEN:
			var motors: String = ", MOTORS ON" if _session.calibrator.get_live()["motors_on"] else ", motors off"
			if _target.is_practice():
				return "practice" + motors
			return ("simulated" if _session.is_simulated() else "device") + motors
		SpidarGCalibrator.DEVICE_FAILED:
			return "not opened"
	return "closed"


func _show_live() -> void:
	var live: Dictionary = _session.calibrator.get_live()
	var lines: PackedStringArray = ["string     count     length mm   pull N"]
	for string: int in 8:
		lines.append(
			"%d      %9d     %9.2f     %5.2f"
			% [string + 1, live["counts"][string], 1e3 * live["lengths_m"][string], live["tensions_n"][string]]
		)
	_live.text = "\n".join(lines)
	_quality.text = "Residual of the string lengths: %.3f mm." % (1e3 * live["residual_m"])
	if live["pose_status"] != 0:
		_quality.text += " Pose: %s" % live["pose_text"]
	_quality.tooltip_text = live["fallback_reason"]
