extends RefCounted
## One kind of thing to pick up: its shape, mass and how it is held. Metres, kilograms.

const ObjectSpec := preload("res://tasks/pick_and_place/object_spec.gd")
const StandBuilder := preload("res://scene/stand_builder.gd")
const TaskBody := preload("res://scene/task_body.gd")

enum Shape { BOX, CYLINDER, SPHERE }
## What it stands on, at its start and at its target.
enum Stand { TABLE, RING, RACK }

## Fingers reach this far below the top of a standing object.
const FINGER_DEPTH_M := 0.016

var label := ""
var shape := Shape.BOX
## x is the width between the fingers, y the height; cylinder: x = z = diameter; sphere: all alike.
var size_m := Vector3.ZERO
var mass_kg := 0.0
var colour := Color.WHITE
var stand := Stand.TABLE
var friction := TaskBody.DEFAULT_FRICTION
## Softness; 0: as hard as everything else.
var squeeze_nm_rad := 0.0
var stiffness_n_m := 0.0
## Height of the fingers above the object's centre when it is picked up.
var grasp_above_centre_m := 0.0


static func make(
	label_: String,
	shape_: Shape,
	size_: Vector3,
	mass_: float,
	colour_: Color,
	stand_: Stand = Stand.TABLE
) -> ObjectSpec:
	var spec := ObjectSpec.new()
	spec.label = label_
	spec.shape = shape_
	spec.size_m = size_
	spec.mass_kg = mass_
	spec.colour = colour_
	spec.stand = stand_
	# Tall things are held near the top: the hand stays clear of the table, and they hang upright.
	if stand_ == Stand.TABLE:
		spec.grasp_above_centre_m = size_.y * 0.5 - FINGER_DEPTH_M
	return spec


## Height of the centre above the table when at rest.
func rest_height_m() -> float:
	match stand:
		Stand.RING:
			return StandBuilder.ring_rest_height_m(size_m.x * 0.5)
		Stand.RACK:
			return StandBuilder.RACK_HEIGHT_M + size_m.y * 0.5
	return size_m.y * 0.5


## Half the footprint on the table.
func footprint_m() -> Vector2:
	if stand == Stand.RING:
		return Vector2.ONE * StandBuilder.RING_OUTER_M
	return Vector2(size_m.x, size_m.z) * 0.5


func is_round() -> bool:
	return shape != Shape.BOX


func collision_shape() -> Shape3D:
	match shape:
		Shape.CYLINDER:
			var cylinder := CylinderShape3D.new()
			cylinder.radius = size_m.x * 0.5
			cylinder.height = size_m.y
			return cylinder
		Shape.SPHERE:
			var sphere := SphereShape3D.new()
			sphere.radius = size_m.x * 0.5
			return sphere
	var box := BoxShape3D.new()
	box.size = size_m
	return box


func mesh() -> Mesh:
	match shape:
		Shape.CYLINDER:
			var cylinder := CylinderMesh.new()
			cylinder.top_radius = size_m.x * 0.5
			cylinder.bottom_radius = size_m.x * 0.5
			cylinder.height = size_m.y
			cylinder.rings = 0
			return cylinder
		Shape.SPHERE:
			var sphere := SphereMesh.new()
			sphere.radius = size_m.x * 0.5
			sphere.height = size_m.x
			return sphere
	var box := BoxMesh.new()
	box.size = size_m
	return box
