class_name TaskObject
extends RigidBody3D
## A thing to pick up, and its story in this trial.

const FRICTION := 0.6
## Slows a rolling ball so that it comes to rest.
const ANGULAR_DAMP_1_S := 2.0

var spec: ObjectSpec
var start := Transform3D.IDENTITY
var target: TargetOutline
var attempts := 0
var placed := false
## This object struck another one.
signal struck(other: TaskObject)


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
	var material := StandardMaterial3D.new()
	material.albedo_color = spec.colour
	material.roughness = 0.55
	material.rim_enabled = true
	material.rim = 0.25
	instance.material_override = material
	add_child(instance)
	body_entered.connect(_on_body_entered)
	transform = start


func position_error_m() -> float:
	return global_position.distance_to(target.goal().origin)


func rotation_error_rad() -> float:
	return PlacementJudge.rotation_error_rad(spec, global_basis, target.goal().basis)


func _on_body_entered(other: Node) -> void:
	if other is TaskObject:
		struck.emit(other as TaskObject)
