@tool
extends Node3D
## A block of air in which the device gives one kind of force by itself, renewed while the grip's middle is inside.

const DemoPalette := preload("res://scene/demo_palette.gd")

## From left to right: where strings give the finest forces, in the middle, is what is felt in motion.
enum Kind { VIBRATION, SPRING, VISCOUS, DETENTS, FORCE, WRENCH }

const SIZE_M := Vector3(0.044, 0.050, 0.040)
## Effects last so long beyond the frame that asked for them.
const RENEWED_FOR_S := 0.1
const VISCOUS_N_S_M := 2.0
const VISCOUS_NM_S_RAD := 0.01
const VIBRATION_N := 0.8
const VIBRATION_HZ := 80.0
const DETENT_SPACING_M := 0.010
const DETENT_N := 1.2
const SPRING_N_M := 120.0
const FORCE_N := Vector3(1.0, 0.0, 0.0)
const WRENCH_N := Vector3(0.0, 1.5, 0.0)
const TRANSLATION_DOF := 0b111
const X_DOF := 0b001
const ALPHA := 0.16
const ALPHA_INSIDE := 0.40

## In the order of Kind.
const TEXTS: PackedStringArray = ["buzz", "spring", "thick air", "notches", "wind", "lift"]

@export var kind := Kind.VISCOUS
@export var colour := Color.WHITE:
	set(value):
		colour = value
		_show()

var _material: StandardMaterial3D


func _ready() -> void:
	_show()


func holds(point: Vector3) -> bool:
	return AABB(-0.5 * SIZE_M, SIZE_M).has_point(to_local(point))


## Once a physics frame: asks for the force while the grip is inside. A wrench is the tool's own way to give weight, so it is
## left out while something is held.
func act(spidar: SpidarG, holding: bool) -> void:
	var inside := holds(spidar.get_grip_transform().origin)
	_material.albedo_color.a = ALPHA_INSIDE if inside else ALPHA
	if not inside:
		return
	var centre := Transform3D(Basis.IDENTITY, global_position)
	match kind:
		Kind.VISCOUS:
			spidar.set_viscous_effect(kind, VISCOUS_N_S_M, VISCOUS_NM_S_RAD, 0.0, 0x3f, RENEWED_FOR_S)
		Kind.VIBRATION:
			spidar.set_vibration_effect(
				kind, Vector3.UP * VIBRATION_N, Vector3.ZERO, 0.0, VIBRATION_HZ, RENEWED_FOR_S
			)
		Kind.DETENTS:
			spidar.set_detent_effect(kind, centre, 0.0, DETENT_SPACING_M, DETENT_N, X_DOF, RENEWED_FOR_S)
		Kind.SPRING:
			spidar.set_spring_effect(kind, centre, 0.0, SPRING_N_M, 0.0, 0.0, TRANSLATION_DOF, RENEWED_FOR_S)
		Kind.FORCE:
			spidar.set_force_effect(kind, FORCE_N, Vector3.ZERO, 0.0, RENEWED_FOR_S)
		Kind.WRENCH when not holding:
			spidar.request_wrench(WRENCH_N, Vector3.ZERO, 0.0)


## Does nothing while the scene is still being put together.
func _show() -> void:
	var block := get_node_or_null(^"Block") as MeshInstance3D
	if block == null:
		return
	_material = DemoPalette.flat(Color(colour, ALPHA))
	var mesh := BoxMesh.new()
	mesh.size = SIZE_M
	mesh.material = _material
	block.mesh = mesh
