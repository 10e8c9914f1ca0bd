## Prints one line of JSON: the properties of the classes and the project settings that settings_page.py describes.
## godot --headless --path PROJECT -s dump_settings.gd
extends SceneTree

const CLASSES: PackedStringArray = ["SpidarGConfig", "SpidarGHand"]
const PREFIX: String = "spidar_g/"
const MARK: String = "SETTINGS "


func _initialize() -> void:
	var dump: Dictionary = {"project": _project_settings()}
	for class_title: String in CLASSES:
		dump[class_title] = _properties(class_title)
	print(MARK, JSON.stringify(dump, "", false))
	quit(0)


## In the order of the inspector; a group is an entry of its own.
func _properties(class_title: String) -> Array[Dictionary]:
	var found: Array[Dictionary] = []
	for property: Dictionary in ClassDB.class_get_property_list(class_title, true):
		if property["usage"] & PROPERTY_USAGE_GROUP:
			found.append({"group": property["name"]})
		elif property["usage"] & PROPERTY_USAGE_EDITOR:
			var standard: Variant = ClassDB.class_get_property_default_value(class_title, property["name"])
			found.append(_entry(property, standard))
	return found


func _project_settings() -> Array[Dictionary]:
	var found: Array[Dictionary] = []
	for property: Dictionary in ProjectSettings.get_property_list():
		var title: String = property["name"]
		if title.begins_with(PREFIX):
			found.append(_entry(property, ProjectSettings.property_get_revert(title)))
	return found


func _entry(property: Dictionary, standard: Variant) -> Dictionary:
	return {
		"name": property["name"],
		"type": type_string(property["type"]),
		"hint": property["hint"],
		"hint_string": property["hint_string"],
		"default": standard if typeof(standard) in [TYPE_BOOL, TYPE_INT, TYPE_FLOAT, TYPE_STRING] else var_to_str(standard),
	}
