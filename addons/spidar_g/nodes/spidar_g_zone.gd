@tool
@icon("../icons/spidar_g_zone.svg")
class_name SpidarGZone
extends Area3D
## A region of the scene in which the hand feels something: thick air, wind, a magnet, a buzz or notches.
##
## Give it one or more [CollisionShape3D] children, choose a [member kind], and set its strength. Every [SpidarG] of the same
## world feels it while the middle of its grip is inside of the shapes.
## [codeblock]
## SpidarGZone                (kind: Viscosity, viscosity: 6 N s/m)
## └─ CollisionShape3D        (a box, sphere, capsule, cylinder, convex polygon or world boundary)
## [/codeblock]
## The force is an effect of the servo loop ([method SpidarG.set_viscous_effect] and the like), renewed in each physics tick.
## It rises from nothing at the surface of the shapes to all of it [member edge_width] further in, and never changes by all of
## it in less than [member fade_time]. It ends within 0.2 s when the zone leaves the tree, is disabled or paused, or when the
## game hangs.
## [br][br]
## Inside is computed from the shapes, whatever [member Area3D.monitoring], [member Area3D.monitorable] and the collision layers
## are: switch monitoring and monitorable off unless something else needs them. Disabled shapes do not count. Lengths of the
## zone are scene metres; stiffness, viscosity and forces are those of the device, whatever
## [member SpidarG.workspace_scale] is.
## [br][br]
## A device takes 6 effects at once, of all zones and scripts together. A zone that finds none free warns, and tries again. A
## zone takes one effect, and a [constant MAGNET_AXIS] that is oblique to the axes of the device takes two. Zones use
## effect ids from [constant FIRST_ID] on, one each: use smaller ones, such as 0 to 999, for effects of your own.

## Emitted when the middle of the grip of [param spidar] has come inside.
signal hand_entered(spidar: SpidarG)
## Emitted when the middle of the grip of [param spidar] has gone outside, and for each hand that was inside when the zone is
## disabled or paused or leaves the scene tree, or when the device is closed.
signal hand_exited(spidar: SpidarG)

## What is felt in the zone.
enum Kind {
	## Thick air or honey: motion is resisted by [member viscosity], turns and the grasp by [member viscosity_angular] and
	## [member viscosity_grasp].
	VISCOSITY,
	## A constant force: [member wind_force].
	WIND,
	## A spring of [member stiffness] to the zone's origin.
	MAGNET_POINT,
	## A spring of [member stiffness] to the zone's local y axis. Motion along the axis is free. An axis that is not
	## parallel to one of the device's own is renewed by the game: its stiffness is at most 300 N/m.
	MAGNET_AXIS,
	## A buzz of [member vibration_force] and [member vibration_frequency].
	VIBRATION,
	## Notches every [member detent_spacing], along that axis of the device which is nearest to the zone's local x axis,
	## with a valley at the zone's origin.
	DETENTS,
}

const _Depth := preload("zone/zone_depth.gd")
const _Devices := preload("zone/devices_in_tree.gd")
const _Touch := preload("zone_touch.gd")
## Zones number their effects from here on; the game's own effects should have smaller ids.
const FIRST_ID: int = 1000000
## A hand that is inside is outside from this far out on (device m), so that a trembling one does not enter again and again.
const EXIT_M: float = 0.0005
## A force reaches the hand so many ticks after the pose that it was computed from, so it is computed for the place where the
## hand is then: late forces at an edge would drive a loosely held grip.
const LEAD_TICKS: float = 1.5
## A wind that changes by more than this along its edge (N per scene m) is warned about.
const STEEP_N_M: float = 100.0
## Properties that count for some kinds alone.
const OF_KIND: Dictionary[String, Array] = {
	"viscosity": [Kind.VISCOSITY],
	"viscosity_angular": [Kind.VISCOSITY],
	"viscosity_grasp": [Kind.VISCOSITY],
	"wind_force": [Kind.WIND],
	"stiffness": [Kind.MAGNET_POINT, Kind.MAGNET_AXIS],
	"vibration_force": [Kind.VIBRATION],
	"vibration_frequency": [Kind.VIBRATION],
	"detent_spacing": [Kind.DETENTS],
	"detent_force": [Kind.DETENTS],
}

static var _next_id: int = FIRST_ID

## What is felt in the zone.
@export var kind := Kind.VISCOSITY:
	set(value):
		if kind != value:
			_let_go()
		kind = value
		notify_property_list_changed()
		update_configuration_warnings()
## Whether anything is felt. Off, the zone costs nothing.
@export var enabled: bool = true:
	set(value):
		enabled = value
		_choose()
## The only [SpidarG] that feels the zone. Empty: every one of the same world does.
@export_node_path("SpidarG") var spidar_path: NodePath:
	set(value):
		spidar_path = value
		_choose()
		update_configuration_warnings()
## Resistance to motion, in N s/m of device motion. The device takes no more than it can give without trembling: see
## [method SpidarG.get_clamp_text]. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 20.0, 0.1, "or_greater", "suffix:N s/m") var viscosity: float = 4.0:
	set(value):
		viscosity = _checked("viscosity", value, viscosity, "N s/m")
## Resistance to turns. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 0.05, 0.0001, "or_greater", "suffix:N m s/rad") var viscosity_angular: float = 0.0:
	set(value):
		viscosity_angular = _checked("viscosity_angular", value, viscosity_angular, "N m s/rad")
## Resistance to opening and closing the grasp. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 0.02, 0.0001, "or_greater", "suffix:N m s/rad") var viscosity_grasp: float = 0.0:
	set(value):
		viscosity_grasp = _checked("viscosity_grasp", value, viscosity_grasp, "N m s/rad")
## The constant force of a wind (N), in the axes of the zone. A force that is not finite is refused with an error, and the old
## one stays.
@export var wind_force := Vector3(1.0, 0.0, 0.0):
	set(value):
		wind_force = _checked_force("wind_force", value, wind_force)
		update_configuration_warnings()
## Stiffness of a magnet, in newtons per metre of device motion. The device takes no more than
## [method SpidarG.get_stiffness_limits]. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 500.0, 1.0, "or_greater", "suffix:N/m") var stiffness: float = 120.0:
	set(value):
		stiffness = _checked("stiffness", value, stiffness, "N/m")
## Amplitude of a vibration and its direction (N), in the axes of the zone. The device gives at most 2 N. A force that is not
## finite is refused with an error, and the old one stays.
@export var vibration_force := Vector3(0.0, 0.8, 0.0):
	set(value):
		vibration_force = _checked_force("vibration_force", value, vibration_force)
## Frequency of a vibration, 5 to 250 Hz. A value outside of that is refused with an error, and the old one stays. The device
## gives at most a quarter of its servo rate.
@export_range(5.0, 250.0, 0.1, "suffix:Hz") var vibration_frequency: float = 80.0:
	set(value):
		vibration_frequency = _checked("vibration_frequency", value, vibration_frequency, "Hz", 5.0, 250.0)
## Distance of a notch to the next, in scene metres; at least 1 mm of the device. A smaller value is refused with an error, and
## the old one stays.
@export_range(0.001, 0.1, 0.0005, "or_greater", "suffix:m") var detent_spacing: float = 0.01:
	set(value):
		detent_spacing = _checked("detent_spacing", value, detent_spacing, "m", 0.001)
## Largest force on the way out of a notch. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 5.0, 0.05, "or_greater", "suffix:N") var detent_force: float = 1.2:
	set(value):
		detent_force = _checked("detent_force", value, detent_force, "N")
## No steady force of the zone is larger. Where a magnet or the viscosity would pull harder, its gain is lowered in each physics
## tick, so a jerk of the hand may feel up to a third more for one or two ticks. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 10.0, 0.05, "or_greater", "suffix:N") var max_force: float = 3.0:
	set(value):
		max_force = _checked("max_force", value, max_force, "N")
		update_configuration_warnings()
## Least time in which the force of the zone rises from nothing to all of it, or falls back. A value below 0.016 s or an infinite
## one is refused with an error, and the old one stays.
@export_range(0.016, 1.0, 0.001, "or_greater", "suffix:s") var fade_time: float = 0.05:
	set(value):
		fade_time = _checked("fade_time", value, fade_time, "s", 0.016)
## How far below the surface of the shapes the zone has its full force (scene m); up to there the force rises with the depth. A
## zone that is thinner than twice that never has it. A strong wind needs a wide edge, 1 N at most for each 10 mm: in a
## narrower one a loosely held grip may swing at the surface. A negative or infinite value is refused with an error, and the
## old one stays.
@export_range(0.0, 0.1, 0.001, "or_greater", "suffix:m") var edge_width: float = 0.02:
	set(value):
		edge_width = _checked("edge_width", value, edge_width, "m")
		update_configuration_warnings()

var _id: int = 0
var _depth := _Depth.new()
var _devices: _Devices = null
var _touches: Dictionary[SpidarG, _Touch] = {}


## Returns the id of the zone's effects, for [method SpidarG.clear_effect]; 0 before the zone was in a running tree.
func get_effect_id() -> int:
	return _id


## Returns [code]true[/code] while the middle of the grip of [param spidar] is inside.
func is_hand_inside(spidar: SpidarG) -> bool:
	return _touches.has(spidar) and _touches[spidar].is_inside


## Returns which part of the zone's force [param spidar] is given, from 0 outside to 1 deep inside.
func get_strength(spidar: SpidarG) -> float:
	return _touches[spidar].strength if _touches.has(spidar) else 0.0


## Returns how deep a point of the world is inside of the zone's shapes, in scene metres: negative outside, and -INF where the
## zone has no shape that counts.
func get_depth(point: Vector3) -> float:
	return _depth.of(self, point)


func _enter_tree() -> void:
	if Engine.is_editor_hint():
		child_order_changed.connect(update_configuration_warnings)
		return
	if not ClassDB.class_exists(&"SpidarG"):
		return
	if _id == 0:
		_id = _next_id
		_next_id += 1
	_devices = _Devices.of(get_tree())
	_devices.changed.connect(_choose)
	if is_node_ready():
		_choose()


# The engine turns processing on just before.
func _ready() -> void:
	_choose()


func _exit_tree() -> void:
	_let_go()
	if Engine.is_editor_hint():
		child_order_changed.disconnect(update_configuration_warnings)
	if _devices != null:
		_devices.changed.disconnect(_choose)
		_devices = null


func _notification(what: int) -> void:
	if what == NOTIFICATION_PAUSED or what == NOTIFICATION_DISABLED:
		_let_go()


func _validate_property(property: Dictionary) -> void:
	var field: String = property["name"]
	if OF_KIND.has(field) and not OF_KIND[field].has(kind):
		property["usage"] = PROPERTY_USAGE_NO_EDITOR


func _get_configuration_warnings() -> PackedStringArray:
	var warnings: PackedStringArray = []
	for owner: int in get_shape_owners():
		for index: int in shape_owner_get_shape_count(owner):
			var problem: String = _Depth.problem(shape_owner_get_shape(owner, index))
			if not problem.is_empty():
				warnings.append("A shape of the SpidarGZone is left out, because %s. Use boxes, spheres, capsules, cylinders or small convex polygons." % problem)
	var steepness: float = minf(wind_force.length(), max_force) / maxf(edge_width, 1e-6)
	if kind == Kind.WIND and steepness > STEEP_N_M:
		warnings.append("The wind of the SpidarGZone rises by %.0f N/m along its edge: a loosely held grip may swing there. Make edge_width %.3f m or more, or the wind weaker."
			% [steepness, minf(wind_force.length(), max_force) / STEEP_N_M])
	if not spidar_path.is_empty() and not get_node_or_null(spidar_path) is SpidarG:
		warnings.append("Nobody feels the SpidarGZone: spidar_path \"%s\" leads to no SpidarG. Choose one, or clear the path." % spidar_path)
	return warnings


func _physics_process(_delta: float) -> void:
	var tick_s: float = 1.0 / Engine.physics_ticks_per_second
	for spidar: SpidarG in _devices.devices.duplicate():
		if _may_feel(spidar):
			_follow(spidar, tick_s)
	for spidar: SpidarG in _touches.keys():
		if not _may_feel(spidar):
			_drop(spidar)


# Runs only where somebody can feel the zone.
func _choose() -> void:
	if not is_inside_tree():
		return
	# Devices that leave the tree are let go while they still exist.
	for spidar: SpidarG in _touches.keys():
		if _devices == null or not _devices.devices.has(spidar):
			_drop(spidar)
	var acts: bool = enabled and _devices != null and not _devices.devices.is_empty()
	if not acts:
		_let_go()
	set_physics_process(acts)


func _may_feel(spidar: SpidarG) -> bool:
	if spidar.get_state() == SpidarG.STATE_CLOSED or spidar.get_world_3d() != get_world_3d():
		return false
	return spidar_path.is_empty() or get_node_or_null(spidar_path) == spidar


func _follow(spidar: SpidarG, tick_s: float) -> void:
	var depth: float = _depth.of(self, spidar.get_grip_transform().origin)
	var touch: _Touch = _touches.get(spidar)
	if touch == null:
		if not depth > 0.0:
			return
		touch = _Touch.new(spidar, _id)
		_touches[spidar] = touch
	var was_inside: bool = touch.is_inside
	touch.is_inside = depth > (-EXIT_M * spidar.workspace_scale if was_inside else 0.0)
	var ahead: Vector3 = spidar.get_grip_transform().origin + spidar.get_linear_velocity() * (LEAD_TICKS * tick_s)
	touch.strength = move_toward(touch.strength, _share(_depth.of(self, ahead)), tick_s / fade_time)
	if touch.strength > 0.0 or touch.is_inside:
		if not touch.renew(self, tick_s):
			push_warning("SpidarGZone \"%s\" is not felt: 6 effects act on \"%s\" already, of other zones or scripts. End one, or let zones overlap less." % [name, spidar.name])
	else:
		touch.stop()
		_touches.erase(spidar)
	if touch.is_inside != was_inside:
		(hand_entered if touch.is_inside else hand_exited).emit(spidar)


# The part of the force that belongs to a depth.
func _share(depth: float) -> float:
	if depth <= 0.0:
		return 0.0
	return minf(1.0, depth / edge_width) if edge_width > 0.0 else 1.0


func _let_go() -> void:
	for spidar: SpidarG in _touches.keys():
		_drop(spidar)


func _drop(spidar: SpidarG) -> void:
	var touch: _Touch = _touches[spidar]
	var was_inside: bool = touch.is_inside
	touch.stop()
	_touches.erase(spidar)
	if was_inside and is_instance_valid(spidar):
		hand_exited.emit(spidar)


static func _checked(
	field: String, value: float, old: float, unit: String, least: float = 0.0, most: float = INF
) -> float:
	if is_finite(value) and value >= least and value <= most:
		return value
	var range: String = "%s to %s" % [least, most] if is_finite(most) else "a finite number from %s on" % least
	push_error("SpidarGZone.%s = %s %s: give %s; the old value stays." % [field, value, unit, range])
	return old


static func _checked_force(field: String, value: Vector3, old: Vector3) -> Vector3:
	if value.is_finite():
		return value
	push_error("SpidarGZone.%s = %s N: give finite numbers; the old value stays." % [field, value])
	return old
