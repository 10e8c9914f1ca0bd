@tool
extends RefCounted
## What the 3-D view shows of a selected SpidarG, kept by the editor for each project.

signal changed

## Where the map of wrench closure lies: through the probe.
enum Map { NONE, XY, YZ, XZ }

const SECTION: String = "spidar_g"
const KEY: String = "view"

var map: Map = Map.XY:
	set(value):
		map = value
		changed.emit()
var capacity: bool = true:
	set(value):
		capacity = value
		changed.emit()
var numbers: bool = true:
	set(value):
		numbers = value
		changed.emit()
var box: bool = true:
	set(value):
		box = value
		changed.emit()


func load_from(settings: EditorSettings) -> void:
	var kept: Dictionary = settings.get_project_metadata(SECTION, KEY, {})
	map = clampi(kept.get("map", Map.XY), Map.NONE, Map.XZ) as Map
	capacity = kept.get("capacity", true)
	numbers = kept.get("numbers", true)
	box = kept.get("box", true)


func save_to(settings: EditorSettings) -> void:
	settings.set_project_metadata(
		SECTION, KEY, {"map": map, "capacity": capacity, "numbers": numbers, "box": box}
	)
