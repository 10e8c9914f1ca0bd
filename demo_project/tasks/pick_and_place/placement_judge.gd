class_name PlacementJudge
extends RefCounted
## Decides by geometry alone whether a thing lies where it belongs.

## Distance of the centres; drawn as the pale band around each outline.
const POSITION_TOLERANCE_M := 0.008
const ROTATION_TOLERANCE_RAD := deg_to_rad(10.0)
## At rest: slower than this.
const REST_SPEED_M_S := 0.02
## Everything must stay placed for this long.
const DWELL_S := 0.5


static func is_placed(object: TaskObject, held: RigidBody3D) -> bool:
	return (
		object != held
		and object.linear_velocity.length() < REST_SPEED_M_S
		and object.position_error_m() <= POSITION_TOLERANCE_M
		and object.rotation_error_rad() <= ROTATION_TOLERANCE_RAD
	)


## Angle between two orientations as far as the shape can show it.
static func rotation_error_rad(spec: ObjectSpec, actual: Basis, wanted: Basis) -> float:
	match spec.shape:
		ObjectSpec.Shape.SPHERE:
			return 0.0
		ObjectSpec.Shape.CYLINDER:
			var tilt := actual.y.normalized().angle_to(wanted.y.normalized())
			return minf(tilt, PI - tilt)
	# A box looks the same after half a turn about its height; a square one after a quarter.
	var turn := PI * 0.5 if is_equal_approx(spec.size_m.x, spec.size_m.z) else PI
	var best := TAU
	for step in roundi(TAU / turn):
		var same := Basis(Vector3.UP, turn * step)
		var between := (actual.orthonormalized() * same).inverse() * wanted
		best = minf(best, between.get_rotation_quaternion().get_angle())
	return best
