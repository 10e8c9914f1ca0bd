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


## Stands for a pad in met(), larger than it by beyond_m. Physics on a thread of its own knows it some frames later.
static func ball(beyond_m: float) -> SphereShape3D:
	var shape := SphereShape3D.new()
	shape.radius = EDGE_M + beyond_m
	return shape


## Bodies nearer to a pad than its ball() says (below 0: that deep in it), with their nodes. The disc is searched with balls
## whose middles are spacing_m apart, for those are exact in every engine: a hull in Jolt may lack 1 mm.
static func met(
	space: PhysicsDirectSpaceState3D, at: Transform3D, ball_shape: SphereShape3D, spacing_m: float
) -> Dictionary[RID, Object]:
	var found: Dictionary[RID, Object] = {}
	var query := PhysicsShapeQueryParameters3D.new()
	query.shape = ball_shape
	var disc_m: float = RADIUS_M - EDGE_M
	var rings: int = ceili(disc_m / spacing_m)
	for ring: int in rings + 1:
		var radius: float = disc_m * ring / rings
		var sectors: int = maxi(1, ceili(TAU * radius / spacing_m))
		for sector: int in sectors:
			var spot: Vector2 = Vector2.from_angle(TAU * sector / sectors) * radius
			query.transform.origin = at * Vector3(EDGE_M, spot.x, spot.y)
			for hit: Dictionary in space.intersect_shape(query, 32):
				found[hit["rid"]] = hit["collider"]
	return found


## The pad of side 0 (at -x) or 1 of a grip whose jaws are open by gap_m.
static func place(side: int, grip: Transform3D, gap_m: float) -> Transform3D:
	var outward: float = -1.0 if side == 0 else 1.0
	var turned: Basis = grip.basis if side == 1 else grip.basis * Basis(Vector3.UP, PI)
	return Transform3D(turned, grip.origin + grip.basis.x * (0.5 * gap_m * outward))
