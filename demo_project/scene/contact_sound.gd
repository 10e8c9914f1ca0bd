extends AudioStreamPlayer
## A short knock when something is grasped, let go, struck, linked or torn off. Made here, not recorded.

const RATE_HZ := 22050
const LENGTH_S := 0.06
const TONE_HZ := 620.0
const DECAY_1_S := 70.0
## By what happened: how high and how loud.
const PITCH: Dictionary[StringName, float] = {
	&"grasped": 1.0, &"released": 0.8, &"struck": 0.6, &"linked": 1.6, &"unlinked": 1.2
}
const LOUDNESS_DB: Dictionary[StringName, float] = {
	&"grasped": -12.0, &"released": -18.0, &"struck": -14.0, &"linked": -6.0, &"unlinked": -8.0
}


func _ready() -> void:
	stream = knock()


func say(what: StringName) -> void:
	if DisplayServer.get_name() == "headless":
		return  # Nobody listens; and Godot counts a sound that still plays when it ends as leaked.
	pitch_scale = PITCH[what]
	volume_db = LOUDNESS_DB[what]
	play()


## A tone and its fifth that die away, 16 bit.
static func knock() -> AudioStreamWAV:
	var samples := PackedByteArray()
	var count := int(RATE_HZ * LENGTH_S)
	samples.resize(2 * count)
	for index in count:
		var time := float(index) / RATE_HZ
		var wave := sin(TAU * TONE_HZ * time) + 0.5 * sin(TAU * 1.5 * TONE_HZ * time)
		samples.encode_s16(2 * index, roundi(20000.0 / 1.5 * wave * exp(-DECAY_1_S * time)))
	var stream := AudioStreamWAV.new()
	stream.format = AudioStreamWAV.FORMAT_16_BITS
	stream.mix_rate = RATE_HZ
	stream.data = samples
	return stream
