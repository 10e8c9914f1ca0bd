## Base of the SpidarGClipPlayer tests: an ideal device, a player, and what the simulated hand feels in each servo cycle.
extends "res://test_case.gd"

const ARMING_CYCLES: int = 1600
const TICK_CYCLES: int = 16
## Of the strings' own bias on a force that should be none, N.
const BIAS_N: float = 0.06

var device: SpidarG
var player: SpidarGClipPlayer
var tick_cycles: int = TICK_CYCLES
## Whether strings are elastic and have friction, as on a simulated device as it comes.
var is_elastic: bool = false
## Of the tension solver; less than 0: as the device comes.
var change_weight: float = -1.0
## What the strings gave the hand, what the tensions achieved, and what was asked for, in each cycle of the last run() (N, world).
var felt: PackedVector3Array = []
var achieved: PackedVector3Array = []
var asked: PackedVector3Array = []


func set_up(clip: SpidarGClip = null) -> void:
	device = ideal_device()
	if is_elastic:
		device.config = SpidarGConfig.new()
	if change_weight >= 0.0:
		device.config.change_weight = change_weight
	device.forces_enabled = true
	add(device)
	await physics_frames(1)
	device.advance_cycles(ARMING_CYCLES)
	# Its cycles are run one by one, between the ticks of the player.
	device.process_mode = Node.PROCESS_MODE_DISABLED
	player = SpidarGClipPlayer.new()
	player.clip = clip
	add(player)


func leave() -> void:
	if is_instance_valid(player):
		player.free()
	device.free()
	await physics_frames(2)


## A buzz along x.
static func buzz(hz: float, strength_n: float, hold_s: float, attack_s: float = 0.0, release_s: float = 0.0) -> SpidarGClip:
	var clip := SpidarGClip.new()
	clip.frequency = hz
	clip.strength = strength_n
	clip.attack = attack_s
	clip.hold = hold_s
	clip.release = release_s
	clip.direction = Vector3.RIGHT
	return clip


## Game ticks of `tick_cycles` servo cycles.
func run(seconds: float) -> void:
	felt.clear()
	achieved.clear()
	asked.clear()
	for _tick: int in ceili(seconds * 1000.0 / tick_cycles):
		await physics_frames(1)
		for _cycle: int in tick_cycles:
			device.advance_cycles(1)
			felt.append(force_of(device.get_simulated_truth()["strings_wrench"]))
			achieved.append(force_of(device.get_achieved_wrench()))
			asked.append(force_of(device.get_requested_wrench()))


static func force_of(wrench: PackedFloat64Array) -> Vector3:
	return Vector3(wrench[0], wrench[1], wrench[2])


## Largest force of some cycles.
static func peak_n(forces: PackedVector3Array, from: int = 0, to: int = 1 << 30) -> float:
	var most: float = 0.0
	for i: int in range(from, mini(to, forces.size())):
		most = maxf(most, forces[i].length())
	return most


## Cycles from the first to the last force that is larger than `least_n`.
static func lasting(forces: PackedVector3Array, least_n: float) -> int:
	var first: int = -1
	var last: int = -1
	for i: int in forces.size():
		if forces[i].length() > least_n:
			first = i if first < 0 else first
			last = i
	return last - first + 1 if first >= 0 else 0


## Mean frequency along x, by the upward crossings of zero; 0 where there are fewer than two.
static func hz_of(forces: PackedVector3Array, from: int, to: int) -> float:
	var times: PackedFloat64Array = []
	for i: int in range(maxi(1, from), mini(to, forces.size())):
		if forces[i - 1].x < 0.0 and forces[i].x >= 0.0:
			times.append(i - forces[i].x / (forces[i].x - forces[i - 1].x))
	return 1000.0 * (times.size() - 1) / (times[-1] - times[0]) if times.size() > 1 else 0.0


## A sound of one sine whose amplitude falls by 1/e in each `decay_s`; full scale is 1.
static func tone(
	hz: float, seconds: float, decay_s: float = INF, format := AudioStreamWAV.FORMAT_16_BITS, stereo: bool = false,
	rate: int = 22050, amplitude: float = 0.8
) -> AudioStreamWAV:
	var bytes := PackedByteArray()
	var channels: int = 2 if stereo else 1
	var width: int = 2 if format == AudioStreamWAV.FORMAT_16_BITS else 1
	var count: int = roundi(seconds * rate)
	bytes.resize(count * channels * width)
	for i: int in count * channels:
		var time_s: float = float(i / channels) / rate
		var value: float = amplitude * sin(TAU * hz * time_s) * exp(-time_s / decay_s)
		if width == 2:
			bytes.encode_s16(2 * i, roundi(32767.0 * value))
		else:
			bytes.encode_s8(i, roundi(127.0 * value))
	var stream := AudioStreamWAV.new()
	stream.format = format
	stream.stereo = stereo
	stream.mix_rate = rate
	stream.data = bytes
	return stream
