extends "check_case.gd"
## The notice of a low frame rate: it comes after 2 s below 30 frames a second and not before, names the rate and the setting
## that helps, and its button sets that setting.

const FrameRateNotice := preload("res://ui/frame_rate_notice.gd")

var _notice: FrameRateNotice


func _run() -> void:
	about = "frame rate"
	var task := open("pick_and_place")
	await frames(5)
	_notice = task.get_node(^"Hud/%FrameRate")
	_notice.process_mode = Node.PROCESS_MODE_DISABLED # Frames are counted here, by hand.
	_notice.is_plain = false
	_check_threshold()
	_check_text(task)
	_check_hitch()
	await close(task)
	await _check_scripted()


## Frames at this rate for so long.
func _draw(rate_hz: float, time_s: float) -> void:
	for _frame in roundi(rate_hz * time_s):
		_notice.note_frame(1.0 / rate_hz)


func _check_threshold() -> void:
	_draw(60.0, 5.0)
	check(not _notice.visible, "60 frames a second are called low")
	_draw(31.0, 10.0)
	check(not _notice.visible, "31 frames a second are called low")
	_draw(20.0, 1.4)
	check(not _notice.visible, "the notice comes within 1.4 s")
	_draw(60.0, 1.0)
	_draw(20.0, 1.4)
	check(not _notice.visible, "two short slow times are added up")
	_draw(20.0, 1.5)
	check(_notice.visible, "no notice after 2.9 s at 20 frames a second")
	_draw(60.0, 1.0)
	check(_notice.visible, "the notice goes after 1 s")
	_draw(60.0, 2.0)
	check(not _notice.visible, "the notice stays")


func _check_text(task: DemoTask) -> void:
	_draw(12.0, 4.0)
	var text := (_notice.get_node(^"Rows/Text") as Label).text
	check(text.contains("12"), "the text does not name the rate: " + text)
	check(text.to_lower().contains("plain picture"), "the text does not name the setting: " + text)
	var button: Button = _notice.get_node(^"Rows/Plain")
	check(button.visible and button.text.contains("V"), "the button is %s" % button.text)
	button.pressed.emit()
	check(task.settings.picture == "plain" and not _notice.visible, "the button does not set the plain picture")
	check(root.scaling_3d_scale < 1.0, "the plain picture is not shown")
	check(DemoSettings.load_or_default().picture == "plain", "the setting is not saved")
	_draw(12.0, 4.0)
	check(_notice.visible and not button.visible, "with the plain picture there is nothing to offer")
	_draw(60.0, 4.0)
	DirAccess.remove_absolute(DemoSettings.PATH)


## A scene that loads for two seconds is not slow.
func _check_hitch() -> void:
	_notice.note_frame(2.5)
	_draw(60.0, 0.5)
	_notice.note_frame(2.5)
	check(not _notice.visible, "two long frames are called a low rate")


## Nobody reads it in a scripted play or in a trial of the experiment, where the picture must stay as it is.
func _check_scripted() -> void:
	var task: DemoTask = (load(SCENES["pick_and_place"]) as PackedScene).instantiate()
	task.in_experiment = true
	(task.get_node(^"SpidarG") as SpidarG).drive_mode = SpidarG.DRIVE_STEPPED
	root.add_child(task)
	await frames(5)
	check(not task.get_node(^"Hud/%FrameRate").can_process(), "the notice runs in the experiment")
	await close(task)
