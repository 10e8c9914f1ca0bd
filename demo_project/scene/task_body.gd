extends RigidBody3D
## A thing of a task that is picked up and belongs somewhere, and its story in this trial.

const FeltRecord := preload("res://scene/felt_record.gd")
const TaskBody := preload("res://scene/task_body.gd")

## This body struck another one.
signal struck(other: TaskBody)

const DEFAULT_FRICTION := 0.8
## Slows a rolling ball so that it comes to rest.
const ANGULAR_DAMP_1_S := 2.0
const HELD_ALPHA := 0.62
## At rest: slower than this.
const REST_SPEED_M_S := 0.02

var label := ""
var kind := ""
## Between the fingers, along the body's x axis.
var width_m := 0.0
## Where the middle of the fingers goes, in the body's frame.
var grasp_offset_m := Vector3.ZERO
## From where the fingers come and whereto they leave, beside the height, in the grip's frame.
var approach_m := Vector3.ZERO
## Height over the table at which it is carried.
var travel_m := 0.130
## Looks the same at any turn about its height.
var is_round := false
var start := Transform3D.IDENTITY
var felt := FeltRecord.new()
var attempts := 0
var placed := false
var position_tolerance_m := 0.008
var rotation_tolerance_rad := deg_to_rad(10.0)

var _materials: Array[StandardMaterial3D] = []


func _init() -> void:
	angular_damp = ANGULAR_DAMP_1_S
	physics_material_override = PhysicsMaterial.new()
	physics_material_override.friction = DEFAULT_FRICTION
	contact_monitor = true
	max_contacts_reported = 4
	body_entered.connect(_on_body_entered)


## Adds a solid piece; a null mesh is not seen, a null shape is not felt.
func add_piece(shape: Shape3D, mesh: Mesh, at: Transform3D, colour: Color) -> void:
	if shape != null:
		var collision := CollisionShape3D.new()
		collision.shape = shape
		collision.transform = at
		add_child(collision)
	if mesh == null:
		return
	var instance := MeshInstance3D.new()
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.roughness = 0.55
	instance.mesh = mesh
	instance.material_override = material
	instance.transform = at
	_materials.append(material)
	add_child(instance)


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
	for material in _materials:
		material.transparency = (
			BaseMaterial3D.TRANSPARENCY_ALPHA if held else BaseMaterial3D.TRANSPARENCY_DISABLED
		)
		material.albedo_color.a = HELD_ALPHA if held else 1.0


func position_error_m() -> float:
	return global_position.distance_to(goal().origin)


func rotation_error_rad() -> float:
	return turn_between(global_basis, goal().basis)


static func turn_between(one: Basis, other: Basis) -> float:
	return (one.orthonormalized().inverse() * other).get_rotation_quaternion().get_angle()


func _on_body_entered(other: Node) -> void:
	if other is TaskBody:
		struck.emit(other as TaskBody)
