extends Node
## Saves what the window shows as PNG files. Between pictures it draws nothing, so a scripted play under
## a software renderer stays fast; the simulation does not depend on drawing.

## A movie's frame every so many physics ticks, at this width.
const FILM_TICKS := 36
const FILM_WIDTH_PX := 640

var folder := ""
var filming := false
var _ticks := 0
var _frames := 0
var _busy := false


func start(folder_: String) -> void:
	folder = folder_
	RenderingServer.render_loop_enabled = false


## Coroutine: returns when the file is written. Without a folder it does nothing.
func take(picture_name: String) -> void:
	if folder == "" or _busy:
		return
	_busy = true
	RenderingServer.render_loop_enabled = true
	# The first frame after the pause may still hold old canvas items.
	for frame in 3:
		await RenderingServer.frame_post_draw
	var image := get_viewport().get_texture().get_image()
	RenderingServer.render_loop_enabled = false
	var path := folder.path_join(picture_name + ".png")
	var error := image.save_png(path)
	if error != OK:
		push_error("%s cannot be written: %s" % [path, error_string(error)])
	_busy = false


func _physics_process(_delta: float) -> void:
	if not filming or folder == "":
		return
	_ticks += 1
	if _ticks % FILM_TICKS == 0 and not _busy:
		_film()


func _film() -> void:
	_busy = true
	RenderingServer.render_loop_enabled = true
	await RenderingServer.frame_post_draw
	var image := get_viewport().get_texture().get_image()
	RenderingServer.render_loop_enabled = false
	@warning_ignore("integer_division")
	image.resize(FILM_WIDTH_PX, FILM_WIDTH_PX * image.get_height() / image.get_width(), Image.INTERPOLATE_LANCZOS)
	image.save_png(folder.path_join("film_%04d.png" % _frames))
	_frames += 1
	_busy = false
