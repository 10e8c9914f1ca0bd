@tool
extends VBoxContainer
## Shows the six steps of the calibration panel, one at a time.

## Emitted when the user accepts the result of the calibration.
signal accepted
## Emitted when the user wants to save the calibration in use.
signal saved

const CalibrationSession := preload("calibration_session.gd")
const ResidualPlot := preload("residual_plot.gd")

const SHORT_VERDICTS: PackedStringArray = [
	"...", "right", "no movement", "WRONG STRING", "other way round", "not lifted", "too fast", "stopped", "not ready",
	"too warm"
]

var _session: CalibrationSession
var _pages: Array[VBoxContainer] = []
var _device_buttons: Array[Button] = []
var _simulated_only: Array[Control] = []

var _wiring: Array[Label] = []  # strings 1 to 4, 5 to 8
var _zero: Label
var _string: SpinBox
var _length: SpinBox
var _lengths: Label
var _taut: CheckButton
var _motion: Button
var _progress: ProgressBar
var _coverage: Label
var _weighed: SpinBox
var _weight: SpinBox
var _weights: Label
var _plot: ResidualPlot
var _result: Label
var _accept: Button
var _save: Button


func set_up(session: CalibrationSession) -> void:
	_session = session
	_build_wiring()
	_build_zero()
	_build_ruler()
	_build_motion()
	_build_weights()
	_build_result()


## Shows the page of the current step with its newest values. `has_calibration` states whether there is a calibration to save.
func refresh(has_calibration: bool) -> void:
	var is_open: bool = _session.is_open()
	for page: int in _pages.size():
		_pages[page].visible = page == _session.step
	for button: Button in _device_buttons:
		button.disabled = not is_open or (_session.is_task_running() and button.name != "Stop")
	for control: Control in _simulated_only:
		control.visible = is_open and _session.is_simulated()
	_taut.visible = not (is_open and _session.is_simulated())
	match _session.step:
		CalibrationSession.Step.WIRING:
			_show_wiring()
		CalibrationSession.Step.ZERO:
			_show_zero()
		CalibrationSession.Step.RULER:
			_show_lengths()
		CalibrationSession.Step.MOTION:
			_show_motion()
		CalibrationSession.Step.WEIGHTS:
			_show_weights()
		CalibrationSession.Step.RESULT:
			_show_result()
	_accept.disabled = not (_session.is_done(CalibrationSession.Step.ZERO) or _is_usable())
	_save.disabled = not has_calibration


func _is_usable() -> bool:
	return _session.calibrator.get_result().get("usable", false)


func _page(text: String) -> VBoxContainer:
	var page: VBoxContainer = VBoxContainer.new()
	_label(page, text)
	_pages.append(page)
	add_child(page)
	return page


func _label(page: Control, text: String = "") -> Label:
	var label: Label = Label.new()
	label.text = text
	label.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	label.custom_minimum_size = Vector2(120, 0)
	page.add_child(label)
	return label


func _button(page: Control, text: String, node_name: String, pressed: Callable, tooltip: String = "") -> Button:
	var button: Button = Button.new()
	button.text = text
	button.name = node_name
	button.tooltip_text = tooltip
	button.pressed.connect(pressed)
	button.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	page.add_child(button)
	return button


func _device_button(page: Control, text: String, node_name: String, pressed: Callable, tooltip: String = "") -> Button:
	var button: Button = _button(page, text, node_name, pressed, tooltip)
	_device_buttons.append(button)
	return button


func _row(page: Control) -> HBoxContainer:
	var row: HBoxContainer = HBoxContainer.new()
	page.add_child(row)
	return row


func _spin(page: Control, prefix: String, node_name: String, low: float, high: float, step: float, suffix: String) -> SpinBox:
	var spin: SpinBox = SpinBox.new()
	spin.name = node_name
	spin.prefix = prefix
	spin.suffix = suffix
	spin.min_value = low
	spin.max_value = high
	spin.step = step
	spin.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	page.add_child(spin)
	return spin


func _build_wiring() -> void:
	var page: VBoxContainer = _page(
		"Hold the grip lightly in the middle. MOTORS WILL PULL: 0.5 N on all strings, 2 N on one after the other."
	)
	var row: HBoxContainer = _row(page)
	_device_button(
		row, "Check all strings", "CheckWiring", _session.check_wiring,
		"Pulls one string after the other and checks which encoder winds in."
	)
	_device_button(row, "Stop", "Stop", _session.stop, "Stops the task and switches the motors off.")
	row = _row(page)
	for _column: int in 2:
		var label: Label = _label(row)
		label.size_flags_horizontal = Control.SIZE_EXPAND_FILL
		_wiring.append(label)


func _build_zero() -> void:
	var page: VBoxContainer = _page("Put the grip into its stand at the home pose, with taut strings. Read the zero several times.")
	var row: HBoxContainer = _row(page)
	_device_button(row, "Read zero", "ReadZero", _session.read_zero, "Takes the current encoder counts as those of the home pose.")
	_button(row, "Clear", "ClearZero", _session.clear_zero, "Forgets all readings at the home pose.")
	_zero = _label(page)


func _build_ruler() -> void:
	var page: VBoxContainer = _page(
		"This step is optional. Measure a string with a ruler from its exit to the grip, at two lengths or more, each one twice."
	)
	var row: HBoxContainer = _row(page)
	_string = _spin(row, "String", "RulerString", 1, 8, 1, "")
	_length = _spin(row, "", "RulerLength", 1, 2000, 0.1, "mm")
	row = _row(page)
	_device_button(row, "Read length", "ReadLength", _read_length, "Takes this length for the current encoder count of the string.")
	_button(
		row, "Clear", "ClearLengths", func() -> void: _session.clear_lengths(int(_string.value) - 1),
		"Forgets all lengths of this string."
	)
	row = _row(page)
	_simulated_only.append(row)
	_device_button(row, "Move hand", "MoveHand", _session.move_to_next_place, "Moves the simulated hand to its next place.")
	_device_button(row, "Look at ruler", "LookAtRuler", _look_at_ruler, "Enters the length that the simulated ruler shows.")
	_lengths = _label(page)


func _build_motion() -> void:
	var page: VBoxContainer = _page(
		"Move and turn the grip by hand through the whole workspace, and open and close it, until the bar is full."
	)
	_taut = CheckButton.new()
	_taut.text = "Motors hold strings taut (0.5 N)"
	_taut.name = "Taut"
	_taut.tooltip_text = "A real device counts correctly only while its strings are taut."
	_taut.toggled.connect(_session.set_taut)
	page.add_child(_taut)
	_motion = _device_button(page, "Start", "Motion", _start_or_stop_motion, "Starts or stops the collection of poses.")
	_progress = ProgressBar.new()
	_progress.max_value = 1.0
	_progress.name = "Progress"
	page.add_child(_progress)
	_coverage = _label(page)


func _build_weights() -> void:
	var page: VBoxContainer = _page(
		"This step is optional. Take a string off the grip and hang a known weight on it. ITS MOTOR WILL PULL until the weight rises."
	)
	var row: HBoxContainer = _row(page)
	_weighed = _spin(row, "String", "WeighedString", 1, 8, 1, "")
	_weight = _spin(row, "", "Weight", 0.5, 4.0, 0.01, "N")
	_weight.value = 2.0
	_weight.tooltip_text = "The weight in newtons is the mass in kilograms times 9.81."
	row = _row(page)
	_device_button(
		row, "Weigh", "Weigh", func() -> void: _session.weigh(int(_weighed.value) - 1, _weight.value),
		"Pulls the string until the weight rises, and lets go until it sinks."
	)
	_device_button(row, "Stop", "Stop", _session.stop, "Stops the task and switches the motors off.")
	_simulated_only.append(
		_device_button(page, "Weigh all (simulated scale)", "WeighAll", func() -> void: _session.weigh_all(_weight.value))
	)
	_weights = _label(page)
	_weights.name = "Weights"


func _build_result() -> void:
	var page: VBoxContainer = _page("Residuals of the string lengths, before and after the calibration:")
	_plot = ResidualPlot.new()
	_plot.name = "Plot"
	page.add_child(_plot)
	_result = _label(page)
	var row: HBoxContainer = _row(page)
	_accept = _button(row, "Accept", "Accept", accepted.emit, "Puts the result into the scene. This can be undone.")
	_save = _button(row, "Save as ...", "Save", saved.emit, "Saves the calibration in use as a file.")


func _read_length() -> void:
	_session.read_length(int(_string.value) - 1, 1e-3 * _length.value)


func _look_at_ruler() -> void:
	_length.value = 1e3 * _session.read_ruler(int(_string.value) - 1)


func _start_or_stop_motion() -> void:
	if _session.moving:
		_session.stop_motion()
	else:
		_session.start_motion()


func _show_wiring() -> void:
	for column: int in 2:
		var lines: PackedStringArray = []
		for string: int in range(4 * column, 4 * column + 4):
			var verdict: int = _session.wiring[string]
			lines.append("%d  %s" % [string + 1, SHORT_VERDICTS[verdict] if verdict >= 0 else "-"])
		_wiring[column].text = "\n".join(lines)


func _show_zero() -> void:
	var zero: Dictionary = _session.calibrator.get_zero()
	var spread: PackedFloat64Array = zero["spread_m"]
	var worst: float = Array(spread).max()
	_zero.text = "%d readings" % zero["repeats"]
	if zero["repeats"] > 1:
		_zero.text += ", spread of the worst string %.3f mm" % (1e3 * worst)


func _show_lengths() -> void:
	var told: Dictionary = _session.calibrator.get_lengths(int(_string.value) - 1)
	var lengths: PackedFloat64Array = told["lengths_m"]
	var text: PackedStringArray = ["%d readings of this string" % lengths.size()]
	if told["status"] >= 0:
		text.append("scale %.4f um per count" % (1e6 * told["scale_m_per_count"]))
		text.append("residual %.2f mm rms" % (1e3 * told["residual_rms_m"]))
	if told["repeated_points"] > 0:
		text.append("spread of repeats %.2f mm" % (1e3 * told["repeat_spread_m"]))
	_lengths.text = "\n".join(text)


func _show_motion() -> void:
	_motion.text = "Stop" if _session.moving else "Start"
	_progress.value = _session.get_progress()
	var covered: Dictionary = _session.calibrator.get_coverage()
	var travel: PackedStringArray = []
	var travel_m: PackedFloat64Array = _numbers(covered["travel_m"])
	for axis: int in 3:
		travel.append("%.0f" % (1e2 * travel_m[axis]))
	_coverage.text = "%d poses. Covered: %s cm, turns to %.0f deg, grasp over %.0f deg." % [
		covered["poses"], " x ".join(travel), rad_to_deg(covered["turn_rad"]), rad_to_deg(covered["grasp_rad"])
	]
	var result: Dictionary = _session.calibrator.get_result()
	if result.get("status", -1) >= 0:
		_coverage.text += "\nExpected error of the grip: %.3f mm" % (1e3 * result["grip_error_rms_m"])


func _numbers(vector: Vector3) -> PackedFloat64Array:
	return [vector.x, vector.y, vector.z]


func _show_weights() -> void:
	var lines: PackedStringArray = []
	for string: int in 8:
		var told: Dictionary = _session.calibrator.get_weights(string)
		var text: String = "-"
		if told["repeats"] > 0:
			text = "gain %.3f, friction %.2f N" % [told["gain"], told["friction_n"]]
		if told["repeats"] > 1:
			text += ", spread %.3f" % told["spread"]
		lines.append("%d  %s" % [string + 1, text])
	_weights.text = "\n".join(lines)


func _show_result() -> void:
	var result: Dictionary = _session.calibrator.get_result()
	_plot.visible = result["known"]
	if not result["known"]:
		_result.text = "There is no free motion yet. Accept takes only the zero, the lengths and the weights."
		return
	_plot.show_residuals(result["residuals_before_m"], result["residuals_after_m"])
	if not result["usable"]:
		_result.text = result["refusal"]
		return
	_result.text = "Expected errors (rms): grip %.3f mm, offsets %.3f mm. %d poses used, %d left out." % [
		1e3 * result["grip_error_rms_m"], 1e3 * result["offset_error_rms_m"], result["used"], result["left_out"]
	]
	for weak: String in result["weak"]:
		_result.text += "\nThis motion does not determine: %s" % weak
