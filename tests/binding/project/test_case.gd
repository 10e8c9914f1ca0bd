extends RefCounted
## Base of the test scripts: every method that begins with test_ is one case, run in an object of its
## own. A case passes when it ran to its end and none of its checks failed.

var failures: PackedStringArray = []
var checks: int = 0
var tree: SceneTree


func check(condition: bool, what: String) -> void:
	checks += 1
	if not condition:
		failures.append(what)


func equal(got: Variant, wanted: Variant, what: String) -> void:
	check(typeof(got) == typeof(wanted) and got == wanted,
			"%s: %s instead of %s" % [what, got, wanted])


func near(got: Variant, wanted: Variant, what: String) -> void:
	var close: bool = typeof(got) == typeof(wanted)
	if close:
		match typeof(got):
			TYPE_FLOAT:
				close = is_equal_approx(got as float, wanted as float)
			TYPE_QUATERNION:
				var a: Quaternion = got
				var b: Quaternion = wanted
				close = a.is_equal_approx(b) or a.is_equal_approx(-b)
			TYPE_VECTOR3:
				close = (got as Vector3).is_equal_approx(wanted as Vector3)
			TYPE_BASIS:
				close = (got as Basis).is_equal_approx(wanted as Basis)
			TYPE_TRANSFORM3D:
				close = (got as Transform3D).is_equal_approx(wanted as Transform3D)
			_:
				close = false
	check(close, "%s: %s instead of %s" % [what, got, wanted])
