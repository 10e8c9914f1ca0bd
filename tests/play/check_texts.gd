extends "check_case.gd"
## All English of the demo is in text/en.po: each key that scripts and scenes name is there, none is there for nothing, and
## with every text of the file marked, no unmarked text is on any screen.

const ExperimentScreen := preload("res://study/experiment_screen.gd")

const FILE := "res://text/en.po"
## Words in capitals that are no keys of the translation.
const OTHER_WORDS: PackedStringArray = ["X", "Y", "Z"]
## Texts on the screen that are the same in all languages: numbers, units, names of keys.
const SAME_EVERYWHERE := "^[0-9:.,%\\s]*$"
const MARK := "«"


func _run() -> void:
	about = "texts"
	var messages := _messages()
	check(messages.size() > 100, "%s has %d texts" % [FILE, messages.size()])
	_check_keys(messages)
	_check_loaded(messages)
	await _check_screens(messages)


## By key: the English text.
func _messages() -> Dictionary[String, String]:
	var found: Dictionary[String, String] = {}
	var pair := RegEx.create_from_string("msgid \"(\\w+)\"\\nmsgstr \"(.*)\"")
	for entry in pair.search_all(FileAccess.get_file_as_string(FILE)):
		check(not found.has(entry.get_string(1)), entry.get_string(1) + " is there twice")
		check(entry.get_string(2) != "", entry.get_string(1) + " has no text")
		found[entry.get_string(1)] = entry.get_string(2).c_unescape()
	return found


func _check_keys(messages: Dictionary[String, String]) -> void:
	var used: Dictionary[String, String] = {}
	var key := RegEx.create_from_string("\"([A-Z][A-Z0-9]*(?:_[A-Z0-9]+)+|LEVEL)\"")
	for path in _sources("res://"):
		for found in key.search_all(FileAccess.get_file_as_string(path)):
			used[found.get_string(1)] = path
	for name in used:
		check(messages.has(name) or OTHER_WORDS.has(name), "%s names %s, which has no text" % [used[name], name])
	for name in messages:
		check(used.has(name), "%s is used nowhere" % name)
	for name in messages:
		_check_actions(name, messages[name])


## Every action in braces exists.
func _check_actions(name: String, text: String) -> void:
	for found in RegEx.create_from_string("\\{(\\w+)\\}").search_all(text):
		check(InputMap.has_action(found.get_string(1)), "%s: there is no action %s" % [name, found.get_string(1)])


## Scripts and scenes of the demo, without those of the add-on.
func _sources(folder: String) -> PackedStringArray:
	var paths := PackedStringArray()
	for name in DirAccess.get_files_at(folder):
		if name.get_extension() in ["gd", "tscn"]:
			paths.append(folder.path_join(name))
	for name in DirAccess.get_directories_at(folder):
		if name != "addons" and not name.begins_with("."):
			paths.append_array(_sources(folder.path_join(name)))
	return paths


func _check_loaded(messages: Dictionary[String, String]) -> void:
	for name in messages:
		check(tr(name) == messages[name], "%s is shown as %s" % [name, tr(name)])


func _check_screens(messages: Dictionary[String, String]) -> void:
	var marked := Translation.new()
	marked.locale = "eo"
	for name in messages:
		marked.add_message(name, MARK + messages[name])
	TranslationServer.add_translation(marked)
	TranslationServer.set_locale("eo")
	for name in SCENES:
		var task := open(name)
		await frames(8)
		_check_marked(task, name)
		task.get_node(^"Hud").call(&"toggle_help")
		for _frame in 100:
			task.get_node(^"Hud/%FrameRate").call(&"note_frame", 0.1)
		await frames(2)
		_check_marked(task, name)
		await close(task)
	var screen: ExperimentScreen = (load("res://study/experiment_screen.tscn") as PackedScene).instantiate()
	root.add_child(screen)
	screen.ask_ratings("forces_on", func(_answers: Dictionary) -> void: pass)
	await frames(2)
	_check_marked(screen, "questions")
	await close(screen)
	TranslationServer.set_locale("en")
	TranslationServer.remove_translation(marked)


func _check_marked(scene: Node, where: String) -> void:
	var plain := RegEx.create_from_string(SAME_EVERYWHERE)
	for control: Control in scene.find_children("*", "Control", true, false):
		var texts := PackedStringArray()
		if control is OptionButton:
			for item in (control as OptionButton).item_count:
				texts.append(control.atr((control as OptionButton).get_item_text(item)))
		elif control is Label or control is Button:
			texts.append(control.atr(str(control.get(&"text"))))
		elif control is TabContainer:
			for tab in (control as TabContainer).get_tab_count():
				texts.append(control.atr((control as TabContainer).get_tab_title(tab)))
		for text in texts:
			var is_key := control.get_parent().name == &"Grid"
			check(text.contains(MARK) or is_key or plain.search(text) != null, "%s: %s shows %s" % [where, control.name, text])
