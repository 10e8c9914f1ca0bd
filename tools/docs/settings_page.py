#!/usr/bin/env python3
"""settings_page.py GODOT [--check]: writes docs/reference/settings.md.

Names, ranges, units and defaults come from the library that Godot loads, the meanings from the first sentence of the class help,
and "live" from the macro with which spidar_g_config.h declares a property. --check writes nothing and fails when the page is
not what would be written.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests"))
import class_help  # noqa: E402
from godot_project import prepare_project  # noqa: E402

PAGE = os.path.join(ROOT, "docs", "reference", "settings.md")
MARK = "SETTINGS "
TIME_LIMIT_S = 60
HINT_RANGE, HINT_ENUM, HINT_LAYERS = 1, 2, 11  # values of Godot's PropertyHint

# Godot has no help for project settings; the meanings stand here.
PROJECT_MEANINGS = {
    "spidar_g/device/default_config": "The `SpidarGConfig` of every `SpidarG` that has no config of its own.",
    "spidar_g/device/use_hardware":
        "If off, a config with the transport Automatic opens the simulated device even when a real device is plugged in.",
    "spidar_g/hand/default_material": "The `SpidarGMaterial` of every body that has no material of its own.",
    "spidar_g/safety/max_force":
        "Upper bound of every `SpidarGConfig.max_force`. A larger value in a config counts as this one, and the node warns.",
    "spidar_g/safety/panic_key":
        "The key, by its place on the keyboard, that calls `panic_stop()` of every device. While a key is set, the input "
        "action `spidar_g_panic` exists and takes further events.",
}

TOP = """# Settings

For users who look up one setting, and for engineers who need a default. After reading, you know what each setting means, its unit, its range and its default, and whether it may change while a device is open. Symbols and terms: [glossary](glossary.md).

This page is written by a script from the library and the class help: `python3 tools/docs/settings_page.py $GODOT`, where `$GODOT` is the path of a Godot 4.4 or later. The same command with `--check` tells whether the page is current.

* The inspector shows the unit behind the value, and the tables show it in the column of the range. The name of a property carries no unit, except for the frequencies of `SpidarGConfig` (`_hz`).
* An angle is in radians in a script and in degrees in the inspector.
* "or more" and "or less" after a range mean that the slider of the inspector ends there, but that values beyond it can be typed. The class help and the message of a refused value say which values are accepted.
* Lengths and stiffnesses are those of the device, not of the scene: `SpidarG.workspace_scale` does not act on them.
* An array with one value for each string is empty or has eight values, for the strings 0 to 7.
"""

CONFIG = """
## SpidarGConfig

The resource in `SpidarG.config`. If a value is out of range or contradicts another one, `SpidarGConfig.get_problem()` returns a sentence with field, value, unit and remedy. A device does not open with such a config, and an open device keeps its last good settings.

"Live" means that an open device uses the new value without being closed. "Reopens" means that the device is closed and opened anew: a held body is dropped, and a real device must be armed again.
"""

HAND = """
## SpidarGHand

The node below a `SpidarG` that touches and grasps bodies. Each of these properties may change while the device is open; the next physics tick uses the new value. A value outside the accepted range is refused with a message, whether it comes from the inspector or from a script.
"""

PROJECT = """
## Project settings

*Project > Project Settings > General > Spidar G*. These settings hold for every `SpidarG` of the project. A `SpidarG` and a `SpidarGHand` read them when they enter the scene tree. A `SpidarG` also reads them when it opens its device.
"""


def dump(godot):
    with tempfile.TemporaryDirectory() as project:
        with open(os.path.join(project, "project.godot"), "w", encoding="utf-8") as file:
            file.write("config_version=5\n")
        prepare_project(project)
        done = subprocess.run(
            [godot, "--headless", "--path", project, "-s", os.path.join(HERE, "dump_settings.gd")],
            timeout=TIME_LIMIT_S, stdout=subprocess.PIPE, text=True, check=True, stdin=subprocess.DEVNULL)
    line = next(line for line in done.stdout.splitlines() if line.startswith(MARK))
    return json.loads(line[len(MARK):])


def as_markdown(text):
    text = re.sub(r"\[method ([\w.]+)\]", r"`\1()`", text)
    text = re.sub(r"\[(?:member|constant|enum|signal|param) ([\w.]+)\]", r"`\1`", text)
    text = re.sub(r"\[code\](.*?)\[/code\]", r"`\1`", text)
    return re.sub(r"\[(\w+)\]", r"`\1`", text)


def meanings(class_name):
    """The first sentence of each member's help."""
    path = os.path.join(class_help.LIBRARY, class_name + ".xml")
    members = [item for item in class_help.read_class(path).items if item.kind == "member"]
    found = {}
    for member in members:
        first = re.split(r"(?<=[.])\s", " ".join(member.text.split()), maxsplit=1)[0]
        first = re.sub(r":\s-\s.*", ".", first)  # a list follows
        found[member.name] = as_markdown(first).replace("|", "\\|")
    return found


def live_properties():
    with open(os.path.join(ROOT, "gdextension/godot/settings/spidar_g_config.h"), encoding="utf-8") as file:
        return set(re.findall(r"SPIDAR_G_LIVE_FIELD\([^,]+,\s*(\w+)", file.read()))


def script_ranges():
    with open(os.path.join(ROOT, "gdextension/godot/hand/spidar_g_hand.h"), encoding="utf-8") as file:
        rows = re.findall(r'SPIDAR_G_HAND_NUMBER\((\w+), [^,]+, ([^,]+), ([^,]+), "', file.read())
    return {name: f"{float(low):g} to {float(high):g}" for name, low, high in rows}


def number(value):
    return f"{value:.6g}"


def with_unit(text, unit):
    return f"{text} {unit}" if unit else text


def split_range(hint_string):
    """low, high, unit, whether the value is shown in degrees, and the words for values beyond that can be typed."""
    low, high, *options = hint_string.split(",")
    unit = next((option[len("suffix:"):] for option in options if option.startswith("suffix:")), "")
    beyond = (" or less" if "or_less" in options else "") + (" or more" if "or_greater" in options else "")
    return float(low), float(high), unit, "radians_as_degrees" in options, beyond


def shown_range(entry):
    if entry["hint"] == HINT_RANGE:
        low, high, unit, degrees, beyond = split_range(entry["hint_string"])
        return with_unit(f"{number(low)} to {number(high)}", "degrees" if degrees else unit) + beyond
    if entry["hint"] == HINT_ENUM and entry["type"] == "int":
        choices = [choice.split(":")[0] for choice in entry["hint_string"].split(",")]
        return ", ".join(choices)
    if entry["hint"] == HINT_LAYERS:
        return "32 layers, one bit each"
    if entry["type"] == "Vector3":
        return "each axis above 0 " + entry["hint_string"][len("suffix:"):]
    kinds = {"bool": "on or off", "String": "text", "PackedInt32Array": "32 whole numbers or none",
             "PackedFloat64Array": "8 numbers or none"}
    if entry["hint_string"].startswith("*."):
        return "path of a resource"
    unit = entry["hint_string"].removeprefix("suffix:")
    return kinds[entry["type"]] + (f", in {unit}" if unit and entry["type"].startswith("Packed") else "")


def shown_default(entry):
    value = entry["default"]
    if entry["type"] == "bool":
        return "on" if value else "off"
    if entry["hint"] == HINT_ENUM and entry["type"] == "int":
        names = {}
        for index, choice in enumerate(entry["hint_string"].split(",")):
            name, _, key = choice.partition(":")
            names[int(key) if key else index] = name
        return names[int(value)]
    if entry["hint"] == HINT_RANGE:
        _, _, unit, degrees, _ = split_range(entry["hint_string"])
        if degrees:
            return f"{number(math.degrees(value))} degrees ({value:.4f} rad)"
        return with_unit(number(value), unit)
    if entry["type"] == "String":
        return f"`{value}`" if value else "empty"
    if entry["type"] == "int":
        return str(int(value))
    if entry["type"].startswith("Packed"):
        return "none"
    unit = entry["hint_string"][len("suffix:"):] if entry["hint_string"].startswith("suffix:") else ""
    return with_unit(str(value).replace("Vector3", ""), unit)


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def by_group(entries):
    groups = [("General", [])]
    for entry in entries:
        if "group" in entry:
            groups.append((entry["group"], []))
        else:
            groups[-1][1].append(entry)
    return [(title, members) for title, members in groups if members]


def config_tables(entries):
    told, live = meanings("SpidarGConfig"), live_properties()
    for title, members in by_group(entries):
        rows = [(f"`{entry['name']}`", told[entry["name"]], shown_range(entry), shown_default(entry),
                 "live" if entry["name"] in live else "reopens") for entry in members]
        yield f"\n### {title}\n" + table(("property", "meaning", "range in the inspector, and unit", "default", "change while open"), rows)


def hand_tables(entries):
    told, script = meanings("SpidarGHand"), script_ranges()
    for title, members in by_group(entries):
        rows = [(f"`{entry['name']}`", told[entry["name"]], shown_range(entry), script.get(entry["name"], "the same"),
                 shown_default(entry)) for entry in members]
        yield f"\n### {title} of the hand\n" + \
            table(("property", "meaning", "range in the inspector, and unit", "accepted range", "default"), rows)


def project_table(entries):
    names = [entry["name"] for entry in entries]
    if sorted(names) != sorted(PROJECT_MEANINGS):
        raise SystemExit(f"PROJECT_MEANINGS must describe {sorted(names)}")
    rows = [(f"`{entry['name']}`", PROJECT_MEANINGS[entry["name"]], shown_range(entry), shown_default(entry))
            for entry in entries]
    return "\n" + table(("setting", "meaning", "range and unit", "default"), rows)


def page(found):
    return (TOP + CONFIG + "".join(config_tables(found["SpidarGConfig"])) + HAND +
            "".join(hand_tables(found["SpidarGHand"])) + PROJECT + project_table(found["project"]))


def main():
    if len(sys.argv) not in (2, 3) or (len(sys.argv) == 3 and sys.argv[2] != "--check"):
        sys.exit(__doc__.splitlines()[0])
    text = page(dump(sys.argv[1]))
    if len(sys.argv) == 2:
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write(text)
        print(os.path.relpath(PAGE, ROOT))
        return 0
    with open(PAGE, encoding="utf-8") as file:
        current = file.read() == text
    if not current:
        print("docs/reference/settings.md is stale: run python3 tools/docs/settings_page.py GODOT")
    print("1 passed, 0 failed" if current else "0 passed, 1 failed")
    return 0 if current else 1


if __name__ == "__main__":
    sys.exit(main())
