## What the boards keep in their flash, by SpidarGCalibrator: -- PORT UDP_PORT. Prints "ok" and "FAIL" lines, then "done".
extends "calibrator_script.gd"

const LIMIT_S := 8.0

var _config := SpidarGConfig.new()


func _initialize() -> void:
	_run()


func _run() -> void:
	var words := OS.get_cmdline_user_args()
	_model = BoardModel.new(words[1].to_int())
	_check(not _calibrator.read_boards(_config), "no serial boards: %s" % _calibrator.get_problem())
	_config.transport = SpidarGConfig.TRANSPORT_SERIAL
	_config.serial_port = words[0]
	await _refuse_while_in_use()
	await _read()
	_refuse_nonsense()
	await _set_mask()
	_check(_flash_writes() == 1, "written once")
	print("done")
	quit()


func _refuse_while_in_use() -> void:
	var device := SpidarG.new()
	device.name = "Player"
	device.config = _config
	root.add_child(device)
	await _until(func() -> bool: return device.get_state() != SpidarG.STATE_CLOSED, LIMIT_S)
	_check(_calibrator.read_boards(_config), "asks while a node has the port")
	await _until(func() -> bool: return not _calibrator.is_using_boards(), LIMIT_S)
	_check(_calibrator.get_problem().contains("\"Player\""), "refused: %s" % _calibrator.get_problem())
	device.free()
	_calibrator.open(_config, null)
	await _until(func() -> bool: return _calibrator.get_live()["readings"] > 0, LIMIT_S)
	var remarks: String = _calibrator.get_live()["remarks"]
	_check(remarks.contains("quadrature"), "the calibrator says what is wrong: %s" % remarks)
	_check(not _calibrator.read_boards(_config), "open: %s" % _calibrator.get_problem())
	_calibrator.close()
	await _until(func() -> bool: return _calibrator.get_device_state() == SpidarGCalibrator.DEVICE_CLOSED, LIMIT_S)


func _read() -> void:
	_check(_calibrator.read_boards(_config), "reads %s" % _calibrator.get_problem())
	await _until(func() -> bool: return not _calibrator.is_using_boards(), LIMIT_S)
	var boards := _calibrator.get_boards()
	_check(boards.size() == 1, "boards: %s %s" % [boards, _calibrator.get_problem()])
	if boards.size() == 1:
		_check(boards[0]["model"] == "B5M" and boards[0]["id"] == 1 and boards[0]["stored_id"] == 1, "which board")
		_check(boards[0]["motors"] == 8, "motors")


func _refuse_nonsense() -> void:
	_check(not _calibrator.write_board_parameter("B5M with id 1 at %s" % _config.serial_port), "nothing was proposed")
	var told := _calibrator.propose_board_parameter(2, SpidarGCalibrator.PARAMETER_QUADRATURE_MASK, 255)
	_check(not told["allowed"], told["text"])
	told = _calibrator.propose_board_parameter(1, SpidarGCalibrator.PARAMETER_QUADRATURE_MASK, -1)
	_check(not told["allowed"], told["text"])
	told = _calibrator.propose_board_parameter(1, SpidarGCalibrator.PARAMETER_BOARD_ID, 9)
	_check(not told["allowed"], told["text"])
	told = _calibrator.propose_board_parameter(1, SpidarGCalibrator.PARAMETER_QUADRATURE_MASK, 255)
	_check(told["allowed"], told["text"])
	_check(not _calibrator.write_board_parameter("B5M"), "no exact name: %s" % _calibrator.get_problem())
	_check(not _calibrator.write_board_parameter(told["board"]), "a proposal ends with a wrong name")
	_check(_flash_writes() == 0, "nothing was written")


func _set_mask() -> void:
	var told := _calibrator.propose_board_parameter(1, SpidarGCalibrator.PARAMETER_QUADRATURE_MASK, 255)
	_check(_flash_writes() == 0, "a proposal sends nothing")
	_check(_calibrator.write_board_parameter(told["board"]), "confirmed %s" % _calibrator.get_problem())
	await _until(func() -> bool: return not _calibrator.is_using_boards(), LIMIT_S)
	var result := _calibrator.get_board_result()
	_check(result["known"] and result["written"] and result["value_before"] == 0 and result["value_found"] == 255, "%s" % result["text"])
	_check(_calibrator.get_boards().is_empty(), "to be read again")
	await _read()
	_check(_calibrator.get_boards()[0]["quadrature_mask"] == 255, "read again")


func _flash_writes() -> int:
	OS.delay_msec(5)
	return int(_model.tell()["flash_writes"])


func _check(good: bool, what: String) -> void:
	print("%s parameters: %s" % ["ok  " if good else "FAIL", what])
