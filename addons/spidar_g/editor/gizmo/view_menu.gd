@tool
extends MenuButton
## This is the menu in the toolbar of the 3D view that selects what the gizmo of a selected SpidarG shows. The menu is visible
## while a SpidarG is selected.

const ViewOptions := preload("view_options.gd")

enum Item { MAP_NONE, MAP_XY, MAP_YZ, MAP_XZ, CAPACITY, NUMBERS, BOX }

const LABELS: Dictionary[Item, String] = {
	Item.MAP_NONE: "No closure map",
	Item.MAP_XY: "Closure map in x and y",
	Item.MAP_YZ: "Closure map in y and z",
	Item.MAP_XZ: "Closure map in x and z",
	Item.CAPACITY: "Force capacity at the probe",
	Item.NUMBERS: "Corner numbers",
	Item.BOX: "Workspace box",
}
const TIPS: Dictionary[Item, String] = {
	Item.MAP_NONE: "Draws no map of the wrench closure.",
	Item.MAP_XY: "Shows where the strings can hold the grip, in the plane through the probe: green is good, yellow is weak, red is impossible.",
	Item.CAPACITY: "Shows how large a force the strings can give in every direction at the probe, without a moment. 6 mm are 1 N.",
	Item.NUMBERS: "Shows the numbers of the strings, 1 to 8 as in the paper. Scripts use the indices 0 to 7.",
	Item.BOX: "Shows the box in which the center of the grip meets no soft wall.",
}

var options: ViewOptions


func _ready() -> void:
	text = "SPIDAR-G"
	tooltip_text = "Selects what is drawn of the selected SpidarG."
	flat = true
	var menu: PopupMenu = get_popup()
	menu.hide_on_checkable_item_selection = false
	for item: Item in LABELS:
		if item <= Item.MAP_XZ:
			menu.add_radio_check_item(LABELS[item], item)
		else:
			menu.add_check_item(LABELS[item], item)
		menu.set_item_tooltip(menu.get_item_index(item), TIPS.get(item, TIPS[Item.MAP_XY]))
	menu.id_pressed.connect(choose)
	options.changed.connect(_show_options)
	EditorInterface.get_selection().selection_changed.connect(_follow_selection)
	_show_options()
	_follow_selection()


## Applies a menu item to the options, and saves them.
func choose(item: Item) -> void:
	match item:
		Item.CAPACITY:
			options.capacity = not options.capacity
		Item.NUMBERS:
			options.numbers = not options.numbers
		Item.BOX:
			options.box = not options.box
		_:
			options.map = item as int as ViewOptions.Map
	options.save_to(EditorInterface.get_editor_settings())


func _show_options() -> void:
	var menu: PopupMenu = get_popup()
	for item: Item in LABELS:
		var on: bool = item as int == options.map
		match item:
			Item.CAPACITY:
				on = options.capacity
			Item.NUMBERS:
				on = options.numbers
			Item.BOX:
				on = options.box
		menu.set_item_checked(menu.get_item_index(item), on)


func _follow_selection() -> void:
	visible = EditorInterface.get_selection().get_selected_nodes().any(
		func(node: Node) -> bool: return node is SpidarG
	)
