@tool
extends StaticBody3D
## A small fixed stand that carries a thing on its flat top, or on the rim of a ring that keeps a ball from rolling. Its origin
## is on the table.

@export var height_m := 0.0
## Inner radius of the ring; 0: the top is flat.
@export var ring_inner_m := 0.0
@export var ring_outer_m := 0.0


## Height of the middle of a thing of this size that rests on the stand.
func rest_height_m(size_m: Vector3) -> float:
	if ring_inner_m <= 0.0:
		return height_m + size_m.y * 0.5
	var radius_m := size_m.x * 0.5
	return height_m + sqrt(radius_m * radius_m - ring_inner_m * ring_inner_m)


## Half of what it, or the thing on it, covers of the table.
func footprint_m(size_m: Vector3) -> Vector2:
	return Vector2.ONE * ring_outer_m if ring_outer_m > 0.0 else Vector2(size_m.x, size_m.z) * 0.5
