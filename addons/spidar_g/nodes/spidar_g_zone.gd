@tool
@icon("../icons/spidar_g_zone.svg")
class_name SpidarGZone
extends Area3D
## A region of the scene in which the hand feels something: thick air, wind, a magnet, a vibration or detents.
##
## Add one or more [CollisionShape3D] nodes as children, choose a [member kind], and set its strength. Every [SpidarG] of the
## same world (or the one at [member spidar_path]) feels the zone while the center of its grip is inside the shapes. A shape
## is a box, a sphere, a capsule, a cylinder, a convex polygon of at most 128 points or a world boundary.
## [codeblock]
## # Honey, in a ball of 10 cm around the device.
## var shape := SphereShape3D.new()
## shape.radius = 0.05
## var collision := CollisionShape3D.new()
## collision.shape = shape
## var zone := SpidarGZone.new()
## zone.kind = SpidarGZone.Kind.VISCOSITY
## zone.viscosity = 5.0
## zone.add_child(collision)
## add_child(zone)
## [/codeblock]
## The force is an effect of the servo loop, such as [method SpidarG.set_viscous_effect], and is refreshed in each physics
## tick. The force rises from 0 at the surface of the shapes to its full value [member edge_width] below the surface, and a
## change from 0 to the full value takes at least [member fade_time]. The force ends within 0.2 s if the zone leaves the tree,
## is disabled or paused, or if the game hangs.
## [br][br]
## Whether a point is inside is computed from the shapes, independent of [member Area3D.monitoring],
## [member Area3D.monitorable] and the collision layers: switch monitoring and monitorable off unless something else needs
## them. Disabled shapes are ignored. Lengths of the zone are in meters of the scene. Stiffness and viscosity are stated per
## meter of device motion, and forces are those of the device, for any [member SpidarG.workspace_scale].
## [br][br]
## A device renders 6 effects at once, of all zones and scripts together. If none is free, the zone warns and tries again. A
## zone uses one effect, and a [constant MAGNET_AXIS] that is oblique to the axes of the device uses two. Each zone has an
## effect id of its own, from [constant FIRST_ID] on: use smaller ids for effects of your own, such as 0 to 999.

## Emitted when the center of the grip of [param spidar] has entered the zone.
signal hand_entered(spidar: SpidarG)
## Emitted when the center of the grip of [param spidar] has left the zone. Also emitted for each device inside if the zone is
## disabled or paused, leaves the scene tree or gets another [member kind], and if the device closes or leaves the scene tree.
signal hand_exited(spidar: SpidarG)

## Selects what the hand feels in the zone.
enum Kind {
	## The zone resists motion like thick air or honey, by [member viscosity], [member viscosity_angular] and
	## [member viscosity_grasp].
	VISCOSITY,
	## The zone gives a constant force, [member wind_force].
	WIND,
	## The zone pulls the grip to its origin like a spring with [member stiffness].
	MAGNET_POINT,
	## The zone pulls the grip to its local y axis like a spring with [member stiffness]. Motion along the axis is free. If
	## the axis is not parallel to an axis of the device, the game computes a part of the force, and the stiffness is clamped
	## to 300 N/m.
	MAGNET_AXIS,
	## The zone vibrates with [member vibration_force] and [member vibration_frequency].
	VIBRATION,
	## The zone has a detent every [member detent_spacing], along the axis of the device that is nearest to the local x axis
	## of the zone. One detent is at the zone's origin.
	DETENTS,
}

const _Depth := preload("zone/zone_depth.gd")
const _Devices := preload("zone/devices_in_tree.gd")
const _Touch := preload("zone_touch.gd")
## The smallest effect id that zones use. Use smaller ids for effects of your own.
const FIRST_ID: int = 1000000
## A grip that was inside counts as outside from this distance from the shapes on, in meters of device motion. A trembling
## hand at the surface therefore does not enter again and again.
const EXIT_M: float = 0.0005
## A requested force reaches the hand about this many physics ticks later. The strength of the zone is therefore computed for
## the position that the grip will have then. At an edge, a force that comes late would make a loosely held grip swing.
const LEAD_TICKS: float = 1.5
## A wind that rises by more than this across the edge of its zone, in newtons per meter of the scene, causes a configuration
## warning.
const STEEP_N_M: float = 100.0
## Maps each property that only some kinds use to these kinds. The inspector hides the property for all other kinds.
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

## Selects what the hand feels in the zone. The inspector shows the properties of this kind only.
@export var kind := Kind.VISCOSITY:
	set(value):
		if kind != value:
			_let_go()
		kind = value
		notify_property_list_changed()
		update_configuration_warnings()
## If [code]true[/code], the zone is felt. If [code]false[/code], it is not felt and takes no time.
@export var enabled: bool = true:
	set(value):
		enabled = value
		_choose()
## Sets the only [SpidarG] that feels the zone. With an empty path every [SpidarG] of the same world feels it.
@export_node_path("SpidarG") var spidar_path: NodePath:
	set(value):
		spidar_path = value
		_choose()
		update_configuration_warnings()
## Sets the resistance to translation, in newton seconds per meter of device motion. The device clamps it to 5 N s/m: see
## [method SpidarG.get_clamp_text]. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 20.0, 0.1, "or_greater", "suffix:N s/m") var viscosity: float = 4.0:
	set(value):
		viscosity = _checked("viscosity", value, viscosity, "N s/m")
## Sets the resistance to rotation, in N m s/rad. The device clamps it to 0.01 N m s/rad. A negative or infinite value is
## refused with an error, and the old one stays.
@export_range(0.0, 0.05, 0.0001, "or_greater", "suffix:N m s/rad") var viscosity_angular: float = 0.0:
	set(value):
		viscosity_angular = _checked("viscosity_angular", value, viscosity_angular, "N m s/rad")
## Sets the resistance to opening and closing the grasp, in N m s/rad. The device clamps it to 0.003 N m s/rad. A negative or
## infinite value is refused with an error, and the old one stays.
@export_range(0.0, 0.02, 0.0001, "or_greater", "suffix:N m s/rad") var viscosity_grasp: float = 0.0:
	set(value):
		viscosity_grasp = _checked("viscosity_grasp", value, viscosity_grasp, "N m s/rad")
## Sets the constant force of a wind, in newtons, in the axes of the zone. It is clamped to [member max_force]. A force that
## is not finite is refused with an error, and the old one stays.
@export_custom(PROPERTY_HINT_NONE, "suffix:N") var wind_force := Vector3(1.0, 0.0, 0.0):
	set(value):
		wind_force = _checked_force("wind_force", value, wind_force)
		update_configuration_warnings()
## Sets the stiffness of a magnet, in newtons per meter of device motion. It is clamped to
## [method SpidarG.get_stiffness_limits]. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 500.0, 1.0, "or_greater", "suffix:N/m") var stiffness: float = 120.0:
	set(value):
		stiffness = _checked("stiffness", value, stiffness, "N/m")
## Sets the amplitude and direction of a vibration, in newtons, in the axes of the zone. It is clamped to [member max_force],
## and along each axis of the device to 2 N. A force that is not finite is refused with an error, and the old one stays.
@export_custom(PROPERTY_HINT_NONE, "suffix:N") var vibration_force := Vector3(0.0, 0.8, 0.0):
	set(value):
		vibration_force = _checked_force("vibration_force", value, vibration_force)
## Sets the frequency of a vibration, from 5 to 250 Hz. A frequency above a quarter of the servo rate is lowered to it. A
## value outside 5 to 250 Hz is refused with an error, and the old one stays.
@export_range(5.0, 250.0, 0.1, "suffix:Hz") var vibration_frequency: float = 80.0:
	set(value):
		vibration_frequency = _checked("vibration_frequency", value, vibration_frequency, "Hz", 5.0, 250.0)
## Sets the distance between two detents, in meters of the scene. It must also be at least 1 mm of device motion: see
## [member SpidarG.workspace_scale]. A value below 0.001 is refused with an error, and the old one stays.
@export_range(0.001, 0.1, 0.0005, "or_greater", "suffix:m") var detent_spacing: float = 0.01:
	set(value):
		detent_spacing = _checked("detent_spacing", value, detent_spacing, "m", 0.001)
## Sets the largest force on the way out of a detent, in newtons. It is clamped to [member max_force]. A negative or infinite
## value is refused with an error, and the old one stays.
@export_range(0.0, 5.0, 0.05, "or_greater", "suffix:N") var detent_force: float = 1.2:
	set(value):
		detent_force = _checked("detent_force", value, detent_force, "N")
## Sets the largest steady force of the zone, in newtons. Moments are not limited by it. In each physics tick the zone lowers
## the stiffness of a magnet or the viscosity if the force would be larger. A fast motion can therefore cause up to a third
## more for one or two ticks. A negative or infinite value is refused with an error, and the old one stays.
@export_range(0.0, 10.0, 0.05, "or_greater", "suffix:N") var max_force: float = 3.0:
	set(value):
		max_force = _checked("max_force", value, max_force, "N")
		update_configuration_warnings()
## Sets the minimum time in which the force of the zone rises from 0 to its full value, or falls back, in seconds. A value
## below 0.016 s or an infinite one is refused with an error, and the old one stays.
@export_range(0.016, 1.0, 0.001, "or_greater", "suffix:s") var fade_time: float = 0.05:
	set(value):
		fade_time = _checked("fade_time", value, fade_time, "s", 0.016)
## Sets the depth below the surface of the shapes at which the force has its full value, in meters of the scene. A zone that
## is thinner than twice this depth never has its full force. A strong wind needs a wide edge, at least 10 mm for each newton;
## with a narrower one a loosely held grip can swing at the surface. A negative or infinite value is refused with an error,
## and the old one stays.
@export_range(0.0, 0.1, 0.001, "or_greater", "suffix:m") var edge_width: float = 0.02:
	set(value):
		edge_width = _checked("edge_width", value, edge_width, "m")
		update_configuration_warnings()

var _id: int = 0
var _depth := _Depth.new()
var _devices: _Devices = null
var _touches: Dictionary[SpidarG, _Touch] = {}


## Returns the id of the effects of this zone, for [method SpidarG.clear_effect]. Returns 0 before the zone has entered a
## running scene tree.
func get_effect_id() -> int:
	return _id


## Returns [code]true[/code] while the center of the grip of [param spidar] is inside the zone.
func is_hand_inside(spidar: SpidarG) -> bool:
	return _touches.has(spidar) and _touches[spidar].is_inside


## Returns the share of the zone's force that acts on [param spidar], from 0 outside to 1 deep inside.
func get_strength(spidar: SpidarG) -> float:
	return _touches[spidar].strength if _touches.has(spidar) else 0.0


## Returns how deep [param point], in world coordinates, is inside the shapes of the zone, in meters of the scene. The depth
## is negative outside. Returns -INF if the zone has no usable shape.
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
				warnings.append("A shape of the SpidarGZone is ignored, because %s. Use boxes, spheres, capsules, cylinders or small convex polygons." % problem)
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


# Turns processing on only if a device can feel the zone.
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


# Returns the share of the force at this depth, from 0 to 1.
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
