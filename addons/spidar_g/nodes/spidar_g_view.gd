@tool
@icon("../icons/spidar_g_view.svg")
class_name SpidarGView
extends Node3D
## Draws a SPIDAR-G: its frame, strings, grip, finger pads and force.
##
## Add this node as a child of a [SpidarG]. It draws the frame, the eight strings colored by their tension, the two poles with
## their hinge, hemispheres and hinge stops, the finger pads of a sibling [SpidarGHand], and the achieved force as an arrow.
## The view does not change the device. In each frame it redraws only what has changed, and it does nothing while it is
## hidden.
## [codeblock]
## var device: SpidarG = $SpidarG
## device.add_child(SpidarGView.new())
## [/codeblock]

const _ViewParts := preload("view_parts.gd")

## A string whose tension is below this value is drawn as slack, in newtons.
const SLACK_N: float = 0.05
## Strings that are slack are drawn in this color.
const SLACK_COLOUR: Color = Color(0.55, 0.55, 0.58)
# The colors go from blue to orange, with no red against green, so that color-blind people can tell the steps apart.
## Strings with a low tension are drawn in this color.
const LOW_COLOUR: Color = Color(0.16, 0.40, 0.96)
## Strings between low and medium tension are drawn in this color. Without it, the mixture of the other two colors would look
## like the gray of a slack string.
const FAIR_COLOUR: Color = Color(0.35, 0.85, 0.95)
## Strings with a medium tension are drawn in this color.
const MIDDLE_COLOUR: Color = Color(1.00, 0.90, 0.20)
## Strings at their maximum tension are drawn in this color.
const HIGH_COLOUR: Color = Color(0.85, 0.30, 0.00)
## The arrow is hidden while the achieved force is weaker than this value, in newtons.
const LEAST_FORCE_N: float = 0.02

## If [code]true[/code], the edges of the frame are drawn.
@export var show_frame: bool = true:
	set(value):
		show_frame = value
		_stale = true
## If [code]true[/code], the strings are drawn, colored by their commanded tension from slack to
## [member SpidarGConfig.tension_max].
@export var show_strings: bool = true:
	set(value):
		show_strings = value
		_stale = true
## If [code]true[/code], the grip is drawn: two poles with their hinge, or the body of a rigid grip.
@export var show_grip: bool = true:
	set(value):
		show_grip = value
		_stale = true
## If [code]true[/code], the finger pads of the [SpidarGHand] are drawn. Ignored if the [SpidarG] has no hand.
@export var show_pads: bool = true:
	set(value):
		show_pads = value
		_stale = true
## If [code]true[/code], the achieved force is drawn as an arrow that begins at the center of the grip.
@export var show_force: bool = true:
	set(value):
		show_force = value
		_stale = true
## Sets the length of the force arrow, in meters of device motion for each newton.
@export_range(0.001, 0.1, 0.001, "suffix:m/N") var force_arrow_length: float = 0.015

## The device that is drawn, which is the parent of this node. It is [code]null[/code] if the parent is no [SpidarG]; nothing
## is then drawn, and a configuration warning says why.
var spidar: SpidarG = null

var _parts: _ViewParts = null
var _hand: SpidarGHand = null
var _is_rigid: bool = false
var _stale: bool = true
var _drawn_grip: Transform3D = Transform3D.IDENTITY
var _drawn_frame: Transform3D = Transform3D.IDENTITY
var _drawn_angle: float = NAN
var _drawn_pads: Array[Transform3D] = [Transform3D.IDENTITY, Transform3D.IDENTITY]
var _drawn_tensions: PackedFloat64Array = PackedFloat64Array()
var _drawn_force: Vector3 = Vector3.ZERO


## Returns the color of a string with the tension [param tension_n], in newtons, if its maximum tension is [param max_n]. The
## color depends on the square root of the tension, so that pretension and half of the maximum look different.
static func tension_colour(tension_n: float, max_n: float) -> Color:
	if not (tension_n >= SLACK_N) or not (max_n > 0.0):
		return SLACK_COLOUR
	var part: float = 3.0 * clampf(sqrt(tension_n / max_n), 0.0, 1.0)
	if part < 1.0:
		return LOW_COLOUR.lerp(FAIR_COLOUR, part)
	if part < 2.0:
		return FAIR_COLOUR.lerp(MIDDLE_COLOUR, part - 1.0)
	return MIDDLE_COLOUR.lerp(HIGH_COLOUR, part - 2.0)


## Returns the pose in the world at which a pad was last drawn. The origin is the middle of its inner face, and the x axis
## points outward. [param side] is 0 for the pad at -x of the grip and 1 for the other one. Returns the identity transform
## before the first drawing.
func get_drawn_pad(side: int) -> Transform3D:
	return _drawn_pads[side]


func _enter_tree() -> void:
	spidar = get_parent() as SpidarG
	update_configuration_warnings()
	if Engine.is_editor_hint():
		return
	top_level = true
	global_transform = Transform3D.IDENTITY
	# The parts are placed in each drawn frame at the newest pose: there is nothing to interpolate.
	physics_interpolation_mode = Node.PHYSICS_INTERPOLATION_MODE_OFF
	_stale = true
	if spidar == null:
		push_warning("SpidarGView draws nothing: make it a child of a SpidarG node.")
	elif _parts == null:
		_parts = _ViewParts.new()
		# Internal: a copy of the view makes parts of its own.
		add_child(_parts, false, Node.INTERNAL_MODE_FRONT)
	if is_node_ready():
		_follow()


func _ready() -> void:
	_follow()


func _exit_tree() -> void:
	spidar = null
	_hand = null


func _get_configuration_warnings() -> PackedStringArray:
	if get_parent() is SpidarG:
		return []
	return ["SpidarGView draws nothing here: make it a child of a SpidarG node."]


# The engine turns processing on just before _ready().
func _follow() -> void:
	# Without the add-on's library a SpidarG is a stand-in, of which there is nothing to draw.
	var draws: bool = spidar != null and not Engine.is_editor_hint() and ClassDB.class_exists(&"SpidarG")
	set_process(draws)
	if _parts != null:
		_parts.visible = draws


func _process(_delta: float) -> void:
	if spidar == null or not is_visible_in_tree():
		return
	_hand = _find_hand()
	var grip: Transform3D = spidar.get_grip_transform()
	var angle: float = spidar.get_grasp_angle()
	var frame: Transform3D = spidar.global_transform
	var frame_moved: bool = _stale or frame != _drawn_frame
	var grip_moved: bool = frame_moved or grip != _drawn_grip or angle != _drawn_angle
	if frame_moved:
		_draw_frame(frame)
	if grip_moved:
		_draw_grip(grip, angle)
	_draw_tensions(grip_moved)
	_draw_pads()
	_draw_force(grip.origin, grip_moved)
	_stale = false


func _draw_frame(frame: Transform3D) -> void:
	_drawn_frame = frame
	var scale_m: float = spidar.workspace_scale
	_is_rigid = spidar.get_effective_config().has_rigid_grip()
	_parts.size_for(scale_m, _pole_half_length(), _is_rigid)
	_parts.frame.visible = show_frame
	var placed: Transform3D = Transform3D(frame.basis.orthonormalized(), frame.origin)
	_parts.place_frame(placed, _frame_size() * scale_m)


func _draw_grip(grip: Transform3D, angle: float) -> void:
	_drawn_grip = grip
	_drawn_angle = angle
	_parts.grip.visible = show_grip
	_parts.strings.visible = show_strings
	if show_grip and _is_rigid:
		var ends: PackedVector3Array = []
		for string: int in _ViewParts.STRINGS:
			ends.append(spidar.get_string_end(string))
		_parts.place_rigid_grip(grip, ends)
	elif show_grip:
		_parts.place_grip(
			grip, spidar.get_pole_transform(0), spidar.get_pole_transform(1), _closed_angle()
		)
		for end: int in 4:
			var target: SpidarG.ContactTarget = (SpidarG.CONTACT_POLE1_PLUS + end) as SpidarG.ContactTarget
			_parts.place_knot(end, spidar.get_pole_end(target))
	if show_strings:
		for string: int in _ViewParts.STRINGS:
			_parts.place_string(string, spidar.get_string_start(string), spidar.get_string_end(string))


func _draw_tensions(forced: bool) -> void:
	if not show_strings:
		return
	var tensions: PackedFloat64Array = spidar.get_string_tensions()
	if not forced and tensions == _drawn_tensions:
		return
	_drawn_tensions = tensions
	for string: int in mini(tensions.size(), _ViewParts.STRINGS):
		_parts.colour_string(string, tension_colour(tensions[string], _max_tension()))


func _draw_pads() -> void:
	_parts.pads.visible = show_pads and _hand != null
	if not _parts.pads.visible:
		return
	for side: int in 2:
		var pad: Transform3D = _hand.get_pad_transform(side)
		if pad != _drawn_pads[side] or _stale:
			_drawn_pads[side] = pad
			_parts.place_pad(side, pad, _hand.get_pad_radius())


func _draw_force(from: Vector3, forced: bool) -> void:
	if not show_force:
		_parts.arrow.visible = false
		return
	var wrench: PackedFloat64Array = spidar.get_achieved_wrench()
	var force: Vector3 = Vector3.ZERO
	if wrench.size() >= 3:
		force = Vector3(wrench[0], wrench[1], wrench[2])
	if not forced and force == _drawn_force:
		return
	_drawn_force = force
	_parts.arrow.visible = force.length() > LEAST_FORCE_N
	if _parts.arrow.visible:
		_parts.place_arrow(from, force * (force_arrow_length * spidar.workspace_scale))


func _find_hand() -> SpidarGHand:
	if is_instance_valid(_hand) and _hand.get_parent() == spidar:
		return _hand
	for child: Node in spidar.get_children():
		if child is SpidarGHand:
			return child as SpidarGHand
	return null


func _pole_half_length() -> float:
	return spidar.get_effective_config().get_effective_pole_half_length()


func _frame_size() -> Vector3:
	return spidar.get_effective_config().get_effective_frame_size()


func _closed_angle() -> float:
	return spidar.get_effective_config().jaw_closed_angle


func _max_tension() -> float:
	return spidar.get_effective_config().tension_max
