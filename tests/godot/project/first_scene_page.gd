## The ten steps of docs/start/first_scene.md, read from the page and done in a scene. Each step is a heading "## N. Title"
## with at most one table of nodes, types, properties and values, and at most one script, which the step's first node gets.
extends RefCounted

const PAGE: String = "../../../docs/start/first_scene.md"

## By number, from 1: the title of each step.
var titles: Dictionary[int, String] = {}

var _rows: Dictionary[int, Array] = {}
var _scripts: Dictionary[int, String] = {}


## Reads the page. Returns whether it was found.
func read() -> bool:
	var page: FileAccess = FileAccess.open(ProjectSettings.globalize_path("res://") + PAGE, FileAccess.READ)
	if page == null:
		return false
	var heading: RegEx = RegEx.create_from_string("^## (\\d+)\\. (.+)$")
	var step: int = 0
	var is_script: bool = false
	while not page.eof_reached():
		var line: String = page.get_line()
		var found: RegExMatch = heading.search(line)
		if found != null:
			step = found.get_string(1).to_int()
			titles[step] = found.get_string(2)
			_rows[step] = []
		elif line.begins_with("## "):
			step = 0
		elif line.begins_with("```"):
			is_script = line == "```gdscript"
		elif is_script:
			_scripts[step] = _scripts.get(step, "") + line.replace("    ", "\t") + "\n"
		elif line.begins_with("|") and step > 0:
			_read_row(line, step)
	return true


## Does one step in the scene. Returns what could not be done, one text each.
func build(root: Node, step: int) -> PackedStringArray:
	var problems: PackedStringArray = []
	var node: Node = null
	for row: PackedStringArray in _rows[step]:
		node = node if row[0] == "" else _node(root, row[0], row[1])
		if node == null:
			problems.append("step %d: no node %s of type %s" % [step, row[0], row[1]])
		elif row[2] != "" and not _give(node, row[2].replace(".", ":"), row[3]):
			problems.append("step %d: %s has no %s = %s" % [step, node.name, row[2], row[3]])
	if _scripts.has(step):
		problems.append_array(_give_script(root, step))
	return problems


## The paths of the nodes that a step adds or changes, below the root.
func nodes_of(step: int) -> PackedStringArray:
	var paths: PackedStringArray = []
	for row: PackedStringArray in _rows[step]:
		if row[0] != "":
			paths.append(row[0])
	return paths


## A row of a table: the first code in each of its four cells, or an empty text.
func _read_row(line: String, step: int) -> void:
	var cells: PackedStringArray = []
	for cell: String in line.trim_prefix("|").trim_suffix("|").split("|"):
		cells.append(cell.get_slice("`", 1) if cell.contains("`") else "")
	if cells.size() == 4 and "".join(cells) != "":
		(_rows[step] as Array).append(cells)


## The node at a path below the root; it is made if it is not there.
func _node(root: Node, path: String, type: String) -> Node:
	if root.has_node(path):
		return root.get_node(path)
	var parent: Node = root.get_node_or_null(path.get_base_dir()) if path.contains("/") else root
	var node: Node = _made(type) as Node
	if node != null and parent != null:
		node.name = path.get_file()
		parent.add_child(node)
		node.owner = root
	return node


## An object of a class of the engine, of the library or of a script with a class_name; null if there is none.
func _made(type: String) -> Object:
	if ClassDB.class_exists(type):
		return ClassDB.instantiate(type)
	for known: Dictionary in ProjectSettings.get_global_class_list():
		if known["class"] == type:
			return (load(known["path"]) as GDScript).new()
	return null


## Gives a property, such as "mesh:size", a value or a new object of a class. Returns whether the node took it.
func _give(node: Node, property: String, text: String) -> bool:
	if not property.get_slice(":", 0) in node:
		return false
	var made: Object = _made(text)
	var value: Variant = _evaluated(text) if made == null else made
	node.set_indexed(property, value)
	var now: Variant = node.get_indexed(property)
	if value is Vector3 and now is Vector3: # single precision: rotation_degrees
		return (value as Vector3).is_equal_approx(now as Vector3)
	if value is float and now is float:
		return is_equal_approx(value as float, now as float)
	return now == value


func _evaluated(text: String) -> Variant:
	var expression := Expression.new()
	return expression.execute() if expression.parse(text) == OK else null


func _give_script(root: Node, step: int) -> PackedStringArray:
	var script := GDScript.new()
	script.source_code = _scripts[step]
	if script.reload() != OK:
		return ["step %d: the script does not compile" % step]
	root.get_node(nodes_of(step)[0]).set_script(script)
	return []
