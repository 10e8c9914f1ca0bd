extends RefCounted
## What a hand asks of its device, under the hand's own name, so that it stands beside what scripts ask.

## A load acts for so long unless it is asked for again, s: longer than a frame of a game that is drawn 15 times a second.
const LOAD_S: float = 0.1

var device: SpidarG = null
var owner: String = ""
var _has_contacts: bool = false
var _has_load: bool = false


## How many planes others leave to the hand, beside its grasp stop.
func free_planes() -> int:
	return device.get_free_contacts(owner) - 1


## The rows of planes and stop, as SpidarG.set_contacts() takes them.
func publish(rows: PackedFloat64Array) -> void:
	if not rows.is_empty():
		_has_contacts = device.set_contacts(rows, owner)
	elif _has_contacts:
		device.clear_contacts(owner)
		_has_contacts = false


func ask(force_n: Vector3, moment_nm: Vector3) -> void:
	_has_load = device.request_wrench(force_n, moment_nm, 0.0, LOAD_S, owner)


func end_load() -> void:
	if _has_load:
		device.request_wrench(Vector3.ZERO, Vector3.ZERO, 0.0, 0.0, owner)
	_has_load = false


## Takes everything back from the device.
func withdraw() -> void:
	if device == null:
		return
	if _has_contacts:
		device.clear_contacts(owner)
	_has_contacts = false
	end_load()
