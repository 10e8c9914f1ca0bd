@tool
extends EditorInspectorPlugin
## Puts the calibration panel on top of the inspector of a SpidarG node or a SpidarGCalibration. The inspector removes and
## recreates the panel when it redraws. The session is kept meanwhile. Its device is closed when no panel shows the session
## any more.

const CalibrationPanel := preload("calibration_panel.gd")
const CalibrationSession := preload("calibration_session.gd")
const CalibrationTarget := preload("calibration_target.gd")

## The EditorUndoRedoManager in which the panel records its changes.
var history: Object

var _sessions: Dictionary[int, CalibrationSession] = {}


func _can_handle(object: Object) -> bool:
	return object is SpidarG or object is SpidarGCalibration


func _parse_begin(object: Object) -> void:
	var target: CalibrationTarget = CalibrationTarget.new()
	target.node = object as SpidarG
	target.resource = object as SpidarGCalibration
	if target.resource != null:
		target.node = _user_of(target.resource, EditorInterface.get_edited_scene_root())
	var panel: CalibrationPanel = CalibrationPanel.new()
	panel.set_up(_session_of(object if target.node == null else target.node), target, history)
	add_custom_control(panel)


## Switches the motors off and closes all devices, because the plugin is removed.
func close_all() -> void:
	for id: int in _sessions:
		_sessions[id].close_device()
	_sessions.clear()


func _session_of(object: Object) -> CalibrationSession:
	for id: int in _sessions.keys():
		if not is_instance_id_valid(id):
			_sessions[id].close_device()
			_sessions.erase(id)
	var key: int = object.get_instance_id()
	if not _sessions.has(key):
		_sessions[key] = CalibrationSession.new()
	return _sessions[key]


# Returns the node of the edited scene that uses this calibration, or null.
func _user_of(calibration: SpidarGCalibration, from: Node) -> SpidarG:
	if from == null:
		return null
	var device: SpidarG = from as SpidarG
	if device != null and device.calibration == calibration:
		return device
	for child: Node in from.get_children():
		var found: SpidarG = _user_of(calibration, child)
		if found != null:
			return found
	return null
