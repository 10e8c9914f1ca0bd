extends RefCounted
## Talks to spidar_board_model: orders as in tests/board_model/orders_talk.h, answered by what is true.

const ANSWER_LIMIT_MS := 2000

var _socket := PacketPeerUDP.new()


func _init(port: int) -> void:
	_socket.connect_to_host("127.0.0.1", port)


## Waits for the answer; empty: none came.
func tell(order: String = "look") -> Dictionary:
	_socket.put_packet(order.to_utf8_buffer())
	var began_ms := Time.get_ticks_msec()
	while _socket.get_available_packet_count() == 0 and Time.get_ticks_msec() - began_ms < ANSWER_LIMIT_MS:
		OS.delay_msec(1)
	if _socket.get_available_packet_count() == 0:
		return {}
	return JSON.parse_string(_socket.get_packet().get_string_from_utf8())
