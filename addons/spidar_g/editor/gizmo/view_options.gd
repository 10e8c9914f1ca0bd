@tool
extends RefCounted
## Stores the options that select what the 3D view shows of a selected SpidarG. The editor saves them for each project.

## Emitted when one of the options has changed.
signal changed

## Selects the plane of the map of wrench closure. The plane contains the probe.
enum Map { NONE, XY, YZ, XZ }

const SECTION: String = "spidar_g"
const KEY: String = "view"

## Selects the plane in which the map of wrench closure is drawn.
var map: Map = Map.XY:
	set(value):
		map = value
		changed.emit()
## If [code]true[/code], the force capacity at the probe is drawn.
var capacity: bool = true:
	set(value):
		capacity = value
		changed.emit()
## If [code]true[/code], the numbers of the strings are drawn at the corners, from 1 to 8.
var numbers: bool = true:
	set(value):
		numbers = value
		changed.emit()
## If [code]true[/code], the box is drawn in which the grip's center meets no soft wall.
var box: bool = true:
	set(value):
		box = value
		changed.emit()


## Reads the options from the metadata of the project.
func load_from(settings: EditorSettings) -> void:
	var kept: Dictionary = settings.get_project_metadata(SECTION, KEY, {})
	map = clampi(kept.get("map", Map.XY), Map.NONE, Map.XZ) as Map
	capacity = kept.get("capacity", true)
	numbers = kept.get("numbers", true)
	box = kept.get("box", true)


## Writes the options to the metadata of the project.
func save_to(settings: EditorSettings) -> void:
	settings.set_project_metadata(
		SECTION, KEY, {"map": map, "capacity": capacity, "numbers": numbers, "box": box}
	)
