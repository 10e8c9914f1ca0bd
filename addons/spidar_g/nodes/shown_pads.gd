extends RefCounted
## Where a finger pad is shown: moved out of every body that it would stand in.
##
## The strings yield, a flat pad meets a face a few degrees askew and a rim passes an edge: the grip itself overlaps a
## body by up to a millimetre. What is drawn is a god-object, as usual in haptic rendering: it stays on the surface.

const ContactFinder := preload("contact_finder.gd")
const ContactPlane := preload("contact_plane.gd")
const ContactSet := preload("contact_set.gd")

## Each pass moves the pad out of the bodies it met in the one before; a corner of three faces takes three.
const MAX_PASSES: int = 4
## Overlap that is not worth another pass, pad radii (0.06 mm for a pad of 12 mm).
const CLEAR_RADII: float = 0.005
## A pad deeper in than this, in pad radii, is lost in a body: no way out is known, so it is shown where it is.
const MAX_SHIFT_RADII: float = 1.5

var collision_mask: int = 1
var _finder: ContactFinder = ContactFinder.new()
var _space_is_away: bool = ProjectSettings.get_setting("physics/3d/run_on_separate_thread", false)


## The same in `world`, from wherever it is called: with physics in a thread of its own nobody may look into its space
## between two physics frames, and the pad is then shown where it is.
func place_in(
	world: World3D, mask: int, shape: Shape3D, at: Transform3D, radius_m: float
) -> Transform3D:
	if _space_is_away and not Engine.is_in_physics_frame():
		return at
	collision_mask = mask
	return place(world.direct_space_state, shape, at, radius_m)


## Where a pad of `shape` (radius in scene metres) that belongs at `at` is shown.
func place(
	space: PhysicsDirectSpaceState3D, shape: Shape3D, at: Transform3D, radius_m: float
) -> Transform3D:
	var shown: Transform3D = at
	for _pass: int in MAX_PASSES:
		var met: Array[ContactPlane] = overlaps(space, shape, shown)
		var shift: Vector3 = ContactSet.way_out(met)
		if not (shift.length() > CLEAR_RADII * radius_m):
			break
		shown.origin += shift
	return shown if shown.origin.distance_to(at.origin) <= MAX_SHIFT_RADII * radius_m else at


## A plane for each body that `shape` stands in at `at`: minus its separation is how deep, scene metres.
func overlaps(
	space: PhysicsDirectSpaceState3D, shape: Shape3D, at: Transform3D
) -> Array[ContactPlane]:
	var met: Array[ContactPlane] = []
	_finder.collision_mask = collision_mask
	_finder.margin_m = 0.0
	_finder.find(space, shape, at, [], met)
	return met
