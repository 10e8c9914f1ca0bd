@tool
@icon("../icons/spidar_g_grip.svg")
class_name SpidarGGrip
extends Node3D
## Follows the grip of a [SpidarG], so that the children of this node follow the hand.
##
## Make this node a descendant of a [SpidarG], or set [member spidar_path], and add meshes, lights, sounds or areas as its
## children.
## [codeblock]
## # A small box in the hand.
## var grip := SpidarGGrip.new()
## $SpidarG.add_child(grip)
## var tool := MeshInstance3D.new()
## tool.mesh = BoxMesh.new()
## tool.scale = Vector3.ONE * 0.03
## grip.add_child(tool)
## [/codeblock]
## In each physics tick the node takes the pose that the device has in this tick, also if the [SpidarG] moves through the
## scene. The [method Node._physics_process] of this node runs after that of the [SpidarG]: the node raises its own process
## priorities if the order of the tree does not ensure this. A script that runs later in the tick, because it is below this
## node in the tree or has a higher priority, reads the pose of the same tick.
## [br][br]
## If frames are drawn more often than physics ticks, the node is drawn between the last two poses: see [member smoothing]. If
## the physics interpolation of the engine is on for this node, the engine does this instead.
## [br][br]
## The children keep their size: [member SpidarG.workspace_scale] and the scale of the parents do not change it.

## Selects the pose that the node follows: the grip or the proxy.
enum Follow {
	## The node follows the grip of the device: [method SpidarG.get_grip_transform].
	GRIP,
	## The node follows the proxy, which stops at surfaces: [method SpidarGHand.get_proxy_transform] of the [SpidarGHand] that
	## is a child of the [SpidarG].
	PROXY,
}
## Selects how the node moves in frames that are drawn between physics ticks.
enum Smoothing {
	## The node moves from the pose of the last tick but one to that of the last tick, if frames are drawn more often than
	## physics ticks. It is at most one tick late, and it is smooth with every drive mode of the device.
	INTERPOLATE,
	## The node takes the newest pose of the device in each frame, as [SpidarGView] does, and is not late. With
	## [constant SpidarG.DRIVE_STEPPED] it moves only once per physics tick.
	NEWEST,
}

const _Finder := preload("follow/spidar_finder.gd")
## The node stops interpolating after this many physics ticks in a row in each of which at most one frame was drawn.
const TICKS_TO_FORGET: int = 30

## Selects whether the node follows the grip or the proxy. Without a [SpidarGHand] there is no proxy; the node then follows
## the grip, and a configuration warning says so.
@export var follow := Follow.GRIP:
	set(value):
		follow = value
		_choose()
## Sets the [SpidarG] that the node follows. With an empty path the nearest ancestor that is a [SpidarG] is used.
@export_node_path("SpidarG") var spidar_path: NodePath:
	set(value):
		spidar_path = value
		_choose()
## Sets the pose of this node in the frame of the grip, in meters that [member SpidarG.workspace_scale] does not scale. The
## origin is the center of the grip, and the x axis is the axis of the jaws. A scale in the transform scales the children. A
## transform that is flat or not finite is refused with an error, and the old one stays.
@export_custom(PROPERTY_HINT_NONE, "suffix:m") var offset := Transform3D.IDENTITY:
	set(value):
		if not value.is_finite() or is_zero_approx(value.basis.determinant()):
			push_error("SpidarGGrip.offset = %s: give a finite transform (m) with no scale of zero; the old one stays." % value)
			return
		offset = value
## Selects how the node moves in frames that are drawn between physics ticks. Ignored while the engine's physics interpolation
## is on for this node.
@export var smoothing := Smoothing.INTERPOLATE

## The device that the node follows. It is [code]null[/code] in the editor, outside the scene tree, and if no [SpidarG] is
## found; a configuration warning then says why. While it is [code]null[/code], the node does not move.
var spidar: SpidarG = null

var _hand: SpidarGHand = null
# The poses of the last tick and of the one before, and the pose of the device at these ticks.
var _pose := Transform3D.IDENTITY
var _frame := Transform3D.IDENTITY
var _pose_before := Transform3D.IDENTITY
var _frame_before := Transform3D.IDENTITY
var _is_placed: bool = false
var _frames_since_tick: int = 0
var _ticks_to_smooth: int = 0


## Returns the pose of this node in the world at the last physics tick. Between ticks [member Node3D.global_transform] is the
## pose that is drawn. Returns the current pose while no device is followed.
func get_tick_transform() -> Transform3D:
	return _carried(_pose, _frame) * offset if _is_placed and spidar != null else global_transform


func _enter_tree() -> void:
	_is_placed = false
	if is_node_ready():
		_choose()


func _ready() -> void:
	_choose()
	if spidar == null and not Engine.is_editor_hint() and ClassDB.class_exists(&"SpidarG"):
		push_warning(_Finder.problem(self, spidar_path, "SpidarGGrip"))


func _exit_tree() -> void:
	spidar = null
	_hand = null


func _get_configuration_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	var problem: String = _Finder.problem(self, spidar_path, "SpidarGGrip")
	if not problem.is_empty():
		warnings.append(problem)
	elif follow == Follow.PROXY and _Finder.find_hand(_Finder.find(self, spidar_path)) == null:
		warnings.append("SpidarGGrip follows the grip: its SpidarG has no SpidarGHand, which makes the proxy. "
			+ "Add a SpidarGHand as a child of the SpidarG, or set follow to Grip.")
	return warnings


func _physics_process(_delta: float) -> void:
	if not is_instance_valid(spidar) or not spidar.is_inside_tree():
		_choose()
		return
	_ticks_to_smooth = TICKS_TO_FORGET if _frames_since_tick > 1 else maxi(0, _ticks_to_smooth - 1)
	_frames_since_tick = 0
	_pose_before = _pose
	_frame_before = _frame
	_read()
	if not _is_placed:
		_is_placed = true
		_pose_before = _pose
		_frame_before = _frame
	_place(_pose)
	# Once more when all nodes have moved: the device may ride on one that moves after this node.
	_read_again.call_deferred()


func _process(_delta: float) -> void:
	_frames_since_tick += 1
	if not _is_placed or not is_instance_valid(spidar) or not spidar.is_inside_tree():
		return
	if is_physics_interpolated_and_enabled():
		return
	if smoothing == Smoothing.NEWEST:
		_place(_read_pose())
		return
	var now: Transform3D = _carried(_pose, _frame)
	if _ticks_to_smooth > 0 or _frames_since_tick > 1:
		now = _carried(_pose_before, _frame_before).interpolate_with(now, Engine.get_physics_interpolation_fraction())
	_place(now)


# Finds device and hand, and runs after both. The engine turns processing on just before _ready().
func _choose() -> void:
	if not is_inside_tree():
		return
	update_configuration_warnings()
	if Engine.is_editor_hint():
		set_process(false)
		set_physics_process(false)
		return
	spidar = _Finder.find(self, spidar_path)
	_hand = _Finder.find_hand(spidar) if follow == Follow.PROXY else null
	_is_placed = false
	set_process(spidar != null)
	set_physics_process(spidar != null)
	if spidar == null:
		return
	_Finder.run_after(self, spidar)
	_Finder.run_after(self, _hand)
	# A child of the device comes along at once when the device is moved; elsewhere a parent must not move it.
	top_level = get_parent() != spidar


func _read() -> void:
	_pose = _read_pose()
	_frame = _device_frame()


func _read_again() -> void:
	if not _is_placed or not is_instance_valid(spidar) or not spidar.is_inside_tree():
		return
	_read()
	_place(_pose)


func _read_pose() -> Transform3D:
	if follow == Follow.PROXY:
		if not is_instance_valid(_hand) or _hand.get_parent() != spidar:
			_hand = _Finder.find_hand(spidar)
			_Finder.run_after(self, _hand)
		if _hand != null:
			return _hand.get_proxy_transform()
	return spidar.get_grip_transform()


# Returns the pose of the device without scale. A flat transform is ignored, as in SpidarG.
func _device_frame() -> Transform3D:
	var place: Transform3D = spidar.global_transform
	if not place.is_finite() or is_zero_approx(place.basis.determinant()):
		return _frame
	return place.orthonormalized()


# Returns a pose that was read while the device was at `frame`, moved along with the device since then.
func _carried(pose: Transform3D, frame: Transform3D) -> Transform3D:
	var now: Transform3D = _device_frame()
	return pose if now == frame else now * frame.inverse() * pose


func _place(pose: Transform3D) -> void:
	var place: Transform3D = pose * offset
	if place != global_transform:
		global_transform = place
