extends RefCounted
## The demo's few colours: a dim studio, a slate table, matte objects, one amber accent.

const BACKDROP_TOP := Color("151a23")
const BACKDROP_HORIZON := Color("39455a")
const TABLE := Color("4a5464")
const STAND := Color("2b3340")
const PANEL := Color(0.075, 0.094, 0.129, 0.86)
const TRACK := Color(1, 1, 1, 0.10)
const TEXT := Color("ece8de")
const TEXT_SOFT := Color("9aa5b5")
const ACCENT := Color("f2b84b")
const GOOD := Color("7ccf9a")
const BAD := Color("ef6f6c")
const ASKED := Color("8ab4d8")
const GIVEN := Color("f2b84b")

const CORAL := Color("e0694f")
const MUSTARD := Color("e3ae3c")
const TEAL := Color("3fa79b")
const BLUE := Color("4f83d1")
const PLUM := Color("9a6bb8")
const SAGE := Color("93b86a")
const BONE := Color("e6dcc6")


## A plain, see-through surface: outlines and ghosts.
static func flat(colour: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.transparency = BaseMaterial3D.TRANSPARENCY_ALPHA
	material.shading_mode = BaseMaterial3D.SHADING_MODE_UNSHADED
	return material


static func matte(colour: Color) -> StandardMaterial3D:
	var material := StandardMaterial3D.new()
	material.albedo_color = colour
	material.roughness = 0.8
	return material
