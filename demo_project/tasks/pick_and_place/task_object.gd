class_name TaskObject
extends RigidBody3D
## A thing to pick up, and its story in this trial.

## This object struck another one.
signal struck(other: TaskObject)

const FRICTION := 0.8
## Slows a rolling ball so that it comes to rest.
const ANGULAR_DAMP_1_S := 2.0
const HELD_ALPHA := 0.62

var spec: ObjectSpec
var start := Transform3D.IDENTITY
var target: TargetOutline
var attempts := 0
var placed := false

var _material := StandardMaterial3D.new()


func setup(spec_: ObjectSpec, start_: Transform3D, target_: TargetOutline) -> void:
	spec = spec_
	start = start_
	target = target_
	name = spec.label.to_pascal_case()
	mass = spec.mass_kg
	angular_damp = ANGULAR_DAMP_1_S
	physics_material_override = PhysicsMaterial.new()
	physics_material_override.friction = FRICTION
	contact_monitor = true
	max_contacts_reported = 4
	var collision := CollisionShape3D.new()
	collision.shape = spec.collision_shape()
	add_child(collision)
	var instance := MeshInstance3D.new()
	instance.mesh = spec.mesh()
	_material.albedo_color = spec.colour
	_material.roughness = 0.55
	instance.material_override = _material
	add_child(instance)
	body_entered.connect(_on_body_entered)
	transform = start


## Held things are shown as glass, so that the grip's poles stay in sight inside them.
func show_held(held: bool) -> void:
	_material.transparency = (
		BaseMaterial3D.TRANSPARENCY_ALPHA if held else BaseMaterial3D.TRANSPARENCY_DISABLED
	)
	_material.albedo_color.a = HELD_ALPHA if held else 1.0


func position_error_m() -> float:
	return global_position.distance_to(target.goal().origin)


func rotation_error_rad() -> float:
	return PlacementJudge.rotation_error_rad(spec, global_basis, target.goal().basis)


func _on_body_entered(other: Node) -> void:
	if other is TaskObject:
		struck.emit(other as TaskObject)
