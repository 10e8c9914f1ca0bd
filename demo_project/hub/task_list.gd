extends RefCounted
## The one list of what the menu and the command line can open. A scene says for itself what it is called and what there is to
## do in it. This list holds paths alone, so that it can be read where the add-on's library is missing.

## Timed and judged; a script can play them, and the experiment is made of them.
const TASKS: Dictionary[String, String] = {
	"pick_and_place": "res://tasks/pick_and_place/pick_and_place.tscn",
	"robot_linking": "res://tasks/robot_linking/robot_linking.tscn",
	"match_linking": "res://tasks/match_linking/match_linking.tscn",
}
const OTHERS: Dictionary[String, String] = {
	"hub": "res://hub/hub.tscn",
	"free_play": "res://tasks/free_play/free_play.tscn",
	"guided_start": "res://hub/guided_start.tscn",
	"experiment": "res://study/experiment.tscn",
}
## Tasks whose things can be carried about instead of being placed (--carries): elsewhere they link on the way.
const CARRYING: PackedStringArray = ["pick_and_place"]


static func task_names() -> PackedStringArray:
	return PackedStringArray(TASKS.keys())


static func make(scene_name: String) -> Node:
	var scene: PackedScene = load(TASKS.get(scene_name, OTHERS.get(scene_name, "")))
	return scene.instantiate()
