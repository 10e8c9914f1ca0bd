## SpidarGClip: the envelope by numbers, what it makes of a sound, and what it refuses.
extends "res://clip_scene.gd"


func test_an_envelope_by_numbers_rises_holds_and_falls() -> void:
	var clip: SpidarGClip = buzz(80.0, 1.0, 0.2, 0.1, 0.4)
	clip.gain = 1.5
	check_near(clip.get_duration(), 0.7, 1e-6, "duration")
	for told: Array in [[-0.1, 0.0], [0.0, 0.0], [0.05, 0.75], [0.1, 1.5], [0.29, 1.5], [0.5, 0.75], [0.7, 0.0], [9.0, 0.0]]:
		check_near(clip.get_strength_at(told[0]), told[1], 1e-5, "at %s s" % told[0])
	check_near(clip.get_peak_strength(0.0, 0.05), 0.75, 1e-5, "peak of the rise")
	check_near(clip.get_peak_strength(0.05, 0.6), 1.5, 1e-5, "peak within")
	check_near(clip.get_peak_strength(0.5, 9.0), 0.75, 1e-5, "peak of the fall")
	check_near(clip.get_frequency_at(0.3), 80.0, 1e-6, "frequency")
	clip.gain = 10.0
	check_near(clip.get_strength_at(0.2), 2.0, 1e-6, "no more than the device gives to a vibration")
	check_near(buzz(80.0, 1.0, 0.1).get_strength_at(0.0), 1.0, 1e-6, "without attack it begins in full")


func test_a_tone_becomes_its_loudness_and_frequency() -> void:
	for told: Array in [
		[AudioStreamWAV.FORMAT_16_BITS, false, 44100], [AudioStreamWAV.FORMAT_16_BITS, true, 22050],
		[AudioStreamWAV.FORMAT_8_BITS, false, 11025], [AudioStreamWAV.FORMAT_8_BITS, true, 8000],
	]:
		var clip := SpidarGClip.new()
		clip.stream = tone(60.0, 0.6, 0.2, told[0], told[1], told[2])
		check_near(clip.get_duration(), 0.6, 1e-3, "%s: duration" % [told])
		check_equal(clip.get_problem(), "", "%s: can be played" % [told])
		for time_s: float in [0.1, 0.2, 0.3, 0.4]:
			var due: float = exp(-(time_s - 0.0025) / 0.2)
			check_near(clip.get_strength_at(time_s), due, 0.07 * due, "%s: strength at %s s" % [told, time_s])
			check_near(clip.get_frequency_at(time_s), 60.0, 0.6, "%s: frequency at %s s" % [told, time_s])
		check_near(clip.get_peak_strength(0.0, 0.6), 1.0, 1e-4, "%s: the loudest is the strength" % [told])
		check_near(clip.get_strength_at(0.6), 0.0, 1e-6, "%s: nothing after its end" % [told])


func test_high_tones_are_folded_by_octaves_and_a_glide_still_glides() -> void:
	for told: Array in [[440.0, 220.0], [900.0, 225.0], [200.0, 200.0], [30.0, 30.0], [12.0, 12.0]]:
		var clip := SpidarGClip.new()
		clip.stream = tone(told[0], 0.8, INF, AudioStreamWAV.FORMAT_16_BITS, false, 22050)
		check_near(clip.get_frequency_at(0.4), told[1], 0.01 * told[1], "%s Hz" % told[0])
	var clip := SpidarGClip.new()
	clip.stream = _glide(300.0, 420.0, 0.5)
	var last: float = 0.0
	for i: int in range(1, 9):
		var hz: float = clip.get_frequency_at(0.05 * i)
		check(hz > last, "rises: %f Hz after %f Hz" % [hz, last])
		check_near(hz, 0.5 * (300.0 + 240.0 * 0.05 * i), 3.0, "half of the sound's at %.2f s" % (0.05 * i))
		last = hz


func test_an_offset_and_a_little_noise_change_no_frequency() -> void:
	var stream: AudioStreamWAV = tone(60.0, 0.5)
	var bytes: PackedByteArray = stream.data
	var random := RandomNumberGenerator.new()
	random.seed = 7
	for i: int in bytes.size() / 2:
		bytes.encode_s16(2 * i, clampi(bytes.decode_s16(2 * i) / 2 + 6000 + random.randi_range(-700, 700), -32768, 32767))
	stream.data = bytes
	var clip := SpidarGClip.new()
	clip.stream = stream
	for time_s: float in [0.1, 0.25, 0.4]:
		check_near(clip.get_frequency_at(time_s), 60.0, 1.2, "frequency at %s s" % time_s)
		check_near(clip.get_strength_at(time_s), 1.0, 0.1, "strength at %s s" % time_s)


func test_a_knock_after_a_pause_keeps_the_time_of_both() -> void:
	var stream: AudioStreamWAV = tone(100.0, 0.06)
	var pause := PackedByteArray()
	pause.resize(2 * roundi(0.4 * 22050))
	stream.data = stream.data + pause + stream.data
	var clip := SpidarGClip.new()
	clip.stream = stream
	check_near(clip.get_strength_at(0.03), 1.0, 0.1, "the first")
	check_near(clip.get_strength_at(0.25), 0.0, 0.01, "the pause")
	check_near(clip.get_strength_at(0.49), 1.0, 0.1, "the second")
	for time_s: float in [0.03, 0.055, 0.465, 0.49]:
		check_near(clip.get_frequency_at(time_s), 100.0, 2.0, "frequency at %s s" % time_s)


func test_compressed_silent_and_empty_sounds_are_refused_with_a_remedy() -> void:
	var catcher: RefCounted = _catch()
	for told: Array in [[AudioStreamWAV.FORMAT_QOA, "QOA"], [AudioStreamWAV.FORMAT_IMA_ADPCM, "IMA ADPCM"]]:
		var clip := SpidarGClip.new()
		var stream: AudioStreamWAV = tone(60.0, 0.1)
		stream.format = told[0]
		clip.stream = stream
		check(clip.get_problem().contains(told[1]) and clip.get_problem().contains("PCM"), "told: %s" % clip.get_problem())
		check_near(clip.get_duration() + clip.get_peak_strength(0.0, 9.0) + clip.get_strength_at(0.05), 0.0, 0.0, "nothing of it is played")
		check(_heard(catcher, "PCM"), "an error says so: %s" % [_messages(catcher)])
	var silent := SpidarGClip.new()
	silent.stream = tone(60.0, 0.1, INF, AudioStreamWAV.FORMAT_16_BITS, false, 22050, 0.0)
	check(silent.get_problem().contains("silent"), "silence: %s" % silent.get_problem())
	silent.stream = AudioStreamWAV.new()
	check(silent.get_problem().contains("no samples"), "empty: %s" % silent.get_problem())
	var nothing: SpidarGClip = buzz(80.0, 1.0, 0.0)
	check(nothing.get_problem().contains("0 s"), "no length: %s" % nothing.get_problem())
	silent.stream = tone(60.0, 0.1)
	check_equal(silent.get_problem(), "", "another stream heals it")
	_free_catcher(catcher)


func test_a_long_sound_is_cut_once_with_a_warning_and_converted_once() -> void:
	var catcher: RefCounted = _catch()
	var clip := SpidarGClip.new()
	clip.stream = tone(110.0, 7.0, INF, AudioStreamWAV.FORMAT_16_BITS, true, 44100)
	var began_us: int = Time.get_ticks_usec()
	check_near(clip.get_duration(), 5.0, 1e-3, "cut")
	var first_us: int = Time.get_ticks_usec() - began_us
	began_us = Time.get_ticks_usec()
	for _i: int in 100:
		clip.get_peak_strength(1.0, 1.016)
		clip.get_frequency_at(1.0)
	var next_us: float = (Time.get_ticks_usec() - began_us) / 100.0
	print("INFO 5 s of 44.1 kHz stereo converted in %.0f ms, asked again in %.1f us" % [1e-3 * first_us, next_us])
	check(next_us < 0.01 * first_us, "kept: %f us" % next_us)
	var told: int = 0
	for message: String in _messages(catcher):
		told += int(message.contains("cut after 5"))
	check(told == 1 or catcher == null, "one warning: %s" % [_messages(catcher)])
	_free_catcher(catcher)


func test_bad_values_are_refused_by_name_and_the_old_ones_stay() -> void:
	var catcher: RefCounted = _catch()
	var clip := SpidarGClip.new()
	for told: Array in [["strength", -0.1, "N"], ["strength", 2.5, "N"], ["gain", -1.0, "gain"], ["frequency", 4.0, "Hz"],
			["frequency", 300.0, "Hz"], ["attack", -1.0, "s"], ["hold", 6.0, "s"], ["release", -0.001, "s"]]:
		for bad: float in [told[1], NAN, INF]:
			_forget(catcher)
			var good: float = clip.get(told[0])
			clip.set(told[0], bad)
			check_equal(clip.get(told[0]), good, "%s = %s" % [told[0], bad])
			check(_heard(catcher, told[0]) and _heard(catcher, told[2]), "told: %s" % [_messages(catcher)])
	for bad: Vector3 in [Vector3.ZERO, Vector3(NAN, 0, 0)]:
		clip.direction = bad
		check_equal(clip.direction, Vector3.UP, "direction = %s" % bad)
	_free_catcher(catcher)


## Godot before 4.5 cannot be listened to: null.
static func _catch() -> RefCounted:
	if not ClassDB.class_exists(&"Logger"):
		return null
	var catcher: RefCounted = load("res://message_catcher.gd").new()
	OS.call(&"add_logger", catcher)
	return catcher


static func _messages(catcher: RefCounted) -> PackedStringArray:
	return catcher.get("messages") if catcher != null else PackedStringArray()


static func _heard(catcher: RefCounted, word: String) -> bool:
	return catcher == null or "\n".join(_messages(catcher)).contains(word)


static func _forget(catcher: RefCounted) -> void:
	if catcher != null:
		catcher.set("messages", PackedStringArray())


static func _free_catcher(catcher: RefCounted) -> void:
	if catcher != null:
		OS.call(&"remove_logger", catcher)


static func _glide(from_hz: float, to_hz: float, seconds: float) -> AudioStreamWAV:
	var stream: AudioStreamWAV = tone(from_hz, seconds)
	var bytes: PackedByteArray = stream.data
	for i: int in bytes.size() / 2:
		var time_s: float = i / 22050.0
		var phase: float = TAU * (from_hz * time_s + 0.5 * (to_hz - from_hz) / seconds * time_s * time_s)
		bytes.encode_s16(2 * i, roundi(26000.0 * sin(phase)))
	stream.data = bytes
	return stream
