extends Node3D
## Shows in words what the sockets of the plug do.

@onready var _told: Label3D = $Told


func _ready() -> void:
	for socket: SpidarGSocket in [$Plug/Foot, $Plug/Head]:
		socket.linked.connect(func(mate: SpidarGSocket) -> void: _told.text = "linked to the %s" % mate.get_body().name)
		socket.unlinked.connect(func(_mate: SpidarGSocket, pull_n: float) -> void: _told.text = "off at %.1f N" % pull_n)
