extends "res://test_case.gd"
## Misuse that the in-tree binding answers with a message (run_binding_tests.py counts them) and a usable state, where
## godot-cpp converts or crashes; and what only the editor would ask.


func test_missing_engine_method() -> void:
	var faults: ProbeFaults = ProbeFaults.new()
	for i: int in 3:
		equal(faults.call_missing_method(), 0, "default values instead of a crash")


func test_changed_virtual_method() -> void:
	var faults: ProbeFaults = ProbeFaults.new()
	equal(faults.ask_changed_virtual(), 0, "not called, and the others stay")


func test_object_made_on_the_stack() -> void:
	var faults: ProbeFaults = ProbeFaults.new()
	equal(faults.use_stack_object(), 0, "stays usable, engine calls answer defaults")


func test_wrong_arguments() -> void:
	var probe: Probe = Probe.new()
	check(probe.callv("sum", []) == null, "too few arguments")
	check(probe.callv("sum", [1, 2, 3, 4]) == null, "too many arguments")
	check(probe.callv("sum", ["text"]) == null, "wrong type")
	check(probe.callv("call_count_of", [RefCounted.new()]) == null, "object of another class")
	check(probe.callv("call_count_of", [probe]) == null, "object that is not counted")
	equal(probe.callv("sum", [1]), 111.0, "usable afterwards")
	probe.free()


func test_wrong_resource_in_property() -> void:
	var probe: Probe = Probe.new()
	probe.config = ProbeConfig.new()
	probe.set("config", Resource.new())
	check(probe.config is ProbeConfig, "a resource of another class changes nothing")
	probe.free()


func test_freed_object_in_variant() -> void:
	var probe: Probe = Probe.new()
	var gone: Node = Node.new()
	var held: Array = [gone]
	gone.free()
	check(probe.callv("is_probe", held) != true, "a freed object is no Probe")
	probe.free()


func test_configuration_warnings() -> void:
	var probe: Probe = Probe.new()
	var faults: ProbeFaults = ProbeFaults.new()
	equal(faults.warnings_of(probe),
			PackedStringArray(["No config: add a ProbeConfig."]), "without")
	probe.config = ProbeConfig.new()
	equal(faults.warnings_of(probe), PackedStringArray(), "with")
	probe.free()
