@tool
extends Node3D
## A block of air in which the device gives one kind of force by itself while the grip's middle is inside. All kinds but the
## raw wrench are those of its SpidarGZone.

const DemoPalette := preload("res://scene/demo_palette.gd")

## From left to right: where strings give the finest forces, in the middle, is what is felt in motion.
enum Kind { VIBRATION, SPRING, VISCOUS, DETENTS, FORCE, WRENCH }

const SIZE_M := Vector3(0.044, 0.050, 0.040)
## The blocks are small: their forces begin close below the surface. That of the wind, which is there in a still hand too, needs
## a wider edge to leave a hand at the surface in peace.
const EDGE_M := 0.004
const WIND_EDGE_M := 0.012
const VISCOUS_N_S_M := 2.0
const VISCOUS_NM_S_RAD := 0.01
const VIBRATION_N := 0.8
const VIBRATION_HZ := 80.0
const DETENT_SPACING_M := 0.010
const DETENT_N := 1.2
const SPRING_N_M := 120.0
const FORCE_N := Vector3(1.0, 0.0, 0.0)
const WRENCH_N := Vector3(0.0, 1.5, 0.0)
const ALPHA := 0.16
const ALPHA_INSIDE := 0.40

@export var kind := Kind.VISCOUS
@export var colour := Color.WHITE:
	set(value):
		colour = value
		_show()

var _material: StandardMaterial3D


func _ready() -> void:
	_show()
	_set_up_zone(get_node(^"Zone") as SpidarGZone)


func holds(point: Vector3) -> bool:
	return AABB(-0.5 * SIZE_M, SIZE_M).has_point(to_local(point))


## Once a physics frame: shows whether the grip is inside, and asks for the wrench, which is no effect. A wrench is the tool's own
## way to give weight, so it is left out while something is held.
func act(spidar: SpidarG, holding: bool) -> void:
	var inside := holds(spidar.get_grip_transform().origin)
	_material.albedo_color.a = ALPHA_INSIDE if inside else ALPHA
	if inside and kind == Kind.WRENCH and not holding:
		spidar.request_wrench(WRENCH_N, Vector3.ZERO, 0.0)


func _set_up_zone(zone: SpidarGZone) -> void:
	zone.enabled = kind != Kind.WRENCH
	zone.edge_width = WIND_EDGE_M if kind == Kind.FORCE else EDGE_M
	match kind:
		Kind.VISCOUS:
			zone.kind = SpidarGZone.Kind.VISCOSITY
			zone.viscosity = VISCOUS_N_S_M
			zone.viscosity_angular = VISCOUS_NM_S_RAD
		Kind.VIBRATION:
			zone.kind = SpidarGZone.Kind.VIBRATION
			zone.vibration_force = Vector3.UP * VIBRATION_N
			zone.vibration_frequency = VIBRATION_HZ
		Kind.DETENTS:
			zone.kind = SpidarGZone.Kind.DETENTS
			zone.detent_spacing = DETENT_SPACING_M
			zone.detent_force = DETENT_N
		Kind.SPRING:
			zone.kind = SpidarGZone.Kind.MAGNET_POINT
			zone.stiffness = SPRING_N_M
		Kind.FORCE:
			zone.kind = SpidarGZone.Kind.WIND
			zone.wind_force = FORCE_N


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
