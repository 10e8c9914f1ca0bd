extends RefCounted
## The device's time between the physics ticks of a hand. Forces, impulses and velocities of a device are in its own time: it
## goes on when Engine.time_scale slows the game, and stands still between physics ticks that share one drawn frame.

## Two poses count as one when they are nearer in time than this part of the last interval, or of a physics tick. Ticks that
## share a drawn frame are some milliseconds apart, and differences over so short a time are mostly noise.
const LEAST_PART: float = 0.5
## A plane is up to two intervals old when the next one replaces it; this is the mean.
const AHEAD_TICKS: float = 1.5
## The device fades planes that are older than this, s.
const LONGEST_S: float = 0.1

## Device time between the pose that this tick reads and the last one that was read, s; 0: it is still the same pose.
var elapsed_s: float = 0.0
## How far ahead planes of this tick should look, s.
var ahead_s: float = 0.0
var _read_s: float = NAN
var _apart_s: float = 0.0


## Once a physics tick.
func read(device: SpidarG) -> void:
	var tick_s: float = 1.0 / Engine.physics_ticks_per_second
	var now_s: float = device.get_device_time_s()
	if is_nan(_read_s):
		_read_s = now_s
	_apart_s = clampf(_apart_s, tick_s, LONGEST_S)
	ahead_s = AHEAD_TICKS * _apart_s
	elapsed_s = now_s - _read_s
	if elapsed_s < LEAST_PART * _apart_s:
		elapsed_s = 0.0
		return
	_read_s = now_s
	_apart_s = elapsed_s
