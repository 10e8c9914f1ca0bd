## The diagnosis panel and the monitors: they show what the device says, and rest while nobody looks.
extends "res://test_case.gd"

const PlotStrip := preload("res://addons/spidar_g/nodes/plot_strip.gd")

const PANEL: String = "res://addons/spidar_g/nodes/spidar_g_panel.tscn"


func test_the_panel_plots_what_the_device_does() -> void:
	var device := ideal_device()
	device.forces_enabled = true
	add(device)
	var panel: SpidarGPanel = load(PANEL).instantiate()
	panel.device = device
	add(panel)
	await physics_frames(75)
	device.request_wrench(Vector3(0, 2, 0), Vector3.ZERO, 0.0, 0.5)
	await physics_frames(10)
	var force: Control = panel.get_node("%Force")
	var tensions: Control = panel.get_node("%Tensions")
	check(force.get_sample_count() > 0, "samples are taken")
	var asked: PackedFloat32Array = force.get_curve(1)
	check_near(asked[asked.size() - 1], 2.0, 1e-4, "the force asked for along y")
	var given: PackedFloat32Array = force.get_curve(4)
	check_near(given[given.size() - 1], device.get_achieved_wrench()[1], 1e-4, "the force given along y")
	var first: PackedFloat32Array = tensions.get_curve(0)
	check_near(first[first.size() - 1], device.get_string_tensions()[0], 1e-4, "the first tension")
	check(panel.get_events().size() > 0, "arming is told")
	check("\n".join(panel.get_events()).contains("armed"), "by its name: %s" % panel.get_events())
	device.inject_simulated_fault(SpidarG.FAULT_UNPLUGGED)
	await physics_frames(3)
	check("\n".join(panel.get_events()).contains("lost"), "so is the loss: %s" % panel.get_events())
	panel.free()
	check_equal(device.device_lost.get_connections().size(), 0, "no listener stays behind")
	device.free()


func test_a_hidden_panel_computes_nothing() -> void:
	var device := ideal_device()
	add(device)
	var layer := CanvasLayer.new()
	var panel: SpidarGPanel = load(PANEL).instantiate()
	panel.device = device
	layer.add_child(panel)
	add(layer)
	await frames(3)
	check(panel.is_processing(), "shown: it runs")
	var force: Control = panel.get_node("%Force")
	for hide: Callable in [
		func(hidden: bool) -> void: panel.visible = not hidden,
		func(hidden: bool) -> void: layer.visible = not hidden,
	]:
		hide.call(true)
		await frames(1)
		check(not panel.is_processing(), "hidden: it rests")
		var before: int = force.get_sample_count()
		await frames(5)
		check_equal(force.get_sample_count(), before, "no sample is taken")
		hide.call(false)
		await frames(3)
		check(force.get_sample_count() > before, "shown again: it runs")
	layer.free()
	device.free()


func test_the_panel_records() -> void:
	var device := ideal_device()
	add(device)
	var panel: SpidarGPanel = load(PANEL).instantiate()
	device.add_child(panel) # no device set: the parent is taken
	await physics_frames(5)
	check_equal(panel.device, device, "the parent is the device")
	panel.toggle_recording()
	check(device.is_recording(), "it records")
	await physics_frames(30)
	panel.toggle_recording()
	check(not device.is_recording(), "it has stopped")
	check(FileAccess.file_exists(panel.recording_path), "the file is there: %s" % panel.recording_path)
	check(device.start_replay(panel.recording_path), "and can be played")
	device.stop_replay()
	DirAccess.remove_absolute(panel.recording_path)
	device.free()


func test_recordings_of_one_second_have_files_of_their_own() -> void:
	var panels: Array[SpidarGPanel] = []
	for _i: int in 2:
		var device := ideal_device()
		add(device)
		var panel: SpidarGPanel = load(PANEL).instantiate()
		device.add_child(panel)
		panels.append(panel)
	await physics_frames(2)
	var paths: PackedStringArray = []
	for _round: int in 2:
		for panel: SpidarGPanel in panels:
			panel.toggle_recording()
			check(not paths.has(panel.recording_path), "a name of its own: %s" % panel.recording_path)
			paths.append(panel.recording_path)
		await physics_frames(5)
		for panel: SpidarGPanel in panels:
			panel.toggle_recording()
	for path: String in paths:
		check(FileAccess.file_exists(path), "kept: %s" % path)
		DirAccess.remove_absolute(path)
	for panel: SpidarGPanel in panels:
		panel.get_parent().free()


func test_the_histogram_keeps_every_wake_up() -> void:
	var device := SpidarG.new()
	add(device)
	await until(func() -> bool: return device.get_statistics()["ticks"] > 100)
	var counts: PackedInt32Array = device.get_lateness_histogram()
	check_equal(counts.size(), 64, "buckets")
	var total: int = 0
	for count: int in counts:
		total += count
	check(total > 100, "wake-ups are counted: %d" % total)
	var plot: Control = load("res://addons/spidar_g/nodes/jitter_plot.gd").new()
	plot.show_counts(counts)
	var shown: int = 0
	for count: int in plot.bars():
		shown += count
	check_equal(shown, total, "every one stands in a bar")
	plot.free()
	device.enabled = false
	check_equal(device.get_lateness_histogram().size(), 0, "closed: none")
	device.free()


func test_monitors_are_there_while_wanted() -> void:
	var device := ideal_device()
	add(device)
	check(not Performance.has_custom_monitor(&"spidar_g/servo_rate_hz"), "none before")
	var monitors := SpidarGMonitors.new()
	device.add_child(monitors)
	check_equal(monitors.get_monitor_names().size(), 7, "monitors of a simulated device")
	check_near(Performance.get_custom_monitor(&"spidar_g/servo_rate_hz"), 1000.0, 1e-6, "servo rate")
	await physics_frames(5)
	check_equal(Performance.get_custom_monitor(&"spidar_g/saturated_percent"), 0.0, "saturation")
	device.inject_simulated_fault(SpidarG.FAULT_COUNT_JUMP, 2)
	await physics_frames(3)
	check_equal(Performance.get_custom_monitor(&"spidar_g/faults"), 1.0, "faults")
	var second := ideal_device()
	second.config.device_name = "second"
	second.name = "Second"
	add(second)
	var more := SpidarGMonitors.new()
	second.add_child(more)
	check(Performance.has_custom_monitor(&"spidar_g Second/faults"), "a second device has its own")
	device.free()
	check(not Performance.has_custom_monitor(&"spidar_g/servo_rate_hz"), "none after")
	check(Performance.has_custom_monitor(&"spidar_g Second/faults"), "the second's stay")
	second.free()
	check(not Performance.has_custom_monitor(&"spidar_g Second/faults"), "until it goes")


## The last one stands near the plot's end: it was cut to 1000 there.
func test_every_decade_of_the_histogram_has_its_whole_label() -> void:
	var plot: Control = load("res://addons/spidar_g/nodes/jitter_plot.gd").new()
	add(plot)
	for width: float in [180.0, 240.0, 612.0]:
		plot.size = Vector2(width, 90.0)
		var placed: Dictionary[String, Vector2] = plot.labels(Rect2(4.0, 18.0, width - 8.0, 56.0))
		check_equal(placed.keys(), ["1", "10", "100", "1000", "10000"], "the decades, %d wide" % width)
		var font: Font = plot.get_theme_default_font()
		for text: String in placed:
			var wide: float = font.get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, PlotStrip.FONT_SIZE).x
			var left: float = placed[text].x
			check(left >= 0.0 and left + wide <= width, "%s whole, %d wide: at %.1f" % [text, width, left])
