extends RefCounted
## How much the picture may cost. Full is for a GPU; plain, a sixth of the work, keeps a computer without one playable.

const AUTOMATIC := "automatic"
const FULL := "full"
const PLAIN := "plain"
const CHOICES: PackedStringArray = [AUTOMATIC, FULL, PLAIN]
## Part of the names of renderers that draw on the processor.
const SOFTWARE_RENDERERS: PackedStringArray = ["llvmpipe", "softpipe", "swiftshader", "basic render"]
const PLAIN_SCALE_3D := 0.5


## Sets the window and the lights below `scene`.
static func apply(scene: Node, choice: String) -> void:
	var plain := is_plain(choice, RenderingServer.get_video_adapter_name())
	var viewport := scene.get_viewport()
	viewport.msaa_3d = Viewport.MSAA_DISABLED if plain else Viewport.MSAA_4X
	viewport.scaling_3d_scale = PLAIN_SCALE_3D if plain else 1.0
	for light in scene.find_children("*", "DirectionalLight3D", true, false):
		(light as DirectionalLight3D).shadow_enabled = not plain and light.name == &"KeyLight"


static func is_plain(choice: String, adapter: String) -> bool:
	if choice != AUTOMATIC:
		return choice == PLAIN
	for name in SOFTWARE_RENDERERS:
		if adapter.to_lower().contains(name):
			return true
	return false
