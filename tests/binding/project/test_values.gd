extends "res://test_case.gd"
## Values of every type through bound methods, both by typed (pointer) and untyped (Variant) calls.


func test_numbers_and_defaults() -> void:
	var probe: Probe = Probe.new()
	equal(probe.sum(1.0), 111.0, "both defaults")
	equal(probe.sum(1.0, 2.0), 103.0, "one default")
	equal(probe.sum(1.0, 2.0, 3), 6.0, "no default")
	var untyped: Variant = probe
	equal(untyped.sum(1.0), 111.0, "both defaults, untyped call")
	equal(untyped.call("sum", 1, 2, 3), 6.0, "integers as floats")
	equal(probe.flip(true), false, "true")
	equal(probe.flip(false), true, "false")
	equal(probe.small(-2147483648), -2147483648, "int32 minimum")
	equal(probe.byte(255), 255, "uint8 maximum")
	probe.free()


func test_echo_keeps_type_and_value() -> void:
	var probe: Probe = Probe.new()
	var values: Array = [null, true, -5, 2.5, "text", &"name", Vector3(1, 2, 3),
			Quaternion(0, 0, 1, 0), Basis.IDENTITY, Transform3D.IDENTITY, Color.RED, ^"a/b",
			{"k": 1}, [1, "2"], PackedFloat64Array([1.5]), PackedStringArray(["a"]), Rect2(1, 2, 3, 4)]
	for value: Variant in values:
		equal(probe.echo(value), value, "echo of " + type_string(typeof(value)))
	probe.free()


func test_strings() -> void:
	var probe: Probe = Probe.new()
	equal(probe.describe("länge", &"N·m"), "länge [N·m]", "text beyond ASCII passes through")
	equal(Probe.version_text(4), "4.0", "static method, default")
	equal(Probe.version_text(4, 6), "4.6", "static method")
	var facts: Dictionary = probe.text_facts()
	equal(facts["utf8"], "5°", "String::utf8")
	equal(facts["utf8_length"], 2, "characters, not bytes")
	equal(facts["bytes"], "5°", "to UTF-8 and back")
	equal(facts["equal"], true, "comparisons")
	equal(facts["number"], "2.5", "String::num")
	equal(facts["from_int"], "5", "String of an integer Variant")
	equal(facts["to_int"], 2, "integer of a real Variant")
	equal(facts["type"], "Vector3", "type name")
	equal(facts["split"], PackedStringArray(["a", "b", "c"]), "split")
	equal(facts["approx"], true, "UtilityFunctions::is_equal_approx")
	probe.free()


func test_dictionary_of_twelve() -> void:
	var probe: Probe = Probe.new()
	var config: ProbeConfig = ProbeConfig.new()
	probe.config = config
	var got: Dictionary = probe.statistics()
	equal(got.size(), 12, "keys")
	equal(got["count"], 12, "int")
	equal(got["rate_hz"], 1000.25, "float")
	equal(got["ok"], true, "bool")
	equal(got["name"], "probe", "text")
	equal(got["mode"], Probe.MODE_IDLE, "enum")
	equal(got["where"], Vector3(1, 2, 3), "vector")
	equal(got["values"], PackedFloat64Array(), "packed array")
	equal(got["list"], [1, "two", 3.5], "array")
	check(got["self"] == probe, "object")
	check(got["config"] == config, "Ref")
	equal(got["nested"], {}, "dictionary")
	check(got.has("nothing") and got["nothing"] == null, "null")
	probe.free()


func test_arrays() -> void:
	var probe: Probe = Probe.new()
	equal(probe.list(0), [], "empty")
	equal(probe.list(4), [0, "item has 1", 4, 9], "element written through operator[]")
	var source: PackedFloat64Array = PackedFloat64Array([1.0, -2.5, 1e300])
	equal(probe.doubled(source), PackedFloat64Array([2.0, -5.0, 2e300]), "doubled")
	equal(source, PackedFloat64Array([1.0, -2.5, 1e300]), "the argument is not written to")
	equal(probe.doubled(PackedFloat64Array()), PackedFloat64Array(), "empty packed array")
	equal(probe.mirrored(PackedVector3Array([Vector3(1, 2, 3), Vector3(-4, 5, 6)])),
			PackedVector3Array([Vector3(-1, -2, -3), Vector3(4, -5, -6)]), "vectors")
	equal(probe.counted(3), PackedInt32Array([0, 1, 2]), "int32 array")
	probe.free()


func test_transforms_agree_with_the_engine() -> void:
	var probe: Probe = Probe.new()
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 7
	for i: int in 200:
		var q: Quaternion = _random_quaternion(random)
		var basis: Basis = Basis(q)
		if i % 3 == 1:
			basis = basis.scaled(Vector3(random.randf_range(0.5, 2), 1.5, 0.75))
		elif i % 3 == 2:
			basis = basis.scaled(Vector3(-1, 1, 1))
		var facts: Dictionary = probe.rotation_facts(basis)
		var transform: Transform3D = Transform3D(basis, Vector3(1, 2, 3))
		near(facts["quaternion"], basis.get_rotation_quaternion(), "rotation quaternion")
		near(facts["from_quaternion"], Basis(basis.get_rotation_quaternion()), "of quaternion")
		near(facts["transposed"], basis.transposed(), "transposed")
		near(facts["inverse"], basis.inverse(), "inverse")
		near(facts["orthonormalized"], basis.orthonormalized(), "orthonormalized")
		near(facts["determinant"], basis.determinant(), "determinant")
		near(facts["affine_inverse"], transform.affine_inverse(), "affine inverse")
		near(facts["inverse_transform"], transform.inverse(), "inverse of a rotation")
		near(facts["xform"], transform * Vector3(4, 5, 6), "xform")
		near(facts["column"], basis.y, "column")
		near(facts["scale"], basis.get_scale(), "scale")
		var other: Transform3D = Transform3D(Basis(_random_quaternion(random)), Vector3(-1, 0, 5))
		near(probe.product(transform, other), transform * other, "product")
		var axis: Vector3 = Vector3(random.randfn(), random.randfn(), random.randfn()).normalized()
		near(probe.turned(q, axis, 0.7), Quaternion(axis, 0.7) * q, "Hamilton product")
	probe.free()


func test_half_turns() -> void:
	# The branches of get_quaternion where the trace is not positive.
	var probe: Probe = Probe.new()
	for axis: Vector3 in [Vector3.RIGHT, Vector3.UP, Vector3.BACK, Vector3(1, 1, 0).normalized()]:
		var basis: Basis = Basis(axis, PI)
		near(probe.rotation_facts(basis)["quaternion"], basis.get_rotation_quaternion(), str(axis))
	probe.free()


func _random_quaternion(random: RandomNumberGenerator) -> Quaternion:
	return Quaternion(random.randfn(), random.randfn(), random.randfn(),
			random.randfn()).normalized()
