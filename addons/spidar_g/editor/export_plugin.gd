@tool
extends EditorExportPlugin
## Puts the stand-in classes of addons/spidar_g/stand_in into an export for a system that the add-on has no library for, so
## that scripts that name SpidarG load there. An export for a system with a library does not get the stand-ins, because they
## would hide the classes of the library.
##
## Godot finds the script of a class in a list in the project's cache, and copies this list into the export at its end. During
## the export, the list therefore contains the stand-in classes too.

const STAND_INS: String = "res://addons/spidar_g/stand_in"
const MANIFEST: String = "res://addons/spidar_g/spidar_g.gdextension"
const LIST_FILE: String = "global_script_class_cache.cfg"
const LIST_KEY: String = "list"

var _list_path: String = ""
var _list_before: PackedByteArray = []


func _get_name() -> String:
	return "spidar_g"


func _export_begin(features: PackedStringArray, _is_debug: bool, _path: String, _flags: int) -> void:
	_list_path = ""
	if _has_library(features):
		return
	var hidden: bool = ProjectSettings.get_setting("application/config/use_hidden_project_data_directory", true)
	_list_path = "res://%s/%s" % [".godot" if hidden else "godot", LIST_FILE]
	_list_before = FileAccess.get_file_as_bytes(_list_path)
	var list: ConfigFile = ConfigFile.new()
	list.load(_list_path) # A project without classes has none yet.
	var classes: Array = list.get_value("", LIST_KEY, [])
	for file: String in DirAccess.get_files_at(STAND_INS):
		if file.get_extension() == "gd":
			var path: String = STAND_INS.path_join(file)
			add_file(path, FileAccess.get_file_as_bytes(path), false)
			classes.append(_entry(path))
	list.set_value("", LIST_KEY, classes)
	if list.save(_list_path) != OK:
		push_error("SPIDAR-G: %s cannot be written, so this export has no stand-ins for a missing library." % _list_path)


func _export_end() -> void:
	if _list_path == "":
		return
	if _list_before.is_empty():
		DirAccess.remove_absolute(_list_path)
		return
	var file: FileAccess = FileAccess.open(_list_path, FileAccess.WRITE)
	if file != null:
		file.store_buffer(_list_before)


# Returns whether the manifest names a library for a system with these features, as "linux.debug.x86_64" does.
func _has_library(features: PackedStringArray) -> bool:
	var manifest: ConfigFile = ConfigFile.new()
	if manifest.load(MANIFEST) != OK:
		return false
	for tags: String in manifest.get_section_keys("libraries"):
		if Array(tags.split(".")).all(features.has):
			return true
	return false


# Returns the entry for a script in Godot's list of classes.
func _entry(path: String) -> Dictionary:
	var text: String = FileAccess.get_file_as_string(path)
	return {
		"base": StringName(_word_after(text, "\nextends ")),
		"class": StringName(_word_after(text, "\nclass_name ")),
		"icon": "",
		"is_abstract": false,
		"is_tool": false,
		"language": &"GDScript",
		"path": path,
	}


func _word_after(text: String, beginning: String) -> String:
	return text.get_slice(beginning, 1).get_slice("\n", 0)
