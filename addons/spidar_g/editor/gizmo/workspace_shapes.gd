@tool
extends RefCounted
## Makes the meshes and lines of the 3D view from points. Lengths are in meters of device motion. This class uses neither a
## device nor the editor.

## A force is drawn with this length, in meters for each newton.
const METRES_PER_NEWTON: float = 0.006
const LOST_COLOUR: Color = Color(0.90, 0.16, 0.14, 0.42)
const WEAK_COLOUR: Color = Color(1.00, 0.80, 0.20, 0.36)
const GOOD_COLOUR: Color = Color(0.15, 0.75, 0.40, 0.36)
## Closure margins from this value on have the color of a good margin.
const GOOD_MARGIN: float = 0.5
## The directions are the corners of an icosahedron, each of whose triangles is split into four this many times.
const SPLITS: int = 2
## The number of directions after one split less. So many are enough to find the smallest and the largest force.
const FEW: int = 42

## Unit vectors that cover the sphere evenly. They are the corners of [member triangles].
var directions: PackedVector3Array = []
## The triangles that connect the [member directions], with three indices each.
var triangles: PackedInt32Array = []


func _init() -> void:
	_make_icosahedron()
	for _i: int in SPLITS:
		_split()


## Returns the twelve edges of a box, with two points for each edge.
static func box_lines(low: Vector3, high: Vector3) -> PackedVector3Array:
	var lines: PackedVector3Array = []
	for axis: int in 3:
		for corner: int in 4:
			var from: Vector3 = low
			from[(axis + 1) % 3] = high[(axis + 1) % 3] if corner & 1 else low[(axis + 1) % 3]
			from[(axis + 2) % 3] = high[(axis + 2) % 3] if corner & 2 else low[(axis + 2) % 3]
			var to: Vector3 = from
			to[axis] = high[axis]
			lines.append(from)
			lines.append(to)
	return lines


## Returns the transform that turns a cylinder with radius 1 and height 1 along +Y into a rod between two points.
static func rod(from: Vector3, to: Vector3, radius: float) -> Transform3D:
	var along: Vector3 = to - from
	var length: float = along.length()
	if not (length > 0.0):
		return Transform3D(Basis.from_scale(Vector3.ZERO), from)
	var turn := Basis(Quaternion(Vector3.UP, along / length))
	return Transform3D(turn * Basis.from_scale(Vector3(radius, length, radius)), 0.5 * (from + to))


## Returns the points of a map: `cells` + 1 rows with `cells` + 1 points each. They lie in the plane through `at` at right
## angles to `axis` (0 to 2), and fill the box from `low` to `high`.
static func map_points(low: Vector3, high: Vector3, at: Vector3, axis: int, cells: int) -> PackedVector3Array:
	var points: PackedVector3Array = []
	var across: int = (axis + 1) % 3
	var up: int = (axis + 2) % 3
	for row: int in cells + 1:
		for column: int in cells + 1:
			var point: Vector3 = at
			point[across] = lerpf(low[across], high[across], column / float(cells))
			point[up] = lerpf(low[up], high[up], row / float(cells))
			points.append(point)
	return points


static func closure_colour(margin: float) -> Color:
	if not (margin > 0.0):
		return LOST_COLOUR
	return WEAK_COLOUR.lerp(GOOD_COLOUR, minf(margin / GOOD_MARGIN, 1.0))


static func map_mesh(points: PackedVector3Array, margins: PackedFloat64Array, cells: int) -> ArrayMesh:
	var colours: PackedColorArray = []
	for margin: float in margins:
		colours.append(closure_colour(margin))
	var corners: PackedInt32Array = []
	for row: int in cells:
		for column: int in cells:
			var first: int = row * (cells + 1) + column
			corners.append_array([first, first + 1, first + cells + 1])
			corners.append_array([first + 1, first + cells + 2, first + cells + 1])
	return _mesh(points, corners, colours)


func few_directions() -> PackedVector3Array:
	return directions.slice(0, FEW)


## Returns a mesh whose corner in each of the [member directions] lies at a distance proportional to the force in this
## direction, which `capacity_n` contains (in newtons).
func capacity_mesh(capacity_n: PackedFloat64Array, colour: Color) -> ArrayMesh:
	var points: PackedVector3Array = []
	var colours: PackedColorArray = []
	for i: int in directions.size():
		points.append(directions[i] * (capacity_n[i] * METRES_PER_NEWTON))
		colours.append(colour)
	return _mesh(points, triangles, colours)


## Returns the edges of the mesh of [method capacity_mesh].
func capacity_lines(capacity_n: PackedFloat64Array) -> PackedVector3Array:
	var lines: PackedVector3Array = []
	for corner: int in triangles.size():
		var next: int = corner + 1 if corner % 3 < 2 else corner - 2
		var from: int = triangles[corner]
		var to: int = triangles[next]
		if from < to:
			lines.append(directions[from] * (capacity_n[from] * METRES_PER_NEWTON))
			lines.append(directions[to] * (capacity_n[to] * METRES_PER_NEWTON))
	return lines


static func _mesh(points: PackedVector3Array, corners: PackedInt32Array, colours: PackedColorArray) -> ArrayMesh:
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = points
	arrays[Mesh.ARRAY_INDEX] = corners
	arrays[Mesh.ARRAY_COLOR] = colours
	var mesh := ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


func _make_icosahedron() -> void:
	var golden: float = 0.5 * (1.0 + sqrt(5.0))
	for axis: int in 3:
		for corner: int in 4:
			var point := Vector3.ZERO
			point[axis] = 1.0 if corner & 1 else -1.0
			point[(axis + 1) % 3] = golden if corner & 2 else -golden
			directions.append(point.normalized())
	# Its faces are the triples of nearest neighbours.
	var edge: float = 2.0 / sqrt(1.0 + golden * golden)
	for a: int in 12:
		for b: int in range(a + 1, 12):
			for c: int in range(b + 1, 12):
				if _edges(a, b, c, edge):
					var outward: float = (
						(directions[b] - directions[a]).cross(directions[c] - directions[a]).dot(directions[a])
					)
					triangles.append_array([a, b, c] if outward < 0.0 else [a, c, b])


func _edges(a: int, b: int, c: int, edge: float) -> bool:
	for pair: Vector2i in [Vector2i(a, b), Vector2i(b, c), Vector2i(c, a)]:
		if absf(directions[pair.x].distance_to(directions[pair.y]) - edge) > 1e-3:
			return false
	return true


# Splits each triangle into four and moves the new corners to the sphere.
func _split() -> void:
	var halves: Dictionary[Vector2i, int] = {}
	var finer: PackedInt32Array = []
	for first: int in range(0, triangles.size(), 3):
		var corner: Array[int] = [triangles[first], triangles[first + 1], triangles[first + 2]]
		var half: Array[int] = []
		for side: int in 3:
			var from: int = corner[side]
			var to: int = corner[(side + 1) % 3]
			var edge := Vector2i(mini(from, to), maxi(from, to))
			if not halves.has(edge):
				halves[edge] = directions.size()
				directions.append((directions[from] + directions[to]).normalized())
			half.append(halves[edge])
		finer.append_array([corner[0], half[0], half[2], half[0], corner[1], half[1]])
		finer.append_array([half[2], half[1], corner[2], half[0], half[1], half[2]])
	triangles = finer
