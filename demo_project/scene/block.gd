@tool
extends StaticBody3D
## A solid box that does not move: its size in one place for what is felt and what is seen.

@export var size_m := Vector3(0.02, 0.02, 0.02):
	set(value):
		size_m = value
		_resize()
@export var material: Material:
	set(value):
		material = value
		_resize()


func _enter_tree() -> void:
	_resize()


## Does nothing while the scene is still being put together.
func _resize() -> void:
	var felt := get_node_or_null(^"Shape") as CollisionShape3D
	var seen := get_node_or_null(^"Mesh") as MeshInstance3D
	if felt == null or seen == null:
		return
	var shape := BoxShape3D.new()
	shape.size = size_m
	felt.shape = shape
	var mesh := BoxMesh.new()
	mesh.size = size_m
	mesh.material = material
	seen.mesh = mesh
