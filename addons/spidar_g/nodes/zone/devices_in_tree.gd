extends RefCounted
## All [SpidarG] nodes of a scene tree, kept by one watcher for all nodes that want to know them. It lives as long as one of
## them holds it, so a tree without such nodes is not watched.

signal changed

static var _shared: WeakRef = null

var devices: Array[SpidarG] = []

var _tree: SceneTree = null


## Returns the watcher of `tree`.
static func of(tree: SceneTree) -> RefCounted:
	var watcher: RefCounted = _shared.get_ref() if _shared != null else null
	if watcher == null or watcher.get("_tree") != tree:
		watcher = new(tree)
		_shared = weakref(watcher)
	return watcher


func _init(tree: SceneTree) -> void:
	_tree = tree
	for node: Node in tree.root.find_children("*", "SpidarG", true, false):
		devices.append(node as SpidarG)
	tree.node_added.connect(_on_added)
	tree.node_removed.connect(_on_removed)


func _on_added(node: Node) -> void:
	if node is SpidarG and not devices.has(node):
		devices.append(node as SpidarG)
		changed.emit()


func _on_removed(node: Node) -> void:
	if node is SpidarG:
		devices.erase(node)
		changed.emit()
