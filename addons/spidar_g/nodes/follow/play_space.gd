extends RefCounted
## Computes poses in the play space, which is the space in which XR trackers report their poses, in meters. [XRNode3D]
## multiplies the positions by XRServer.world_scale, and the XR origin moves the poses into the world.


## Returns [code]true[/code] if the transform is finite and only rotates and moves: no scale, shear or mirroring.
static func is_rigid(place: Transform3D) -> bool:
	return place.is_finite() and place.basis.is_conformal() and absf(place.basis.determinant() - 1.0) < 1e-3


## Returns the pose in the world that an XRController3D has when its tracker is at the origin of the play space.
static func origin_in_world() -> Transform3D:
	return XRServer.world_origin.orthonormalized() * XRServer.get_reference_frame()


## Returns the pose of the grip in the frame of its device, in meters of the play space.
static func grip_in_device(spidar: SpidarG) -> Transform3D:
	var place: Transform3D = spidar.global_transform.orthonormalized().inverse() * spidar.get_grip_transform()
	return Transform3D(place.basis, place.origin / XRServer.world_scale)


## Returns the pose of a device in the play space. Its grip has the pose `in_device` in the frame of the device, and the pose
## `in_space` in the play space. With `keep_upright` the device is turned about the vertical axis only.
static func place_of_device(in_space: Transform3D, in_device: Transform3D, keep_upright: bool) -> Transform3D:
	var turn: Basis = in_space.basis.orthonormalized() * in_device.basis.inverse()
	if keep_upright:
		turn = Basis(Vector3.UP, atan2(turn.z.x, turn.z.z))
	return Transform3D(turn, in_space.origin - turn * in_device.origin)
