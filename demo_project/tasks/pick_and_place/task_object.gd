@tool
extends "res://scene/task_body.gd"
## A thing of pick and place, with the outline where it belongs. Its size, mass, friction and softness are in its scene.

const Stand := preload("res://scene/stand.gd")
const TargetOutline := preload("res://tasks/pick_and_place/target_outline.gd")

## Fingers reach this far below the top of a thing that stands on the table.
const FINGER_DEPTH_M := 0.016

## What it stands on, at its start and at its target; empty: the table.
@export var stand: PackedScene

var target: TargetOutline


func setup(start_: Transform3D, target_: TargetOutline) -> void:
	target = target_
	start = start_
	transform = start
	# Tall things are held near the top: the hand stays clear of the table, and they hang upright.
	if stand == null:
		grasp_offset_m = Vector3.UP * (size_m().y * 0.5 - FINGER_DEPTH_M)


## A new one of its own; null where it needs none.
func make_stand() -> Stand:
	return null if stand == null else stand.instantiate() as Stand


## Height of its middle above the table when at rest.
func rest_height_m() -> float:
	var carrier := make_stand()
	if carrier == null:
		return size_m().y * 0.5
	var height := carrier.rest_height_m(size_m())
	carrier.free()
	return height


## Half of what it covers of the table.
func footprint_m() -> Vector2:
	var carrier := make_stand()
	if carrier == null:
		return Vector2(size_m().x, size_m().z) * 0.5
	var footprint := carrier.footprint_m(size_m())
	carrier.free()
	return footprint


func mesh() -> Mesh:
	return ($Mesh as MeshInstance3D).mesh


func colour() -> Color:
	return (($Mesh as MeshInstance3D).material_override as StandardMaterial3D).albedo_color


func goal() -> Transform3D:
	return target.goal()


func show_placed(placed_: bool) -> void:
	target.show_placed(placed_)


func rotation_error_rad() -> float:
	return turn_as_shown(global_basis, goal().basis)


## Angle between two orientations as far as the shape can show it.
func turn_as_shown(actual: Basis, wanted: Basis) -> float:
	var shape := ($Shape as CollisionShape3D).shape
	if shape is SphereShape3D:
		return 0.0
	if shape is CylinderShape3D:
		var tilt := actual.y.normalized().angle_to(wanted.y.normalized())
		return minf(tilt, PI - tilt)
	# A box looks the same after half a turn about its height; a square one after a quarter.
	var size := size_m()
	var turn := PI * 0.5 if is_equal_approx(size.x, size.z) else PI
	var best := TAU
	for step in roundi(TAU / turn):
		best = minf(best, turn_between(actual.orthonormalized() * Basis(Vector3.UP, turn * step), wanted))
	return best
