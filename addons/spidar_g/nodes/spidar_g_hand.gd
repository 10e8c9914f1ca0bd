@tool
@icon("../icons/spidar_g_hand.svg")
class_name SpidarGHand
extends Node3D
## The tool that a SPIDAR-G holds in a scene: two finger pads on the grip's jaw axis.
##
## Add it as a child of a [SpidarG]. Each physics frame it publishes the surfaces near the tool as contact
## planes and the body between the pads as a stop on the grasp angle, both rendered in the device thread, and
## asks for the weight and inertia of the body it holds. A [RigidBody3D] squeezed hard enough (friction check) is
## held by a 6-DOF joint until the jaws open. Bodies with metadata [code]spidar_stiffness_n_m[/code] (N/m),
## [code]spidar_squeeze_nm_rad[/code] (N m/rad) or [code]spidar_friction[/code] feel softer, rougher or smoother.

signal body_grasped(body: RigidBody3D)
## Also when the body leaves the tree.
signal body_released(body: RigidBody3D)
## The pads closed on a body and do not hold it; once per attempt, with the reason and the remedy.
signal grasp_refused(body: RigidBody3D, reason: String)
## Once a physics frame while a body is held, before it is moved: the time for [method add_load] and [method detain].
signal carrying(delta: float)

const ContactFinder := preload("contact_finder.gd")
const ContactPlane := preload("contact_plane.gd")
const ContactSet := preload("contact_set.gd")
const DeviceClock := preload("hand/device_clock.gd")
const GraspJudge := preload("grasp_judge.gd")
const GraspStop := preload("grasp_stop.gd")
const HandPlace := preload("hand/place.gd")
const HandRanges := preload("hand/ranges.gd")
const HandRequests := preload("hand/requests.gd")
const HeldLoad := preload("held_load.gd")
const HoldJoint := preload("hold_joint.gd")
const HoldWatch := preload("hold_watch.gd")
const JawSensor := preload("jaw_sensor.gd")
const PadShape := preload("pad_shape.gd")
const ShownPads := preload("shown_pads.gd")
const SteppedPlace := preload("hand/stepped_place.gd")

## Closing to within this of a body's width counts as touching it, rad.
const TOUCH_TOLERANCE: float = 0.01
## Opening this far past the held body's width lets go, rad (3 degrees; less would drop it when a hand trembles).
const RELEASE_ANGLE: float = 0.052

## Layers that the tool touches and grasps.
@export_flags_3d_physics var collision_mask: int = 1
@export_group("Contact", "contact_")
## Surfaces nearer than this (device metres) are published, so that the device has them before the hand does.
@export_range(0.01, 0.1, 0.001, "suffix:m") var contact_margin_m: float = 0.04:
	set(value):
		contact_margin_m = HandRanges.checked(&"contact_margin_m", value, contact_margin_m)
## Of every surface, per device metre. Above 350 light hands may buzz on slow links.
@export_range(50.0, 2000.0, 1.0, "suffix:N/m") var contact_stiffness_n_m: float = 350.0:
	set(value):
		contact_stiffness_n_m = HandRanges.checked(&"contact_stiffness_n_m", value, contact_stiffness_n_m)
@export_range(0.0, 5.0, 0.1, "suffix:N s/m") var contact_damping_n_s_m: float = 2.0:
	set(value):
		contact_damping_n_s_m = HandRanges.checked(&"contact_damping_n_s_m", value, contact_damping_n_s_m)
@export_range(0.0, 2.0, 0.01) var contact_friction: float = 0.4:
	set(value):
		contact_friction = HandRanges.checked(&"contact_friction", value, contact_friction)
@export_group("Grasp")
## Between a pad and a body. A body whose physics material is smoother takes its own, unless it is marked rough.
@export_range(0.0, 2.0, 0.01) var pad_friction: float = 1.0:
	set(value):
		pad_friction = HandRanges.checked(&"pad_friction", value, pad_friction)
## Least grasp torque that holds anything, however light.
@export_range(0.0, 0.4, 0.001, "suffix:N m") var hold_torque_nm: float = 0.005:
	set(value):
		hold_torque_nm = HandRanges.checked(&"hold_torque_nm", value, hold_torque_nm)
## A held body pressed against the world harder than this is torn from the pads.
@export_range(0.5, 50.0, 0.1, "suffix:N") var break_force_n: float = 7.0:
	set(value):
		break_force_n = HandRanges.checked(&"break_force_n", value, break_force_n)
@export_group("Feel")
@export var render_contacts: bool = true
@export var render_width: bool = true
@export var render_weight: bool = true
@export var render_inertia: bool = true
## Multiplies the felt weight and inertia, for scenes whose masses the device cannot carry.
@export_range(0.0, 2.0, 0.01) var weight_scale: float = 1.0:
	set(value):
		weight_scale = HandRanges.checked(&"weight_scale", value, weight_scale)

## The parent, or null: then nothing happens and a configuration warning says why.
var spidar: SpidarG = null

var _contacts: ContactSet = ContactSet.new()
var _finder: ContactFinder = ContactFinder.new()
var _jaw: JawSensor = JawSensor.new()
var _judge: GraspJudge = GraspJudge.new()
var _stop: GraspStop = GraspStop.new()
var _load: HeldLoad = HeldLoad.new()
var _pad: PadShape = PadShape.new()
var _shown_pads: ShownPads = ShownPads.new()
var _hold: HoldJoint = null
var _held_width_m: float = 0.0
var _watch: HoldWatch = HoldWatch.new()
var _clock: DeviceClock = DeviceClock.new()
var _stepped: SteppedPlace = SteppedPlace.new()
var _requests: HandRequests = HandRequests.new()
var _place: HandPlace = HandPlace.new()


func _enter_tree() -> void:
	spidar = get_parent() as SpidarG
	_requests.device = spidar
	_requests.owner = name
	set_physics_process(spidar != null and not Engine.is_editor_hint())
	update_configuration_warnings()
	_place.entered(self)


func _ready() -> void:
	# Again: the engine turns physics processing on just before this.
	set_physics_process(spidar != null and not Engine.is_editor_hint())


func _exit_tree() -> void:
	if not Engine.is_editor_hint():
		release()
		_withdraw()
	spidar = null


func _get_configuration_warnings() -> PackedStringArray:
	return HandPlace.warnings(self)


## The body that the tool holds, or null.
func get_held_body() -> RigidBody3D:
	return _hold.body if _hold != null else null


## Width of the held body along the jaw axis where the pads hold it, scene metres; 0 when none is held.
func get_held_width_m() -> float:
	return _held_width_m if _hold != null else 0.0


## Middle of a pad's inner face in the world, side 0 at -x of the grip: see [method get_pad_transform].
func get_pad_position(side: int) -> Vector3:
	return get_pad_transform(side).origin


## A pad in the world, x outward from the middle of its inner face, side 0 at -x of the grip: as shown, turned with the
## body that it holds and never inside what it meets. Looked up in the physics space by this call.
func get_pad_transform(side: int) -> Transform3D:
	if spidar == null:
		return global_transform
	var grip: Transform3D = _hold.carried_grip() if _hold != null else spidar.get_grip_transform()
	var at: Transform3D = _pad.transform_of(side, grip, _shown_gap_m())
	at.origin += _contacts.shown_shift()
	var shape: ConvexPolygonShape3D = _pad.shape_for(spidar.workspace_scale)
	return _shown_pads.place_in(get_world_3d(), collision_mask, shape, at, get_pad_radius_m())


## Radius of a pad, scene metres.
func get_pad_radius_m() -> float:
	return PadShape.RADIUS_M * (spidar.workspace_scale if spidar != null else 1.0)


## Grasp torque with which the fingers press the body between the pads, N m; 0 when they do not.
func get_squeeze_torque_nm() -> float:
	return _stop.squeeze_nm


## Grasp angle at which the body between the pads (or the closed pads) stops the fingers, rad; NAN when nothing does.
func get_stop_angle() -> float:
	return _stop.angle_rad if _stop.active else NAN


## Where the held body would be if nothing stood in its way; the identity when none is held.
func get_wanted_pose() -> Transform3D:
	if _hold == null or spidar == null:
		return Transform3D.IDENTITY
	return _hold.where(spidar.get_grip_transform())


## A magnet or spring on the held body in this frame: N, and N m about the grip's centre, world axes; to about 150 N/m.
func add_load(force_n: Vector3, moment_nm: Vector3 = Vector3.ZERO) -> void:
	_load.add(force_n, moment_nm)


## In this frame the held body stays at `seat` and the grip moves on alone; [method add_load] gives the hand its pull.
func detain(seat: Transform3D) -> void:
	if _hold != null:
		_hold.detain(seat)


## Lets go of the held body, if any.
func release() -> void:
	if _hold == null:
		return
	var body: RigidBody3D = _hold.body
	if is_instance_valid(body) and body.tree_exiting.is_connected(release):
		body.tree_exiting.disconnect(release)
	_hold.detach(spidar.workspace_scale if spidar != null else 1.0)
	_hold.queue_free()
	_hold = null
	_judge.reset()
	body_released.emit(body)


func _physics_process(delta: float) -> void:
	if not _place.may_act(self) or spidar.get_state() == SpidarG.STATE_CLOSED:
		release()
		_withdraw()
		return
	_clock.read(spidar)
	_stepped.note(spidar)
	var grip: Transform3D = _stepped.in_space(spidar.get_grip_transform())
	var forces_on: bool = render_width and spidar.get_state() == SpidarG.STATE_ACTIVE
	if _clock.elapsed_s > 0.0:
		_read_device(forces_on, _clock.elapsed_s)
	if _hold != null:
		_watch_hold()
	if _hold == null:
		_jaw.centring_m = 0.0 if forces_on else JawSensor.CENTRING_M * spidar.workspace_scale
		_sense_jaws(grip)
		if delta > 0.0:  # Nothing is lifted while the game's time stands still.
			_try_grasp(grip)
	var found: Array[ContactPlane] = []
	var exclude: Array[RID] = []
	if _hold != null:
		exclude.append(_hold.body.get_rid())
		_carry(grip, exclude, delta, found)
	_find_tool_planes(grip, exclude, found)
	_contacts.replace(found)
	var rows: PackedFloat64Array = PackedFloat64Array()
	if render_contacts:
		_contacts.keep_nearest(_requests.free_planes())
		_contacts.pack_into(rows, spidar.get_grip_transform().origin)
	if render_width:
		_stop.pack_into(rows)
	_requests.publish(rows)
	_request_load(grip)


## What happened at the device since the pose that was read before.
func _read_device(forces_on: bool, since_s: float) -> void:
	_contacts.read_impulses(spidar.get_contact_impulses(_requests.owner))
	_stop.measure(_contacts, spidar.get_grasp_angle(), forces_on, since_s)
	_contacts.push_bodies(_settings().max_force, since_s, spidar.get_linear_velocity())
	var node: Transform3D = spidar.global_transform.orthonormalized()
	_load.follow(node.affine_inverse() * spidar.get_grip_transform().origin, since_s)


func _sense_jaws(grip: Transform3D) -> void:
	var scale_m: float = spidar.workspace_scale
	var settings: SpidarGConfig = _settings()
	_jaw.collision_mask = collision_mask
	_jaw.entry_tolerance_m = JawSensor.ENTRY_TOLERANCE_M * scale_m
	_jaw.look(_space(), grip, _gap_m(), 0.5 * settings.jaw_open * scale_m + get_pad_radius_m(), get_pad_radius_m(), [])
	if _jaw.body != null:
		_place_stop(_jaw.width_m, _jaw.body, _jaw.rid)
	elif spidar.get_grasp_angle() > settings.jaw_closed_angle - GraspStop.CLOSED_STOP_RANGE:
		_stop.place(_contacts, settings.jaw_closed_angle, GraspStop.STIFFNESS_NM_RAD, RID())
	else:
		_stop.remove()


func _place_stop(width_m: float, body: CollisionObject3D, rid: RID) -> void:
	if not _stop.is_for(rid):
		_judge.reset()
	var angle: float = spidar.get_grasp_angle_for_gap(width_m / spidar.workspace_scale)
	var stiffness: float = ContactFinder.float_meta(
		body, GraspStop.STIFFNESS_META, GraspStop.STIFFNESS_NM_RAD
	)
	_stop.place(_contacts, angle, stiffness, rid)


func _try_grasp(grip: Transform3D) -> void:
	var angle: float = spidar.get_grasp_angle()
	if _jaw.body == null or angle < _stop.angle_rad - RELEASE_ANGLE:
		_judge.reset()
		return
	if angle < _stop.angle_rad - TOUCH_TOLERANCE:
		return
	# The fingers push at the poles' ends: force = torque / pole half length.
	var lever: float = _settings().pole_half_length
	_judge.pad_friction = pad_friction
	_judge.min_force_n = hold_torque_nm / lever
	_judge.weight_scale = weight_scale
	var verdict: GraspJudge.Verdict = _judge.judge(
		_jaw, _stop.squeeze_nm / lever, spidar.get_grasp_rate(), _clock.elapsed_s
	)
	if verdict == GraspJudge.Verdict.HOLD:
		_attach(_jaw.body as RigidBody3D, grip)
	elif verdict == GraspJudge.Verdict.REFUSE:
		grasp_refused.emit(_jaw.body as RigidBody3D, _judge.reason)


func _attach(body: RigidBody3D, grip: Transform3D) -> void:
	_hold = HoldJoint.new()
	add_child(_hold, false, Node.INTERNAL_MODE_BACK)  # Not copied by duplicate(): the copy holds nothing.
	_hold.attach(body, grip, _jaw.centre_offset_m)
	_held_width_m = _jaw.width_m
	_watch.reset()
	_load.reset()
	body.tree_exiting.connect(release)
	body_grasped.emit(body)


## Lets go when the jaws open past the body, or when the world tears at it for long enough.
func _watch_hold() -> void:
	if not _hold.is_movable():
		release()
		return
	var opened: bool = spidar.get_grasp_angle() < _stop.angle_rad - RELEASE_ANGLE
	var broken: bool = _watch.breaks(
		_hold, _contacts, break_force_n, spidar.workspace_scale, _clock.elapsed_s
	)
	if opened or broken or _hold.body.freeze:
		release()


## Moves the held body with the grip as far as the world lets it, and finds the planes that stop it.
func _carry(
	grip: Transform3D, exclude: Array[RID], delta: float, found: Array[ContactPlane]
) -> void:
	var target: Transform3D = spidar.get_grip_transform()
	_hold.advance(delta)
	_load.clear()
	carrying.emit(delta)
	if _hold == null or _hold.detained:  # A listener let go, or it sits where the world cannot stop it: no planes.
		if _hold != null:
			_hold.follow(target, Vector3.ZERO)
		return
	_prepare_finder()
	_finder.find_round_body(_space(), _hold.body, _hold.where(grip), exclude, found)
	if _stepped.has_jumped(delta):
		_hold.jump(target)
	_hold.follow(target, ContactSet.way_out(found))


func _find_tool_planes(grip: Transform3D, exclude: Array[RID], found: Array[ContactPlane]) -> void:
	if not render_contacts:
		return
	_prepare_finder()
	var beside: Array[RID] = exclude.duplicate()
	if _hold == null and _jaw.body != null:
		beside.append(_jaw.rid)
		var settings: SpidarGConfig = _settings()
		var gap_per_rad: float = settings.jaw_open / settings.jaw_closed_angle
		var closing: float = spidar.get_grasp_rate() * gap_per_rad * spidar.workspace_scale
		_jaw.side_planes(_finder, grip, _gap_m(), closing, JawSensor.SIDE_SLACK_M * spidar.workspace_scale, found)
	var shape: Shape3D = _pad.shape_for(spidar.workspace_scale)
	# Planes act until the next ones come. Relative to the device: what is near it rides along with it, or moves slowly.
	var ahead: Vector3 = spidar.global_basis.orthonormalized() * _load.velocity * _clock.ahead_s
	for side: int in 2:
		var at: Transform3D = _pad.transform_of(side, grip, _shown_gap_m())
		_finder.find(_space(), shape, at, beside, found, ahead)


func _request_load(grip: Transform3D) -> void:
	if _hold == null or not (render_weight or render_inertia):
		_requests.end_load()
		return
	_load.gain = weight_scale
	_load.max_force_n = _settings().max_force
	_load.with_weight = render_weight and not _hold.detained  # What has snapped in is carried by its socket.
	_load.with_inertia = render_inertia and not _hold.detained
	var axes: Basis = spidar.global_basis.orthonormalized()
	_load.pull(_hold.body, _hold.where(grip), grip.origin, axes, spidar.workspace_scale)
	_requests.ask(_load.force_n, _load.moment_nm)


## Takes everything back from the device.
func _withdraw() -> void:
	_stop.remove()
	_contacts.replace([])
	_jaw.body = null
	_requests.withdraw()


func _prepare_finder() -> void:
	_finder.collision_mask = collision_mask
	_finder.gone_on = _stepped.gone_on()
	_finder.workspace_scale = spidar.workspace_scale
	_finder.margin_m = contact_margin_m * spidar.workspace_scale
	_finder.stiffness_n_m = contact_stiffness_n_m
	_finder.damping_n_s_m = contact_damping_n_s_m
	_finder.friction = contact_friction


func _space() -> PhysicsDirectSpaceState3D:
	return get_world_3d().direct_space_state


## Of the jaws as the device stands, scene metres.
func _gap_m() -> float:
	return maxf(spidar.get_jaw_gap() * spidar.workspace_scale, 0.0)


## The jaws as the pads show them: not closer than the body between them.
func _shown_gap_m() -> float:
	var between_m: float = _jaw.width_m if _jaw.body != null else 0.0
	return maxf(_gap_m(), _held_width_m if _hold != null else between_m)


func _settings() -> SpidarGConfig:
	return spidar.get_effective_config()
