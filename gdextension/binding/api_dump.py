"""The engine's API dump, and what classes.txt wants of it: what generate.py writes from."""

import json
import re
from pathlib import Path

# Structs that the binding defines in C++, and the engine's opaque types that it wraps.
MATH_TYPES = [
    "Vector2", "Vector3", "Quaternion", "Basis", "Transform3D", "Color", "Plane", "RID",
]
OPAQUE_TYPES = [
    "String", "StringName", "NodePath", "Callable", "Dictionary", "Array",
    "PackedByteArray", "PackedInt32Array", "PackedInt64Array", "PackedFloat32Array",
    "PackedFloat64Array", "PackedStringArray", "PackedVector2Array", "PackedVector3Array",
]
META_TYPES = {
    "int8": "int8_t", "int16": "int16_t", "int32": "int32_t", "int64": "int64_t",
    "uint8": "uint8_t", "uint16": "uint16_t", "uint32": "uint32_t", "uint64": "uint64_t",
    "float": "float", "double": "double",
}
LOWEST_VERSION = (4, 4)  # the first with classdb_construct_object2 and the like


class ApiError(Exception):
    """An input that the binding cannot be built from; the text says what to change."""


class Api:
    """The dump, and what classes.txt wants of it."""

    def __init__(self, api_path, list_path):
        try:
            self.data = json.loads(Path(api_path).read_text(encoding="utf-8"))
            self.header = self.data["header"]
        except (OSError, ValueError, KeyError) as error:
            raise ApiError(f"{api_path} is no API dump of Godot ({error}). "
                           "Make one with: godot --headless --dump-extension-api") from error
        version = (self.header["version_major"], self.header["version_minor"])
        if version < LOWEST_VERSION:
            raise ApiError(f"{api_path} is of Godot {version[0]}.{version[1]}; "
                           "the binding needs the API of 4.4 or later.")
        if self.header.get("precision", "single") != "single":
            raise ApiError(f"{api_path} is of a double precision Godot; "
                           "use the dump of a single precision one.")
        self.classes = {c["name"]: c for c in self.data["classes"]}
        self.builtins = {b["name"]: b for b in self.data["builtin_classes"]}
        self.utilities = {u["name"]: u for u in self.data["utility_functions"]}
        self.singletons = {s["name"] for s in self.data["singletons"]}
        self.wanted = {"class": {}, "builtin": {}, "utility": {}}
        for number, line in enumerate(Path(list_path).read_text(encoding="utf-8").splitlines(), 1):
            self.read_line(f"{list_path}:{number}", line.split("#")[0].split())
        for name in OPAQUE_TYPES:
            self.wanted["builtin"].setdefault(name, [])
            self.check_constructors(name)

    def read_line(self, place, words):
        if not words:
            return
        if words[0] == "utility":
            self.wanted["utility"].update(dict.fromkeys(words[1:]))
        elif words[0] in ("class", "builtin") and len(words) > 1:
            known = self.classes if words[0] == "class" else self.builtins
            if words[1] not in known:
                raise ApiError(f"{place}: this Godot has no {words[0]} {words[1]}.")
            self.wanted[words[0]].setdefault(words[1], []).extend(words[2:])
        else:
            raise ApiError(f"{place}: begin with class NAME, builtin NAME or utility.")

    def check_constructors(self, name):
        """The binding counts on constructor 0 taking nothing and 1 copying."""
        constructors = {c["index"]: c.get("arguments", [])
                        for c in self.builtins[name]["constructors"]}
        if constructors[0] or [a["type"] for a in constructors[1]] != [name]:
            raise ApiError(f"The constructors of {name} are not those that the binding knows.")

    def parent(self, name):
        return self.classes[name].get("inherits", "")

    def is_counted(self, name):
        while name and name != "RefCounted":
            name = self.parent(name)
        return bool(name)

    def depth(self, name):
        return 0 if not name else 1 + self.depth(self.parent(name))

    def find(self, owner, kind, name):
        if kind == "utility":
            if name not in self.utilities:
                raise ApiError(f"This Godot has no utility function {name}.")
            return self.utilities[name]
        description = (self.classes if kind == "class" else self.builtins)[owner]
        for method in description.get("methods", []):
            if method["name"] == name:
                return method
        raise ApiError(f"This Godot has no method {owner}.{name} (listed in classes.txt).")

    def cpp_type(self, api_type, meta, where):
        """The C++ type by value of an API type."""
        if api_type in ("int", "float"):
            return META_TYPES.get(meta, "int64_t" if api_type == "int" else "double")
        if api_type in ("bool", "Variant") or api_type in MATH_TYPES + OPAQUE_TYPES:
            return api_type
        if api_type.startswith("typedarray::"):
            element = api_type[len("typedarray::"):]
            if element in self.builtins or element in self.wanted["class"]:
                return f"TypedArray<{element}>"
        if api_type.startswith("enum::"):
            name = api_type[len("enum::"):].replace(".", "::")
            if "::" in name and name.split("::")[0] not in self.wanted["class"]:
                if not name.startswith("Variant::"):
                    raise ApiError(f"{where} uses the enum {name} of a class not in classes.txt.")
            return name
        if api_type in self.wanted["class"]:
            return f"Ref<{api_type}>" if self.is_counted(api_type) else f"{api_type} *"
        raise ApiError(f"{where} uses the type {api_type}, which the binding does not carry: "
                       "take it out of classes.txt or teach the binding that type.")

    def default(self, text, cpp, where):
        """A default value as C++."""
        if cpp == "float":
            return f"{text}F" if "." in text else text
        if cpp in ("bool", "double") or cpp.endswith("_t"):
            return text
        if text == "null":
            return {"Variant": "Variant()"}.get(cpp, "nullptr" if cpp.endswith("*") else cpp + "()")
        if re.fullmatch(r"-?\d+", text) and cpp != "Variant":
            return f"static_cast<{cpp}>({text})"
        if re.fullmatch(r'&?"[^"\\]*"', text) and cpp in ("String", "StringName"):
            return f"{cpp}({text.lstrip('&')})"
        identity = "Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)"
        if text in ("[]", "{}", 'NodePath("")', f"{cpp}()", "Vector3(0, 0, 0)", identity):
            return f"{cpp}()"
        if re.fullmatch(r"-?[\d.]+|true|false", text):
            return f"Variant({text})"
        raise ApiError(f"{where} has the default value {text}, which the binding does not know.")
