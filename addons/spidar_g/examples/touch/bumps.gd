@tool
extends StaticBody3D
## Makes a sheet of hills. The shape takes the triangles of the mesh as they are; create_trimesh_shape() would round them to
## 0.1 mm.

const STEP_M: float = 0.0018 # between two points of the mesh: 50 steps a side
const HILL_M: float = 0.03 # from crest to crest

## Sets the material with which the sheet is drawn.
@export var look: Material


func _ready() -> void:
	var faces: PackedVector3Array = []
	for step: int in 50 * 50:
		for corner: Vector2i in [Vector2i(0, 0), Vector2i(1, 0), Vector2i(0, 1), Vector2i(0, 1), Vector2i(1, 0), Vector2i(1, 1)]:
			var at: Vector2 = STEP_M * Vector2(step % 50 - 25 + corner.x, floori(step / 50.0) - 25 + corner.y)
			faces.append(Vector3(at.x, 0.0025 * (1.0 + cos(TAU * at.x / HILL_M)) * (1.0 + cos(TAU * at.y / HILL_M)), at.y))
	var tool := SurfaceTool.new()
	tool.begin(Mesh.PRIMITIVE_TRIANGLES)
	tool.set_material(look)
	for point: Vector3 in faces:
		tool.add_vertex(point)
	tool.generate_normals()
	for node: Node3D in [CollisionShape3D.new(), MeshInstance3D.new()] as Array[Node3D]:
		add_child(node) # without an owner: not saved with the scene
	var shape := ConcavePolygonShape3D.new()
	shape.set_faces(faces)
	(get_child(0) as CollisionShape3D).shape = shape
	(get_child(1) as MeshInstance3D).mesh = tool.commit()
