extends RefCounted
## The colours of the display, and how ghosts and outlines are drawn. Those of the things are in scene/materials/.

const TRACK := Color(1, 1, 1, 0.10)
const TEXT := Color("ece8de")
const TEXT_SOFT := Color("9aa5b5")
const ACCENT := Color("f2b84b")
const GOOD := Color("7ccf9a")
const BAD := Color("ef6f6c")
const ASKED := Color("8ab4d8")
const GIVEN := Color("f2b84b")


## A plain, see-through surface: outlines and ghosts.
static func flat(colour: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	return material
