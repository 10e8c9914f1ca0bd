extends RefCounted
## The 1-D stop on the grasp angle that lets the fingers feel a width, and the squeeze that it measures.

const ContactSet := preload("contact_set.gd")

## Safe for every simulated hand at 2 ms device latency; the stability limit of the worst hand is 0.45.
const STIFFNESS_NM_RAD: float = 0.25
const DAMPING_NM_S_RAD: float = 0.001
## A body with this metadata (N m/rad) is softer to squeeze; kept within the stable range.
const STIFFNESS_META: StringName = &"spidar_squeeze_nm_rad"
const STIFFNESS_RANGE: Vector2 = Vector2(0.02, 0.4)
## The pads' own stop is published when the jaws are this near to closed, rad.
const CLOSED_STOP_RANGE: float = 0.17
## Smooths the trembling of the fingers: time constant, s.
const SQUEEZE_TIME_S: float = 0.024

var active: bool = false
## keeps grasp_angle <= this, rad.
var angle_rad: float = 0.0
var stiffness_nm_rad: float = STIFFNESS_NM_RAD
## What the fingers press the body with, N m of grasp torque; 0 when open.
var squeeze_nm: float = 0.0
var _id: int = 0
var _rid: RID


## Stops at `angle` for the body `rid` (an empty one: the pads themselves).
func place(contacts: ContactSet, angle: float, stiffness: float, rid: RID) -> void:
	if not active or rid != _rid:
		_id = contacts.new_id()
		squeeze_nm = 0.0
	active = true
	_rid = rid
	angle_rad = angle
	stiffness_nm_rad = clampf(stiffness, STIFFNESS_RANGE.x, STIFFNESS_RANGE.y)


func remove() -> void:
	active = false
	squeeze_nm = 0.0


func is_for(rid: RID) -> bool:
	return active and rid == _rid


## Measures the squeeze over the last since_s of device time. With forces on it is the impulse that the strings were asked for,
## divided by that time. With forces off it is the torque of the stop's spring, so that games without a force display can grasp.
func measure(contacts: ContactSet, grasp_angle: float, forces_on: bool, since_s: float) -> void:
	if not active:
		return
	var torque: float = stiffness_nm_rad * maxf(grasp_angle - angle_rad, 0.0)
	if forces_on:
		torque = maxf(-contacts.gained(_id).x / since_s, 0.0)
	squeeze_nm = lerpf(torque, squeeze_nm, exp(-since_s / SQUEEZE_TIME_S))


func pack_into(rows: PackedFloat64Array) -> void:
	if not active:
		return
	rows.append_array(
		PackedFloat64Array(
			[
				-1.0, 0.0, 0.0, -angle_rad, 0.0, 0.0, 0.0,
				stiffness_nm_rad, DAMPING_NM_S_RAD, 0.0,
				SpidarG.CONTACT_GRASP_STOP, _id,
			]
		)
	)
