@tool
@icon("../icons/spidar_g_socket.svg")
class_name SpidarGSocket
extends Marker3D
## A snap point on a body: another body is drawn in, clicks into its seat, is held, and comes off when it is pulled hard
## enough. The hand feels all of it.
##
## Add a [SpidarGSocket] to each of two bodies as a direct child, set the same [member key] on both, and [member is_plug] on
## one of them. While a [SpidarGHand] holds one of the bodies, the sockets of this body look for sockets that fit. Two sockets
## that click together coincide: their origins do, and unless [member turns_freely] is set, their axes do too.
## [codeblock]
## # A peg that clicks into a hole.
## var peg := RigidBody3D.new()
## var board := StaticBody3D.new()
## add_child(board)
## add_child(peg)
## var plug := SpidarGSocket.new()
## plug.is_plug = true
## plug.position = Vector3(0, -0.02, 0) # The lower end of the peg.
## peg.add_child(plug)
## var hole := SpidarGSocket.new()
## hole.position = Vector3(0, 0.01, 0) # The top of the board.
## board.add_child(hole)
## plug.linked.connect(func(_mate: SpidarGSocket) -> void: print("click"))
## [/codeblock]
## [b]In the hand.[/b] Within [member capture_distance] the socket of the held body is drawn to the nearest free mate with
## [member attraction_force]. Within [member latch_distance] and [member latch_angle] it clicks: the body moves into its seat
## and stays there, while a spring of [member stiffness] pulls the grip toward the seat. When the pull of this spring exceeds
## [member release_force], the body comes off. When the hand opens, a joint holds the two bodies together.[br]
## [b]Whose values.[/b] Where two sockets meet, the values of the socket on the held body are used. If two hands hold both
## bodies, the values of the body that was grasped last are used. If several sockets of one held body act at once, their
## forces and stiffnesses are averaged and not added.[br]
## [b]Chains.[/b] A held body that links to a loose one carries it. The hand feels the weight of all bodies that hang on the
## held one, also if a floor supports them, but not their inertia. A link from the held body to a static or frozen body, or to
## a body that another hand holds or that hangs on such bodies, is a spring that can be pulled off. Any other link is
## rigid.[br]
## [b]Units.[/b] Distances and stiffness refer to device motion: a distance in the scene is [member SpidarG.workspace_scale]
## times as large. Forces are not scaled.[br]
## [b]Limits.[/b] A held body that is attracted or sits in its seat uses one of the six effects of its [SpidarG], with a
## negative id. If another hand holds the other body, its [SpidarG] needs one too. A socket that leaves the scene tree is
## unlinked. A socket that is added to a held body without sockets acts from the next grasp on.
## While no hand holds a body with sockets, the sockets take no time, except that each node that enters the tree is examined
## once, to find the hands.

## Emitted by both sockets when they are linked: when the held body clicks into its seat, and after [method link_to].
## [param mate] is the other socket.
signal linked(mate: SpidarGSocket)
## Emitted by both sockets when their link has ended. [param mate] is the other socket. [param pull_n] is the force, in
## newtons, with which the hand pulled the body off. It is 0 if the link ended in another way: by [method unlink], or because
## one of the sockets was disabled or left the scene tree.
signal unlinked(mate: SpidarGSocket, pull_n: float)

const _InRange := preload("values/in_range.gd")
const _SocketHand := preload("socket_hand.gd")
const _SocketHands := preload("socket_hands.gd")
const _SocketLink := preload("socket_link.gd")
const _SocketPull := preload("socket_pull.gd")

## The length of the arms of the cross that marks a socket in the editor, in meters of the scene.
const MARK_M: float = 0.01

## Sets the key of the socket. Only sockets with equal keys fit: see [method fits].
@export var key: StringName = &"":
	set(value):
		_leave_groups()
		key = value
		_join_groups()
## If [code]true[/code], this socket is a plug. A plug fits a socket that is not a plug and has the same [member key].
@export var is_plug: bool = false
## If [code]true[/code], any number of sockets can link to this one, such as the ends of several rods that meet in one point.
## Two sockets of the same [member key] that both have this property set fit whether or not they are plugs.
@export var meets_many: bool = false
## If [code]true[/code], the seat holds the position of the socket and not its orientation, as a ball joint does. After the
## hand has let go, the joint that holds the link is rigid all the same.
@export var turns_freely: bool = false
## If [code]true[/code], this socket attracts other sockets and can be linked. Setting [code]false[/code] ends its links.
@export var enabled: bool = true:
	set(value):
		enabled = value
		if not enabled:
			unlink()
@export_group("Attraction")
## Sets the force that draws the socket of the held body to its mate, in newtons, from 0 to 10. It acts in full within 3/4 of
## [member capture_distance] and falls to 0 at [member capture_distance]. Near the mate it is at most 150 N/m times the
## distance, so that the device stays stable. Another value is refused with an error, and the old one stays.
@export_range(0.0, 10.0, 0.05, "suffix:N") var attraction_force: float = 1.0:
	set(value):
		attraction_force = _checked(&"attraction_force", value, attraction_force, 0.0, 10.0, "N")
		update_configuration_warnings()
## Sets the distance between the sockets within which they attract, in meters of device motion, from 0.001 to 0.2. Another
## value is refused with an error, and the old one stays.
@export_range(0.001, 0.2, 0.001, "suffix:m") var capture_distance: float = 0.012:
	set(value):
		capture_distance = _checked(&"capture_distance", value, capture_distance, 0.001, 0.2, "m")
		update_configuration_warnings()
## Sets the angle between the axes of the sockets within which they attract, in radians, from 0 to PI. The inspector shows
## degrees. Ignored if [member turns_freely] is set. Another value is refused with an error, and the old one stays.
@export_range(0.0, 180.0, 0.5, "radians_as_degrees") var capture_angle: float = deg_to_rad(15.0):
	set(value):
		capture_angle = _checked(&"capture_angle", value, capture_angle, 0.0, PI, "rad")
@export_group("Click")
## Sets the distance between the sockets within which they click, in meters of device motion, from 0.0001 to 0.1. Another
## value is refused with an error, and the old one stays.
@export_range(0.0001, 0.1, 0.0001, "suffix:m") var latch_distance: float = 0.003:
	set(value):
		latch_distance = _checked(&"latch_distance", value, latch_distance, 0.0001, 0.1, "m")
		update_configuration_warnings()
## Sets the angle between the axes of the sockets within which they click, in radians, from 0 to PI. The inspector shows
## degrees. Ignored if [member turns_freely] is set. Another value is refused with an error, and the old one stays.
@export_range(0.0, 180.0, 0.5, "radians_as_degrees") var latch_angle: float = deg_to_rad(5.0):
	set(value):
		latch_angle = _checked(&"latch_angle", value, latch_angle, 0.0, PI, "rad")
@export_group("Hold")
## Sets the stiffness of the spring between the grip and the seat, in newtons per meter of device motion, from 10 to 1000. It
## is clamped to [method SpidarG.get_stiffness_limits]. Another value is refused with an error, and the old one stays.
@export_range(10.0, 1000.0, 1.0, "suffix:N/m") var stiffness: float = 150.0:
	set(value):
		stiffness = _checked(&"stiffness", value, stiffness, 10.0, 1000.0, "N/m")
## Sets the pull of the hand above which the body comes off its seat, in newtons, from 0.1 to 50. The grip is then
## [member release_force] / [member stiffness] away from the seat, which is 15 mm with the defaults. The pull is computed from
## this distance, so a device that cannot render the force lets go at the same distance. Another value is refused with an
## error, and the old one stays.
@export_range(0.1, 50.0, 0.05, "suffix:N") var release_force: float = 2.25:
	set(value):
		release_force = _checked(&"release_force", value, release_force, 0.1, 50.0, "N")

# Used by the other scripts of sockets.
var _links: Array[_SocketLink] = []


func _init() -> void:
	gizmo_extents = MARK_M


## Returns the body of this socket, which is its parent. Returns [code]null[/code] if the parent is no [PhysicsBody3D].
func get_body() -> PhysicsBody3D:
	return get_parent() as PhysicsBody3D


## Returns the socket that this one is linked to, or [code]null[/code] if there is none. If there are several (see
## [member meets_many]), returns the oldest one.
func get_mate() -> SpidarGSocket:
	return null if _links.is_empty() else _links[0].mate_of(self)


## Returns all sockets that this one is linked to, the oldest first.
func get_mates() -> Array[SpidarGSocket]:
	var mates: Array[SpidarGSocket] = []
	for link: _SocketLink in _links:
		mates.append(link.mate_of(self))
	return mates


## Returns [code]true[/code] if this socket is linked to another one, in a hand or by a joint.
func is_linked() -> bool:
	return not _links.is_empty()


## Returns [code]true[/code] if this socket and [param mate] fit: their keys are equal, and one of them is a plug or both of
## them have [member meets_many] set. Their places and their links do not matter.
func fits(mate: SpidarGSocket) -> bool:
	if mate == null or mate == self or key != mate.key:
		return false
	return is_plug != mate.is_plug or (meets_many and mate.meets_many)


## Links this socket to [param mate]. The bodies are not moved, so place them first. Returns [code]false[/code] if the sockets
## cannot be linked; a warning then says why.
func link_to(mate: SpidarGSocket) -> bool:
	var problem: String = _why_not(mate)
	if problem != "":
		push_warning("SpidarGSocket \"%s\": link_to does nothing: %s" % [name, problem])
		return false
	var link: _SocketLink = _SocketLink.make(self, mate)
	var holder: _SocketHand = _SocketHands.holder_of(get_body())
	if holder == null:
		holder = _SocketHands.holder_of(mate.get_body())
	if holder == null or not holder.take(link):
		link.lock()
	_tell_linked(mate)
	return true


## Ends all links of this socket. A body that hung on nothing else falls. Does nothing if there is no link.
func unlink() -> void:
	for link: _SocketLink in _links.duplicate():
		_end_link(link, 0.0)


func _enter_tree() -> void:
	update_configuration_warnings()
	if Engine.is_editor_hint():
		return
	_join_groups()
	_SocketHands.watch(get_tree())
	if get_body() == null:
		push_warning("SpidarGSocket \"%s\": %s" % [name, _get_configuration_warnings()[0]])


func _exit_tree() -> void:
	if Engine.is_editor_hint():
		return
	unlink()
	_leave_groups()
	_SocketHands.unwatch(get_tree())


func _get_configuration_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	if get_body() == null:
		warnings.append(
			"The socket links nothing here: make it a direct child of a RigidBody3D, or of a StaticBody3D or another physics body."
		)
	if latch_distance > capture_distance:
		warnings.append(
			"latch_distance = %s m is larger than capture_distance = %s m, within which it acts: make latch_distance smaller."
			% [latch_distance, capture_distance]
		)
	var reached_n: float = _SocketPull.FULL_FROM * capture_distance * _SocketPull.LOAD_STIFFNESS_N_M
	if attraction_force > reached_n + 1e-6:
		warnings.append(
			"attraction_force = %s N is not reached: within capture_distance = %s m the force grows to %.2f N. "
			% [attraction_force, capture_distance, reached_n]
			+ "Enlarge capture_distance or lower attraction_force."
		)
	return warnings


# Returns whether the socket can take one more mate.
func _is_free() -> bool:
	return enabled and (meets_many or _links.is_empty())


# Returns why the two sockets cannot be linked, with the remedy, or an empty string.
func _why_not(mate: SpidarGSocket) -> String:
	if mate == null or mate == self:
		return "give another socket."
	if not is_inside_tree() or not mate.is_inside_tree() or get_body() == null or mate.get_body() == null:
		return "both sockets must be in the scene tree, each as a child of a physics body."
	if get_body() == mate.get_body() or get_world_3d() != mate.get_world_3d():
		return "give a socket of another body in the same world."
	if not fits(mate):
		return "\"%s\" does not fit: give both the same key, and is_plug to one of them." % mate.name
	if get_mates().has(mate):
		return "it is linked to \"%s\" already." % mate.name
	if not _is_free() or not mate._is_free():
		return "one of them is linked already or disabled: unlink or enable it first."
	return ""


# Ends the link first, and emits the signals of both sockets then.
func _end_link(link: _SocketLink, pull_n: float) -> void:
	var mate: SpidarGSocket = link.mate_of(self)
	_SocketHands.note_parted(self, mate)
	link.cut()
	_tell_unlinked(mate, pull_n)


func _tell_linked(mate: SpidarGSocket) -> void:
	linked.emit(mate)
	if is_instance_valid(mate):
		mate.linked.emit(self)


func _tell_unlinked(mate: SpidarGSocket, pull_n: float) -> void:
	unlinked.emit(mate, pull_n)
	if is_instance_valid(mate):
		mate.unlinked.emit(self, pull_n)


func _join_groups() -> void:
	if is_inside_tree() and not Engine.is_editor_hint():
		add_to_group(_SocketHands.SOCKETS)
		add_to_group(_SocketHands.group_of(key))


func _leave_groups() -> void:
	for group: StringName in [_SocketHands.SOCKETS, _SocketHands.group_of(key)]:
		if is_in_group(group):
			remove_from_group(group)


# Returns `value`, or `old` with an error if it is out of range. NAN compares false.
func _checked(field: StringName, value: float, old: float, least: float, most: float, unit: String) -> float:
	return _InRange.checked("SpidarGSocket \"%s\"" % name, field, value, old, unit, least, most)
