@tool
extends VBoxContainer
## Shows the parameters in the flash memory of serial motor boards. It writes a parameter only after the user has confirmed
## the value and the board. It is visible for a config with the transport Serial.

const CalibrationSession := preload("calibration_session.gd")

const PARAMETER_NAMES: Array[String] = ["Quadrature mask", "Board id"]
const PARAMETERS: Array[SpidarGCalibrator.BoardParameter] = [
	SpidarGCalibrator.PARAMETER_QUADRATURE_MASK, SpidarGCalibrator.PARAMETER_BOARD_ID
]

var _session: CalibrationSession
var _get_config: Callable
var _read: Button = Button.new()
var _boards: Label = Label.new()
var _row: HBoxContainer = HBoxContainer.new()
var _board: OptionButton = OptionButton.new()
var _parameter: OptionButton = OptionButton.new()
var _value: SpinBox = SpinBox.new()
var _write: Button = Button.new()
var _waits: bool = false
var _writes: bool = false


## Creates the controls. `get_config` returns the SpidarGConfig to work with, or [code]null[/code].
func set_up(session: CalibrationSession, get_config: Callable) -> void:
	_session = session
	_get_config = get_config
	_read.text = "Read boards"
	_read.name = "ReadBoards"
	_read.tooltip_text = "Reads the flash memory of the motor boards and writes nothing. The device must be closed."
	_read.pressed.connect(_read_boards)
	add_child(_read)
	_boards.name = "Boards"
	_boards.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	_boards.custom_minimum_size = Vector2(120, 0)
	add_child(_boards)
	_board.name = "Board"
	_board.item_selected.connect(func(_index: int) -> void: _show_value())
	for text: String in PARAMETER_NAMES:
		_parameter.add_item(text)
	_parameter.name = "BoardParameter"
	_parameter.item_selected.connect(func(_index: int) -> void: _show_value())
	_value.name = "BoardValue"
	_value.max_value = 255
	_row.add_child(_board)
	_row.add_child(_parameter)
	_row.add_child(_value)
	add_child(_row)
	_write.text = "Write to flash ..."
	_write.name = "WriteBoard"
	_write.tooltip_text = "Shows what would be written to which board, and asks for confirmation."
	_write.pressed.connect(_propose)
	add_child(_write)


func refresh() -> void:
	var config: SpidarGConfig = _get_config.call()
	visible = config != null and config.transport == SpidarGConfig.TRANSPORT_SERIAL
	if _waits and not _session.calibrator.is_using_boards():
		_waits = false
		_take()
	var boards: Array = _session.calibrator.get_boards()
	_read.disabled = _session.is_busy()
	_write.disabled = _session.is_busy()
	_row.visible = not boards.is_empty()
	_write.visible = not boards.is_empty()
	_boards.visible = not boards.is_empty()


func _read_boards() -> void:
	_writes = false
	_waits = _session.calibrator.read_boards(_get_config.call() as SpidarGConfig)
	_session.tell("" if _waits else _session.calibrator.get_problem(), not _waits)


func _take() -> void:
	var problem: String = _session.calibrator.get_problem()
	if _writes:
		var result: Dictionary = _session.calibrator.get_board_result()
		_session.tell(result["text"], not result["written"])
		return
	_session.tell(problem, true)
	_board.clear()
	var lines: PackedStringArray = []
	for board: Dictionary in _session.calibrator.get_boards():
		lines.append("%s\nid %d, quadrature mask 0x%02x" % [board["board"], board["stored_id"], board["quadrature_mask"]])
		_board.add_item("id %d" % board["id"], board["id"])
	_boards.text = "\n".join(lines)
	_show_value()


# Proposes the usual value: all motors are read by their encoders, and the id stays as it is.
func _show_value() -> void:
	for board: Dictionary in _session.calibrator.get_boards():
		if board["id"] == _board.get_selected_id():
			var motors: int = board["motors"]
			_value.value = (1 << motors) - 1 if _parameter.selected == 0 else board["stored_id"]


func _propose() -> void:
	var told: Dictionary = _session.calibrator.propose_board_parameter(
		_board.get_selected_id(), PARAMETERS[_parameter.selected], int(_value.value)
	)
	if not told["allowed"]:
		_session.tell(told["text"], true)
		return
	var dialog: ConfirmationDialog = ConfirmationDialog.new()
	dialog.title = "Write to flash"
	dialog.dialog_text = "%s\nThe board keeps the value when it is switched off." % told["text"]
	dialog.ok_button_text = "Write"
	dialog.confirmed.connect(_confirm.bind(told["board"]))
	dialog.visibility_changed.connect(
		func() -> void:
			if not dialog.visible:
				dialog.queue_free()
	)
	EditorInterface.popup_dialog_centered(dialog)


func _confirm(board: String) -> void:
	_writes = true
	_waits = _session.calibrator.write_board_parameter(board)
	_session.tell("" if _waits else _session.calibrator.get_problem(), not _waits)
