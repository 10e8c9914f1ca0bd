## Two SpidarG nodes of one game, each on a device of its own behind /dev/hidraw, and a third that finds its device
## taken. Each check prints a line; the last line is "two devices: N checks, M failed".
extends SceneTree

const FORCE_N: float = 3.0
const LIMIT_S: float = 10.0
const SERIALS: Array[String] = ["VM-1", "VM-2"]

var _checks: int = 0
var _failed: int = 0
## Node: the force it asks for.
var _pulling: Dictionary[SpidarG, Vector3] = {}


func _initialize() -> void:
	if not ClassDB.class_exists("SpidarG"):
		print("two devices: the extension is not loaded")
		quit(1)
		return
	_run()


func _physics_process(_delta: float) -> bool:
	for device: SpidarG in _pulling:
		device.request_wrench(_pulling[device], Vector3.ZERO, 0.0)
	return false


func _run() -> void:
	var devices: Array[SpidarG] = []
	for serial: String in SERIALS:
		devices.append(_node(serial))
	for i: int in 2:
		_check(await _until(_is_real.bind(devices[i])), "node %d is on a real device" % i)
		_check(devices[i].get_device_info()["serial"] == SERIALS[i], "node %d has its own serial" % i)
		_check(devices[i].zero_device(), "node %d zeroes its device" % i)
	await _seconds(0.2)
	for device: SpidarG in devices:
		device.forces_enabled = true
		device.arm()
	_pulling = {devices[0]: FORCE_N * Vector3.UP, devices[1]: FORCE_N * Vector3.DOWN}
	for i: int in 2:
		_check(await _until(_is_active.bind(devices[i])), "node %d is active, not %s %s" % [
			i, devices[i].get_state_text(), devices[i].get_fault_text()])
	await _seconds(0.5)
	# The C++ side reads the motors meanwhile.
	print("two devices: both pull")
	var lowest: Array[float] = [INF, INF]
	var highest: Array[float] = [-INF, -INF]
	var first: Array[int] = [_reports(devices[0]), _reports(devices[1])]
	var from_us: int = Time.get_ticks_usec()
	while Time.get_ticks_usec() - from_us < 2_000_000:
		await physics_frame
		for i: int in 2:
			var y: float = devices[i].get_grip_transform().origin.y
			lowest[i] = minf(lowest[i], y)
			highest[i] = maxf(highest[i], y)
	var seconds: float = 1e-6 * (Time.get_ticks_usec() - from_us)
	for i: int in 2:
		var up: float = 1.0 if i == 0 else -1.0
		_check(_is_active(devices[i]), "node %d stays active" % i)
		var given: float = up * devices[i].get_achieved_wrench()[1]
		_check(absf(given - FORCE_N) < 0.2, "node %d gives %.3f N for %.1f" % [i, given, FORCE_N])
		# The device's grip moves 5 mm up and down.
		_check(absf(highest[i] - lowest[i] - 0.01) < 0.001, "node %d moves by %.4f m" % [
			i, highest[i] - lowest[i]])
		var rate: float = (_reports(devices[i]) - first[i]) / seconds
		_check(rate > 990.0 and rate < 1010.0, "node %d reads %.1f reports a second" % [i, rate])
		_check(devices[i].get_device_info()["reports_lost"] == 0, "node %d lost no report" % i)
	var third: SpidarG = _node(SERIALS[0])
	await _seconds(0.5)
	_check(not _is_real(third), "a third node does not get the first one's device")
	third.queue_free()
	# One leaves; the other plays on.
	_pulling.erase(devices[0])
	devices[0].queue_free()
	await _seconds(0.5)
	print("two devices: one left")
	await _seconds(0.5)
	_check(_is_active(devices[1]), "the second node plays on when the first is freed")
	print("two devices: %d checks, %d failed" % [_checks, _failed])
	quit(0 if _failed == 0 else 1)


func _node(serial: String) -> SpidarG:
	var device := SpidarG.new()
	device.config = SpidarGConfig.new()
	device.config.transport = SpidarGConfig.TRANSPORT_DEVICE
	device.config.device_product = "SPIDAR-G model"
	device.config.device_serial = serial
	device.release_on_focus_loss = false
	root.add_child(device)
	return device


func _reports(device: SpidarG) -> int:
	return device.get_device_info()["reports"]


func _is_real(device: SpidarG) -> bool:
	return device.get_state() != SpidarG.STATE_CLOSED and not device.get_device_info()["simulated"] \
		and device.get_device_info().get("reports", 0) > 0


func _is_active(device: SpidarG) -> bool:
	return device.get_state() == SpidarG.STATE_ACTIVE


func _until(condition: Callable) -> bool:
	var from_us: int = Time.get_ticks_usec()
	while not condition.call() and Time.get_ticks_usec() - from_us < 1e6 * LIMIT_S:
		await physics_frame
	return condition.call()


func _seconds(duration: float) -> void:
	var from_us: int = Time.get_ticks_usec()
	while Time.get_ticks_usec() - from_us < 1e6 * duration:
		await physics_frame


func _check(good: bool, what: String) -> void:
	_checks += 1
	_failed += 0 if good else 1
	print("%s %s" % ["good:" if good else "WRONG:", what])
