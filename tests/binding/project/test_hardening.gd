extends "res://test_case.gd"
## Values that are refused, and many lives: with every binding.


func test_rejected_value() -> void:
	var config: ProbeConfig = ProbeConfig.new()
	for bad: float in [0.0, -1.0, NAN]:
		config.rate_hz = bad
		equal(config.rate_hz, 1000.0, "%s Hz is refused" % bad)


func test_index_check() -> void:
	var probe: Probe = Probe.new()
	equal(probe.check_index(7), 7, "last")
	equal(probe.check_index(8), -1, "beyond")
	equal(probe.check_index(-1), -1, "below")
	probe.free()


func test_many_lives() -> void:
	var before: int = int(Performance.get_monitor(Performance.OBJECT_COUNT))
	for i: int in 200:
		var probe: Probe = DerivedProbe.new() if i % 2 == 0 else Probe.new()
		probe.config = ProbeConfig.new()
		probe.make_child("child")
		tree.root.add_child(probe)
		probe.connect_own(true)
		if i % 3 == 0:
			probe.reparent(tree.root.get_child(0) if tree.root.get_child_count() > 1 else tree.root)
		probe.free()
	equal(int(Performance.get_monitor(Performance.OBJECT_COUNT)), before, "objects left")
