extends "res://test_case.gd"
## Signals out of and into C++.

var heard: Array = []


func test_many_arguments() -> void:
	var probe: Probe = Probe.new()
	probe.many.connect(func(a: int, b: float, c: String) -> void: heard.append([a, b, c]))
	equal(probe.emit_many(), OK, "emit_signal answers OK")
	equal(heard, [[7, 2.5, "text"]], "arguments")
	probe.free()


func test_enum_property_signal() -> void:
	var probe: Probe = Probe.new()
	probe.mode_changed.connect(func(mode: int) -> void: heard.append(mode))
	probe.mode = Probe.MODE_FAULT
	probe.mode = Probe.MODE_FAULT
	equal(heard, [5], "once for one change")
	probe.free()


func test_callable_mp() -> void:
	var probe: Probe = Probe.new()
	equal(probe.connect_own(true), 1, "connected, and found again by an equal Callable")
	probe.emit_many()
	equal(probe.get_heard(), 7 + 5 + 4, "called with its arguments")
	equal(probe.connect_own(false), 0, "disconnected by an equal Callable")
	probe.emit_many()
	equal(probe.get_heard(), 16, "silent now")
	probe.free()


func test_callable_checks_its_arguments() -> void:
	var probe: Probe = Probe.new()
	probe.connect_own(true)
	var callable: Callable = probe.get_signal_connection_list("many")[0]["callable"]
	equal(callable.get_argument_count(), 3, "argument count")
	callable.callv([1, 2.0, "abc"])
	equal(probe.get_heard(), 1 + 4 + 3, "called")
	callable.callv([1])
	equal(probe.get_heard(), 8, "too few arguments: not called")
	callable.callv(["no number", 2.0, "abc"])
	equal(probe.get_heard(), 8, "wrong type: not called")
	probe.free()
	check(not callable.is_valid() or callable.get_object() == null, "its object is gone")
	callable.callv([1, 2.0, "abc"])
	check(true, "calling it then does not crash")


func test_resource_changed() -> void:
	var config: ProbeConfig = ProbeConfig.new()
	config.changed.connect(func() -> void: heard.append("changed"))
	config.rate_hz = 20.0
	equal(heard, ["changed"], "emit_changed")
