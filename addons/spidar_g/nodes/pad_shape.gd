extends RefCounted
## The finger pads: two hemispheres whose flat faces look at each other along the grip's x axis.

## Of a pad, device metres.
const RADIUS_M: float = 0.012
## Rings and points per ring of the hull: its surface is within 0.3 mm of the true hemisphere.
const RINGS: int = 4
const SECTORS: int = 16

var _shape: ConvexPolygonShape3D = ConvexPolygonShape3D.new()
var _scale: float = 0.0


## The hull, dome towards +x, in scene metres.
func shape_for(workspace_scale: float) -> ConvexPolygonShape3D:
	if workspace_scale != _scale:
		_scale = workspace_scale
		var points: PackedVector3Array = PackedVector3Array()
		for ring: int in RINGS:
			var height: float = sin(0.5 * PI * ring / RINGS)
			var width: float = cos(0.5 * PI * ring / RINGS)
			for sector: int in SECTORS:
				var turn: float = TAU * sector / SECTORS
				points.append(Vector3(height, width * cos(turn), width * sin(turn)))
		points.append(Vector3.RIGHT)
		for i: int in points.size():
			points[i] *= RADIUS_M * workspace_scale
		_shape.points = points
	return _shape


## Side 0 at -x of the grip, side 1 at +x; origin in the middle of the inner face.
func transform_of(side: int, grip: Transform3D, gap_m: float) -> Transform3D:
	var outward: float = -1.0 if side == 0 else 1.0
	var turned: Basis = grip.basis if side == 1 else grip.basis * Basis(Vector3.UP, PI)
	return Transform3D(turned, grip.origin + grip.basis.x * (0.5 * gap_m * outward))
