"""The library against engines that it must refuse: a small fake engine offers it an interface.

Each case runs in a process of its own: refusal_cases.py LIBRARY VERSION MISSING VERSION_FUNCTION
prints the answer of the entry function, then what it reported.
"""

import ctypes
import re
import subprocess
import sys

REPORT = ctypes.CFUNCTYPE(None, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int32,
                          ctypes.c_uint8)
VERSION = ctypes.CFUNCTYPE(None, ctypes.POINTER(ctypes.c_uint32))
ANYTHING = ctypes.CFUNCTYPE(ctypes.c_void_p)
LOOKUP = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_char_p)


def fake_engine(library, version, missing, version_function):
    """Runs the entry function; returns its answer and the texts reported. `version`: three numbers."""
    reports = []

    @REPORT
    def report(text, _function, _file, _line, _notify):
        reports.append(text.decode())

    @VERSION
    def tell_version(place):
        for i, part in enumerate(version):
            place[i] = part

    @ANYTHING
    def anything():
        return None

    @LOOKUP
    def look_up(name):
        name = name.decode()
        if name == missing:
            return None
        if name.startswith("get_godot_version"):
            function = tell_version if name == version_function else None
        else:
            function = report if name == "print_error" else anything
        return ctypes.cast(function, ctypes.c_void_p).value if function else None

    entry = ctypes.CDLL(library).binding_probe_init
    entry.restype = ctypes.c_uint8
    room = ctypes.create_string_buffer(256)
    offered = None if missing == "everything" else look_up
    return entry(offered, ctypes.byref(ctypes.c_int()), room), reports


def ask(library, *version, missing="nothing", version_function="get_godot_version2"):
    """(accepted, what was printed) in a process of its own; (None, ...) when that crashed."""
    done = subprocess.run([sys.executable, __file__, str(library), ".".join(map(str, version)), missing,
                           version_function], text=True, capture_output=True, check=False)
    first, _, rest = done.stdout.partition("\n")
    return (first == "1" if done.returncode == 0 and first in "01" else None), rest + done.stderr


def run(check, library):
    accepted, text = ask(library, 4, 0, 0)
    check(accepted is False, f"an older Godot is refused: {accepted} {text}")
    built = re.search(r"API of Godot ((\d+)\.(\d+)\.(\d+)), this is Godot 4\.0\.0\. Use Godot \1 ", text)
    check(built is not None, f"the refusal names both versions and what to do: {text}")
    if not built:
        return
    major, minor, patch = (int(built.group(i)) for i in (2, 3, 4))
    check(ask(library, major, minor - 1, 9)[0] is False, "one minor version older is refused")
    if patch > 0:
        check(ask(library, major, minor, patch - 1)[0] is False, "one patch older is refused, as by the manifest")
    check(ask(library, major + 1, 0, 0)[0] is False, "another major version is refused")
    check(ask(library, major, minor, patch)[0] is True, "the same version is accepted")
    check(ask(library, major, minor, patch + 1)[0] is True, "a newer patch is accepted")
    check(ask(library, major, minor + 1, 0)[0] is True, "a newer minor version is accepted")
    same = (library, major, minor, patch)
    check(ask(*same, version_function="get_godot_version")[0] is True,
          "the older way of asking the version serves too")
    accepted, text = ask(*same, version_function="none")
    check(accepted is False and "does not tell its version" in text, f"no version: {text}")
    accepted, text = ask(*same, missing="object_set_instance")
    check(accepted is False and "object_set_instance" in text, f"a missing function: {text}")
    accepted, text = ask(*same, missing="everything")
    check(accepted is False and "without the engine's interface" in text, f"no interface: {text}")


if __name__ == "__main__":
    numbers = [int(part) for part in sys.argv[2].split(".")]
    answer, messages = fake_engine(sys.argv[1], numbers, *sys.argv[3:5])
    print(answer)
    print("\n".join(messages))
