extends "res://test_case.gd"
## _notification, _set, _get, _validate_property, _to_string and the engine's virtual methods.


func test_order_of_life() -> void:
	var probe: Probe = Probe.new()
	equal(probe.get_log(), PackedStringArray(["postinitialize"]), "made")
	tree.root.add_child(probe)
	equal(probe.get_log(), PackedStringArray(["postinitialize", "enter", "ready", "notified ready"]),
			"entered")
	tree.root.remove_child(probe)
	check(probe.get_log().has("exit"), "left")
	probe.free()


func test_two_levels() -> void:
	var derived: DerivedProbe = DerivedProbe.new()
	tree.root.add_child(derived)
	var log: PackedStringArray = derived.get_log()
	equal(log.slice(0, 3), PackedStringArray(["postinitialize", "enter", "derived enter"]),
			"parent's hook first")
	for frame: int in 3:
		await tree.physics_frame
	check(derived.get_ticks() >= 2, "_physics_process of the second level: %d" % derived.get_ticks())
	tree.root.remove_child(derived)
	log = derived.get_log()
	equal(log.slice(-2), PackedStringArray(["derived exit", "exit"]),
			"reversed: the child's hook first")
	derived.free()


func test_dynamic_property() -> void:
	var probe: Probe = Probe.new()
	equal(probe.get("hidden_value"), 7, "_get")
	probe.set("hidden_value", 9)
	equal(probe.get("hidden_value"), 9, "_set")
	check(probe.get("no_such_value") == null, "others are refused")
	var derived: DerivedProbe = DerivedProbe.new()
	derived.set("hidden_value", 11)
	equal(derived.get("hidden_value"), 11, "inherited hook")
	probe.free()
	derived.free()


func test_validate_property() -> void:
	var probe: Probe = Probe.new()
	var seen: bool = false
	for property: Dictionary in probe.get_property_list():
		if property["name"] == "gain":
			seen = true
			equal(property["usage"], PROPERTY_USAGE_NO_EDITOR, "usage")
			equal(property["hint_string"], "0,2,0.5", "hint string")
		elif property["name"] == "mode":
			equal(property["hint_string"], "Idle:0,Active:4,Fault:5", "others stay")
	check(seen, "gain is listed")
	probe.free()


func test_to_string() -> void:
	var probe: Probe = Probe.new()
	probe.mode = Probe.MODE_ACTIVE
	equal(str(probe), "<Probe mode 4>", "_to_string")
	var config: ProbeConfig = ProbeConfig.new()
	check(str(config).contains("ProbeConfig"), "the engine's own where there is none: " + str(config))
	probe.free()


func test_script_on_top() -> void:
	var script: GDScript = GDScript.new()
	script.source_code = """extends Probe
func _get_configuration_warnings() -> PackedStringArray:
	return PackedStringArray(["from script"])
"""
	equal(script.reload(), OK, "script compiles")
	var probe: Probe = script.new()
	equal(probe._get_configuration_warnings(), PackedStringArray(["from script"]), "override")
	equal(probe.sum(1.0), 111.0, "the base stays")
	probe.free()
