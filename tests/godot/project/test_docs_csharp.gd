## docs/how_to/use_from_csharp.md: what the page calls by name exists in the loaded library, with arguments that fit. No C#
## is run.
extends "res://docs_case.gd"

const PAGE: String = "use_from_csharp.md"


func test_names_on_the_page_exist() -> void:
	var text: String = FileAccess.get_file_as_string(ProjectSettings.globalize_path("res://") + FOLDER + PAGE)
	check(text.contains("```csharp"), "the page has a listing")
	for found: RegExMatch in _all("ClassExists\\(\"(\\w+)\"|Instantiate\\(\"(\\w+)\"", text):
		var name: String = found.get_string(1) + found.get_string(2)
		check(ClassDB.class_exists(name), "class %s" % name)
	var signals: Array = ClassDB.class_get_signal_list("SpidarG").map(func(each: Dictionary) -> String: return each["name"])
	for found: RegExMatch in _all("Connect\\(\"(\\w+)\"", text):
		check(signals.has(found.get_string(1)), "signal %s" % found.get_string(1))
	var properties: Array = ClassDB.class_get_property_list("SpidarG").map(func(each: Dictionary) -> String: return each["name"])
	for found: RegExMatch in _all("\\.Set\\(\"(\\w+)\"", text):
		check(properties.has(found.get_string(1)), "property %s" % found.get_string(1))
	for found: RegExMatch in _all("ClassGetIntegerConstant\\(\"(\\w+)\", \"(\\w+)\"\\)", text):
		check(ClassDB.class_has_integer_constant(found.get_string(1), found.get_string(2)), "constant %s" % found.get_string(2))
	for path: RegExMatch in _all("\"(res://[^\"]+)\"", text):
		check(ResourceLoader.exists(path.get_string(1)), "script %s" % path.get_string(1))


## The calls of the listing, with arguments of the types that C# hands over.
func test_calls_on_the_page_are_accepted() -> void:
	var text: String = FileAccess.get_file_as_string(ProjectSettings.globalize_path("res://") + FOLDER + PAGE)
	device = ideal_device()
	device.request_rejected.connect(func(message: String) -> void: check(false, message))
	add(device)
	await physics_frames(2)
	var calls: Dictionary[String, Array] = {
		"set_simulated_hand_target": [Transform3D.IDENTITY, 0.0],
		"request_wrench": [Vector3(0.0, 0.5, 0.0), Vector3.ZERO, 0.0],
		"set_contacts": [PackedFloat64Array([0, 1, 0, -0.01, 0, 0, 0, 350, 2, 0.3, 0, 1])],
		"get_grip_transform": [],
		"get_achieved_wrench": [],
	}
	for found: RegExMatch in _all("\\.Call\\(\"(\\w+)\"", text):
		check(calls.has(found.get_string(1)), "%s is tried here" % found.get_string(1))
	for method: String in calls:
		check(text.contains("\"%s\"" % method), "%s is on the page" % method)
		var answer: Variant = device.callv(method, calls[method])
		check(typeof(answer) != TYPE_BOOL or answer, "%s is accepted" % method)
	check(device.get_grip_transform() is Transform3D, "a Transform3D comes back")
	check(device.get_achieved_wrench() is PackedFloat64Array, "and a PackedFloat64Array")
	device.free()


func _all(pattern: String, text: String) -> Array[RegExMatch]:
	var found: Array[RegExMatch] = RegEx.create_from_string(pattern).search_all(text)
	check(not found.is_empty(), "the page has %s" % pattern)
	return found
