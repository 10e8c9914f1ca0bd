extends SceneTree
## Nothing is computed for a display that is not seen, and it catches up when it is. Prints FAIL lines and
## "N passed, N failed".

const FreePlay := preload("res://tasks/free_play/free_play.gd")
const Hud := preload("res://ui/hud.gd")

const SETTLE_FRAMES := 20

var _passed := 0
var _failed := 0


func _initialize() -> void:
	_run.call_deferred()


func _run() -> void:
	var task: FreePlay = (load("res://tasks/free_play/free_play.tscn") as PackedScene).instantiate()
	(task.get_node(^"SpidarG") as SpidarG).drive_mode = SpidarG.DRIVE_STEPPED
	root.add_child(task)
	var hud: Hud = task.get_node(^"Hud")
	await _frames()
	_check(hud._tensions.tensions_n.size() == 8, "full: %d tensions shown" % hud._tensions.tensions_n.size())
	for mode: Hud.Mode in [Hud.Mode.OFF, Hud.Mode.SHORT]:
		_go_to(hud, mode)
		_wipe(hud)
		await _frames()
		_check(hud._tensions.tensions_n.is_empty(), "mode %d: the bars are kept up to date" % mode)
		_check(hud._wrench.asked.is_empty(), "mode %d: the wrench is kept up to date" % mode)
		_check((hud._state.text == "") == (mode == Hud.Mode.OFF), "mode %d: state '%s'" % [mode, hud._state.text])
		_check((hud._dial.caption == "") == (mode == Hud.Mode.OFF), "mode %d: dial '%s'" % [mode, hud._dial.caption])
		hud.show_task("title", 1.0, 0, [], 1, 1)
		_check((hud._title.text == "") == (mode == Hud.Mode.OFF), "mode %d: title '%s'" % [mode, hud._title.text])
	_go_to(hud, Hud.Mode.FULL)
	await _frames()
	_check(hud._tensions.tensions_n.size() == 8 and hud._wrench.asked.size() == 7, "full again: caught up")
	print("%d passed, %d failed" % [_passed, _failed])
	quit(0 if _failed == 0 else 1)


func _go_to(hud: Hud, mode: Hud.Mode) -> void:
	while hud.mode != mode:
		hud.next_mode()


func _wipe(hud: Hud) -> void:
	hud._tensions.tensions_n = PackedFloat64Array()
	hud._wrench.asked = PackedFloat64Array()
	hud._state.text = ""
	hud._dial.caption = ""
	hud._title.text = ""


func _frames() -> void:
	for _frame in SETTLE_FRAMES:
		await process_frame


func _check(condition: bool, message: String) -> void:
	if condition:
		_passed += 1
	else:
		_failed += 1
		print("FAIL hidden: " + message)
