"""generate.py on inputs that it must refuse with a sentence, made from a small invented API."""

import contextlib
import copy
import io
import json
import sys
from pathlib import Path

BINDING = Path(__file__).resolve().parent.parent.parent / "gdextension" / "binding"
sys.path.insert(0, str(BINDING))
import api_dump  # noqa: E402
import generate  # noqa: E402


def small_api():
    """The least that generate.py works on: the opaque types, one class with one method."""
    def opaque(name):
        return {"name": name, "constructors": [
            {"index": 0}, {"index": 1, "arguments": [{"name": "from", "type": name}]}]}
    method = {"name": "turn", "hash": 7, "arguments": [
        {"name": "angle", "type": "float", "meta": "double", "default_value": "1.5"}],
        "return_value": {"type": "int", "meta": "int32"}, "is_const": True}
    return {
        "header": {"version_major": 4, "version_minor": 5, "version_patch": 0,
                   "precision": "single"},
        "builtin_class_sizes": [{"build_configuration": "float_64",
                                 "sizes": [{"name": "Variant", "size": 24}]}],
        "global_enums": [], "utility_functions": [], "singletons": [],
        "builtin_classes": [opaque(name) for name in api_dump.OPAQUE_TYPES],
        "classes": [{"name": "Object", "methods": [method, {
            "name": "odd", "hash": 8, "arguments": [{"name": "where", "type": "AABB"}]}]}],
    }


def outcome(folder, api, classes):
    """(exit code, what was printed, output folder)."""
    folder.mkdir(exist_ok=True)
    (folder / "api.json").write_text(api if isinstance(api, str) else json.dumps(api))
    (folder / "header.h").write_text("// header\n")
    (folder / "classes.txt").write_text(classes)
    printed = io.StringIO()
    with contextlib.redirect_stderr(printed):
        code = generate.main([str(folder / name) for name in
                              ("api.json", "header.h", "classes.txt", "out")])
    return code, printed.getvalue(), folder / "out"


def run(check, scratch):
    def refused(name, api, classes, *words):
        code, printed, _ = outcome(scratch / "generator", api, classes)
        check(code == 1 and all(word in printed for word in words), f"{name}: {code} {printed}")

    good = small_api()
    code, printed, out = outcome(scratch / "generator", good, "class Object turn # comment\n")
    check(code == 0, f"a small API is accepted: {printed}")
    header = (out / "include" / "godot_cpp" / "classes" / "object.hpp").read_text()
    check("int32_t turn(double p_angle = 1.5) const;" in header, "declaration with its types")
    body = (out / "src" / "engine_api.cpp").read_text()
    check('method("Object", "turn", 7)' in body, "looked up by name and hash")

    refused("unknown method", good, "class Object fly\n", "Object.fly", "classes.txt")
    refused("unknown class", good, "class Phantom\n", "classes.txt:1", "Phantom")
    refused("unknown line", good, "\nstruct Object\n", "classes.txt:2")
    refused("type that is not carried", good, "class Object odd\n", "Object.odd", "AABB")
    refused("unknown utility", good, "class Object\nutility shout\n", "shout")
    refused("no JSON", "nonsense", "class Object\n", "api.json", "--dump-extension-api")
    old = copy.deepcopy(good)
    old["header"]["version_minor"] = 3
    refused("an older API", old, "class Object\n", "4.3", "4.4")
    double = copy.deepcopy(good)
    double["header"]["precision"] = "double"
    refused("double precision", double, "class Object\n", "single precision")
    other = copy.deepcopy(good)
    other["builtin_classes"][0]["constructors"][1]["arguments"][0]["type"] = "int"
    refused("other constructors", other, "class Object\n", "String")
