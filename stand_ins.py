"""GDScript classes with the names of the library's, for games on a system that the add-on has no library for.

Each has the properties, methods, signals and constants of the class reference, and does nothing. docs/how_to/export.md
says how a game gets them.
"""

import os
import xml.etree.ElementTree as ElementTree

HEAD = "## Written by the build from the class reference: stands in for {name} where the add-on has no library.\n"
# What a method returns, by its type; an object is null.
NOTHING = {
    "bool": "false", "int": "0", "float": "0.0", "String": '""', "Array": "[]", "Dictionary": "{}",
    "Vector2": "Vector2.ZERO", "Vector3": "Vector3.ZERO", "Basis": "Basis.IDENTITY", "Transform3D": "Transform3D.IDENTITY",
}
# The one sentence, and who says it: the first SpidarG that a game makes, and whoever asks a SpidarG how it is.
MISSING = '''
## Says what is missing; the same for all.
static func missing() -> String:
	return (
		"The SPIDAR-G add-on has no library for this system (%s on %s): no device is read, no force is given."
		% [OS.get_name(), Engine.get_architecture_name()]
	)


func _init() -> void:
	if not _told:
		_told = true
		push_warning(missing())
'''
ANSWERS = {
    ("SpidarG", "device_text"): "missing()",
    ("SpidarG", "get_state_text"): "missing()",
    ("SpidarG", "get_device_text"): "missing()",
    ("SpidarG", "get_warnings"): "[missing()]",
}


def nothing(kind):
    return NOTHING.get(kind) or (f"{kind}()" if kind.startswith("Packed") else "null")


def kind_of(element):
    """The type as GDScript writes it; an enumeration of the class itself without the name of the class."""
    return (element.get("enum") or element.get("type")).split(".")[-1] if element.get("enum") else element.get("type")


def declaration(parameters, prefix=""):
    words = []
    for parameter in parameters:
        default = parameter.get("default")
        words.append(f"{prefix}{parameter.get('name')}: {parameter.get('type')}" + (f" = {default}" if default else ""))
    return ", ".join(words)


def function(name, parameters, kind, answer, static=False):
    body = "pass" if kind == "void" else f"return {answer}"
    return f"\n\n{'static ' if static else ''}func {name}({parameters}) -> {kind}:\n\t{body}\n"


def stand_in(root):
    """The text of one class."""
    name = root.get("name")
    text = HEAD.format(name=name) + f"class_name {name}\nextends {root.get('inherits')}\n\n"
    for signal in root.iter("signal"):
        text += f"signal {signal.get('name')}({declaration(signal.iter('param'))})\n"
    constants = list(root.iter("constant"))
    for enumeration in dict.fromkeys(constant.get("enum") for constant in constants if constant.get("enum")):
        members = (f"{c.get('name')} = {c.get('value')}" for c in constants if c.get("enum") == enumeration)
        text += f"enum {enumeration} {{ {', '.join(members)} }}\n"
    for constant in constants:
        kind = constant.get("enum")
        value = f"{kind}.{constant.get('name')}" if kind else constant.get("value")
        text += f"const {constant.get('name')}: {kind or 'int'} = {value}\n"
    members = [member for member in root.iter("member") if not member.get("overrides")]
    for member in members:
        value = ANSWERS.get((name, member.get("name"))) or member.get("default") or nothing(member.get("type"))
        text += f"@export var {member.get('name')}: {kind_of(member)} = {value}\n"
    if name == "SpidarG":
        text += "static var _told: bool = false\n\n" + MISSING
    methods = list(root.iter("method"))
    written = {method.get("name") for method in methods}
    for member in members:
        kind, names = kind_of(member), (member.get("setter"), member.get("getter"))
        if names[0] and names[0] not in written:
            text += f"\n\nfunc {names[0]}(value: {kind}) -> void:\n\t{member.get('name')} = value\n"
        if names[1] and names[1] not in written:
            text += function(names[1], "", kind, member.get("name"))
    for method in methods:
        result = method.find("return")
        kind = kind_of(result)
        answer = ANSWERS.get((name, method.get("name"))) or nothing(result.get("type"))
        if result.get("enum"):
            answer = f"{answer} as {kind}"
        text += function(method.get("name"), declaration(method.iter("param"), "_"), kind, answer,
                         "static" in (method.get("qualifiers") or ""))
    return text


def file_name(reference):
    """SpidarGConfig.xml -> spidar_g_config.gd"""
    name = os.path.splitext(os.path.basename(reference))[0]
    return name.replace("SpidarG", "Spidar_G_").strip("_").lower() + ".gd"


def write_stand_ins(target, source, env):
    """The build's action: a class of each reference, in the same order."""
    for node, reference in zip(target, source):
        with open(str(node), "w", encoding="utf-8") as file:
            file.write(stand_in(ElementTree.parse(str(reference)).getroot()))
