extends RefCounted
## The shape of a finger pad as the physics engine sees it, and how deep it stands in anything.

## Of a pad: a disc with a rounded edge.
const RADIUS_M: float = 0.012
const EDGE_M: float = 0.003
## Of the hull that stands for it: within 0.1 mm.
const RINGS: int = 7
const SECTORS: int = 24

var _shape: ConvexPolygonShape3D = ConvexPolygonShape3D.new()
var _query: PhysicsShapeQueryParameters3D = PhysicsShapeQueryParameters3D.new()


func _init() -> void:
	var points: PackedVector3Array = []
	for ring: int in RINGS:
		var turn: float = PI * (float(ring) / (RINGS - 1) - 0.5)
		var radius: float = RADIUS_M - EDGE_M + EDGE_M * cos(turn)
		for sector: int in SECTORS:
			var around: float = TAU * sector / SECTORS
			points.append(Vector3(EDGE_M * (1.0 + sin(turn)), radius * cos(around), radius * sin(around)))
	_shape.points = points
	_query.shape = _shape


## at: x outward from the middle of the pad's inner face.
func depth(space: PhysicsDirectSpaceState3D, at: Transform3D) -> float:
	_query.transform = at
	var deepest: float = 0.0
	var pairs: PackedVector3Array = space.collide_shape(_query, 32)
	for i: int in range(0, pairs.size() - 1, 2):
		deepest = maxf(deepest, pairs[i].distance_to(pairs[i + 1]))
	return deepest


## The pad of side 0 (at -x) or 1 of a grip whose jaws are open by gap_m.
static func place(side: int, grip: Transform3D, gap_m: float) -> Transform3D:
	var outward: float = -1.0 if side == 0 else 1.0
	var turned: Basis = grip.basis if side == 1 else grip.basis * Basis(Vector3.UP, PI)
	return Transform3D(turned, grip.origin + grip.basis.x * (0.5 * gap_m * outward))
