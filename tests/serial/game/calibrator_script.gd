extends SceneTree
## What scripts that work a SpidarGCalibrator on the boards' model share.

const BoardModel := preload("board_model.gd")

var _model: BoardModel
var _calibrator := SpidarGCalibrator.new()


## Looks at the calibrator in each frame, as a panel does. False: not within the limit.
func _until(condition: Callable, limit_s: float) -> bool:
	var began_ms := Time.get_ticks_msec()
	while Time.get_ticks_msec() - began_ms < 1e3 * limit_s:
		_calibrator.poll()
		if condition.call():
			return true
		await process_frame
	return false
