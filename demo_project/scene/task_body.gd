@tool
extends RigidBody3D
## A thing of a task that is picked up and belongs somewhere, and its story in this trial.

const FeltRecord := preload("res://scene/felt_record.gd")
const TaskBody := preload("res://scene/task_body.gd")

## This body struck another one.
signal struck(other: TaskBody)

const HELD_ALPHA := 0.62
## At rest: slower than this.
const REST_SPEED_M_S := 0.02

## In the results.
@export var label := ""
@export var kind := ""
## Where the middle of the fingers goes, in the body's frame.
@export var grasp_offset_m := Vector3.ZERO
## From where the fingers come and whereto they leave, beside the height, in the grip's frame.
@export var approach_m := Vector3.ZERO
## Height over the table at which it is carried.
@export var travel_m := 0.130

## Between the fingers, along the body's x axis.
var width_m: float:
	get:
		return _width_m()
var start := Transform3D.IDENTITY
var felt := FeltRecord.new()
var attempts := 0
var placed := false
var position_tolerance_m := 0.008
var rotation_tolerance_rad := deg_to_rad(10.0)

## Copies of what the scene says, so that only this body turns to glass.
var _materials: Array[StandardMaterial3D] = []


func _ready() -> void:
	if squeeze_stiffness() > 0.0:
		felt.width_tolerance_m = FeltRecord.WIDTH_TOLERANCE_SOFT_M
	body_entered.connect(_on_body_entered)


## How soft it is between the fingers, N m/rad; 0: as hard as the device can render.
func squeeze_stiffness() -> float:
	var surface := get_node_or_null(^"Surface") as SpidarGSurface
	return surface.material.squeeze_stiffness if surface != null else 0.0


## Of the node Shape: width, height and depth of a box, a cylinder or a ball.
func size_m() -> Vector3:
	var shape := ($Shape as CollisionShape3D).shape
	if shape is CylinderShape3D:
		var cylinder := shape as CylinderShape3D
		return Vector3(2.0 * cylinder.radius, cylinder.height, 2.0 * cylinder.radius)
	if shape is SphereShape3D:
		return Vector3.ONE * 2.0 * (shape as SphereShape3D).radius
	return (shape as BoxShape3D).size


func _width_m() -> float:
	return size_m().x


## Whether it looks the same at any turn about its height.
func is_round() -> bool:
	return not ($Shape as CollisionShape3D).shape is BoxShape3D


## World pose of the body where it belongs.
func goal() -> Transform3D:
	return start


## In place, at rest and let go: geometry alone.
func is_placed(held: RigidBody3D) -> bool:
	return (
		self != held
		and linear_velocity.length() < REST_SPEED_M_S
		and position_error_m() <= position_tolerance_m
		and rotation_error_rad() <= rotation_tolerance_rad
	)


func show_placed(_placed: bool) -> void:
	pass


## Held things are shown as glass, so that the grip's poles stay in sight inside them.
func show_held(held: bool) -> void:
	if _materials.is_empty():
		_copy_materials()
	for material in _materials:
		material.transparency = (
			BaseMaterial3D.TRANSPARENCY_ALPHA if held else BaseMaterial3D.TRANSPARENCY_DISABLED
		)
		material.albedo_color.a = HELD_ALPHA if held else 1.0


func _copy_materials() -> void:
	for child in get_children():
		var piece := child as MeshInstance3D
		if piece != null and piece.material_override is StandardMaterial3D:
			piece.material_override = piece.material_override.duplicate()
			_materials.append(piece.material_override as StandardMaterial3D)


func position_error_m() -> float:
	return global_position.distance_to(goal().origin)


func rotation_error_rad() -> float:
	return turn_between(global_basis, goal().basis)


static func turn_between(one: Basis, other: Basis) -> float:
	return (one.orthonormalized().inverse() * other).get_rotation_quaternion().get_angle()


func _on_body_entered(other: Node) -> void:
	if other is TaskBody:
		struck.emit(other as TaskBody)
