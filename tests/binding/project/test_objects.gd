extends "res://test_case.gd"
## Objects across the border: identity, dynamic type, counted references, resources, engine calls.


func test_identity_and_cast() -> void:
	var probe: Probe = Probe.new()
	var plain: Node = Node.new()
	var derived: DerivedProbe = DerivedProbe.new()
	check(probe.same(probe) == probe, "own object returns as itself")
	check(probe.same(plain) == plain, "engine object returns as itself")
	check(probe.same(null) == null, "null")
	equal(probe.is_probe(probe), true, "Probe is a Probe")
	equal(probe.is_probe(derived), true, "DerivedProbe is a Probe")
	equal(probe.is_probe(plain), false, "Node is none")
	equal(probe.is_probe(null), false, "null is none")
	probe.free()
	plain.free()
	derived.free()


func test_engine_children() -> void:
	var probe: Probe = Probe.new()
	check(probe.first_child() == null, "no child")
	probe.make_child("made")
	equal(probe.get_child_count(), 1, "children")
	var child: Node = probe.first_child()
	check(child is Node3D, "memnew(Node3D) is a Node3D")
	equal(child.name, &"made", "set_name")
	equal((child as Node3D).position, Vector3(0, 1, 0), "set_position")
	probe.free()
	check(not is_instance_valid(child), "freed with its parent")


func test_constructor_used_the_engine() -> void:
	var probe: Probe = Probe.new()
	equal(probe.process_priority, 3, "set_process_priority in the constructor")
	equal(probe.name, &"made by constructor", "set_name in the constructor")
	probe.free()


func test_counted_references() -> void:
	var before: int = ProbeCounter.get_alive()
	var probe: Probe = Probe.new()
	var counter: ProbeCounter = ProbeCounter.new()
	equal(counter.get_reference_count(), 1, "new")
	equal(probe.call_count_of(null), -1, "null Ref")
	equal(probe.call_count_of(counter), 2, "argument holds one more during the call")
	equal((probe as Variant).call_count_of(counter), 2, "the same by an untyped call")
	equal(counter.get_reference_count(), 1, "given back")
	equal(counter.add(), 1, "default argument")
	var made: ProbeCounter = ProbeCounter.make(5)
	equal(made.get_reference_count(), 1, "returned by a static method: one owner")
	equal(made.add(2), 7, "state kept")
	var other: ProbeCounter = probe.make_counter(1)
	equal(other.get_reference_count(), 1, "returned by a method: one owner")
	equal(ProbeCounter.get_alive(), before + 3, "alive")
	counter = null
	made = null
	other = null
	equal(ProbeCounter.get_alive(), before, "all ended")
	probe.free()


func test_resource_property() -> void:
	var probe: Probe = Probe.new()
	check(probe.config == null, "null by default")
	var config: ProbeConfig = ProbeConfig.new()
	config.rate_hz = 500.0
	config.lengths = PackedFloat64Array([0.1, 0.2])
	probe.config = config
	check(probe.config == config, "the same resource")
	equal(config.get_reference_count(), 2, "test and probe hold it")
	probe.free()
	equal(config.get_reference_count(), 1, "the probe let go")
	var copy: ProbeConfig = config.duplicate()
	probe = Probe.new()
	probe.config = config
	equal(probe.owners_of_duplicate(), 2, "a Ref that the engine returned: the two in C++ hold it")
	probe.free()
	equal(copy.rate_hz, 500.0, "duplicate keeps a property")
	equal(copy.lengths, PackedFloat64Array([0.1, 0.2]), "duplicate keeps an array")


func test_save_and_load() -> void:
	var config: ProbeConfig = ProbeConfig.new()
	config.rate_hz = 750.0
	equal(ResourceSaver.save(config, "user://probe_config.tres"), OK, "save")
	var loaded: ProbeConfig = ResourceLoader.load("user://probe_config.tres", "",
			ResourceLoader.CACHE_MODE_IGNORE)
	check(loaded != null and loaded != config, "another object")
	equal(loaded.rate_hz, 750.0, "value")


func test_engine_facts() -> void:
	var probe: Probe = Probe.new()
	var facts: Dictionary = probe.engine_facts()
	equal(facts["editor_hint"], Engine.is_editor_hint(), "is_editor_hint")
	equal(facts["ticks"], 60, "ticks")
	equal((facts["version"] as Dictionary)["hex"], Engine.get_version_info()["hex"], "version")
	equal(facts["os"], OS.get_name(), "OS name")
	equal(facts["debug"], OS.is_debug_build(), "debug build")
	equal(facts["project"], "Binding Probe", "project setting")
	equal(facts["has"], false, "missing setting")
	probe.free()


func test_class_hierarchy() -> void:
	equal(ClassDB.get_parent_class("DerivedProbe"), &"Probe", "parent of DerivedProbe")
	equal(ClassDB.get_parent_class("Probe"), &"Node3D", "parent of Probe")
	equal(ClassDB.get_parent_class("ProbeConfig"), &"Resource", "parent of ProbeConfig")
	equal(ClassDB.class_get_integer_constant("Probe", "kStrings"), 8, "constant")
	equal(ClassDB.class_get_enum_constants("Probe", "Mode", true),
			PackedStringArray(["MODE_IDLE", "MODE_ACTIVE", "MODE_FAULT"]), "enum")
	equal(ClassDB.class_get_integer_constant("Probe", "MODE_FAULT"), 5, "enum value")
	equal(ClassDB.class_get_property_default_value("Probe", "gain"), 0.5, "property default")
	var derived: DerivedProbe = DerivedProbe.new()
	equal(derived.sum(1.0, 1.0, 1), 3.0, "inherited method")
	derived.free()
