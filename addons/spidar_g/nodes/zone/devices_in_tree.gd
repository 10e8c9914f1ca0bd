extends RefCounted
## Lists all [SpidarG] and [SpidarGHand] nodes of a scene tree. All nodes that need the list share one watcher. The watcher
## exists as long as one of them refers to it, so a tree without such nodes is not watched.

## Emitted when a device or a hand has entered or left the scene tree.
signal changed

static var _shared: WeakRef = null

var devices: Array[SpidarG] = []
var hands: Array[SpidarGHand] = []

var _tree: SceneTree = null


## Returns the watcher of `tree`, and creates it if there is none.
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
	for node: Node in tree.root.find_children("*", "SpidarGHand", true, false):
		hands.append(node as SpidarGHand)
	tree.node_added.connect(_on_added)
	tree.node_removed.connect(_on_removed)


func _on_added(node: Node) -> void:
	if node is SpidarG and not devices.has(node):
		devices.append(node as SpidarG)
		changed.emit()
	elif node is SpidarGHand and not hands.has(node):
		hands.append(node as SpidarGHand)
		changed.emit()


func _on_removed(node: Node) -> void:
	if node is SpidarG:
		devices.erase(node)
		changed.emit()
	elif node is SpidarGHand:
		hands.erase(node)
		changed.emit()
