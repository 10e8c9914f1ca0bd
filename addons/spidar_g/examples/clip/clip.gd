extends Node3D
## Shows the name of the clip that the hand felt last.

@onready var _told: Label3D = $Told


func _ready() -> void:
	for player: SpidarGClipPlayer in [$Drum/Knock, $Motor/Buzz, $Board/Creak]:
		player.started.connect(func(_spidar: SpidarG) -> void: _told.text = "felt: %s" % player.name.to_lower())
