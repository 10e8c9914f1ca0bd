extends RefCounted
## Where in the scene a hand acts: under a SpidarG, as the first hand there. Elsewhere it says why it does not.

const NO_DEVICE: String = "SpidarGHand does nothing here: make it a child of a SpidarG node."
const SECOND_HAND: String = "A SPIDAR-G has one grip: of several SpidarGHand under one SpidarG only the first acts."
const ENGINE: String = (
	"Thin bodies slip through floors in this physics engine: set physics/3d/physics_engine to "
	+ "Jolt Physics (Project > Tools > SPIDAR-G: Apply Physics Settings)."
)
const THREAD: String = (
	"SpidarGHand does nothing in a thread group of its own, for only the main thread may look into the physics space: "
	+ "set process_thread_group of the hand and of its parents to Inherit or Main Thread."
)

var _told: bool = false


## For the editor.
static func warnings(hand: Node) -> PackedStringArray:
	var found: PackedStringArray = []
	if not hand.get_parent() is SpidarG:
		found.append(NO_DEVICE)
	elif not is_first(hand):
		found.append(SECOND_HAND)
	if str(ProjectSettings.get_setting("physics/3d/physics_engine", "")) != "Jolt Physics":
		found.append(ENGINE)
	return found


## True for the first of the hands under one device.
static func is_first(hand: Node) -> bool:
	for child: Node in hand.get_parent().get_children():
		if child.get_script() == hand.get_script():
			return child == hand
	return true


## In a running scene: under a new parent.
func entered(hand: Node) -> void:
	_told = false
	if not hand.get_parent() is SpidarG and not Engine.is_editor_hint():
		push_warning("SpidarGHand \"%s\": %s" % [hand.name, NO_DEVICE])


## Each physics frame under a device. What keeps a hand from acting is told once.
func may_act(hand: Node) -> bool:
	var problem: String = "" if is_first(hand) else SECOND_HAND
	if OS.get_thread_caller_id() != OS.get_main_thread_id():
		problem = THREAD
	if not problem.is_empty() and not _told:
		push_warning("SpidarGHand \"%s\": %s" % [hand.name, problem])
	_told = not problem.is_empty()
	return not _told
