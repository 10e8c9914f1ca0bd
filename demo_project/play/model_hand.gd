extends RefCounted
## The hand on spidar_board_model, a program outside of this one with the plant of the simulated device behind serial motor
## boards: where it goes, and what it feels. Orders as in tests/board_model/orders_talk.h.

## What the strings really do: grasp_angle (rad), strings_wrench (world); as SpidarG.get_simulated_truth() has them.
var truth := {"grasp_angle": 0.0, "strings_wrench": PackedFloat64Array([0, 0, 0, 0, 0, 0, 0])}

var _socket := PacketPeerUDP.new()


func _init(port: int) -> void:
	_socket.connect_to_host("127.0.0.1", port)


func set_firmness(firmness: SpidarG.HandFirmness) -> void:
	_tell("firmness %d" % firmness)


## The hand aims there; world. Once a physics tick.
func aim(device: SpidarG, target: Transform3D, grasp_angle_rad: float) -> void:
	var frame := device.global_transform.orthonormalized()
	var in_device := frame.affine_inverse() * target
	var at := in_device.origin / device.workspace_scale
	var turn := in_device.basis.get_rotation_quaternion()
	_tell("pose %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f" % [
		at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z, grasp_angle_rad
	])
	_hear(frame.basis)


func _tell(order: String) -> void:
	_socket.put_packet(order.to_utf8_buffer())


## Never waits: the newest that has come.
func _hear(turned: Basis) -> void:
	var line := ""
	while _socket.get_available_packet_count() > 0:
		line = _socket.get_packet().get_string_from_utf8()
	var told: Variant = JSON.parse_string(line) if line != "" else null
	if typeof(told) != TYPE_DICTIONARY:
		return
	var felt: Array = told["strings_wrench"]
	var force := turned * Vector3(felt[0], felt[1], felt[2])
	var moment := turned * Vector3(felt[3], felt[4], felt[5])
	truth["grasp_angle"] = told["grasp_angle"]
	truth["strings_wrench"] = PackedFloat64Array(
		[force.x, force.y, force.z, moment.x, moment.y, moment.z, felt[6]]
	)
