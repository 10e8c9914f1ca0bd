class_name PictureTaker
extends Node
## Saves what the window shows as PNG files. Between pictures it draws nothing, so a scripted play under
## a software renderer stays fast; the simulation does not depend on drawing.

var folder := ""
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
