#!/usr/bin/env python3
"""The Windows build under wine: run_windows_tests.py BUILD_FOLDER LIBRARY...

All core and device tests, the DLLs loaded, and what they import. Godot for Windows itself is not run here, and wine
has no HID devices.
"""

import os
import re
import subprocess
import sys
import tempfile

WINE = "/usr/lib/wine/wine64"
# Parts of every Windows. The C++ runtime must be inside.
SYSTEM = {"kernel32.dll", "msvcrt.dll", "user32.dll", "advapi32.dll", "winmm.dll", "avrt.dll", "ws2_32.dll", "mswsock.dll"}
LIMIT_S = 400

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what)


def wine(prefix, *command):
    environment = {**os.environ, "WINEPREFIX": prefix, "WINEARCH": "win64", "WINEDEBUG": "-all",
                   "WINEDLLOVERRIDES": "mscoree,mshtml="}
    try:
        done = subprocess.run([WINE, *command], env=environment, timeout=LIMIT_S, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return 1, f"not done in {LIMIT_S} s"
    return done.returncode, done.stdout


def headers(path):
    return subprocess.run(["x86_64-w64-mingw32-objdump", "-p", path], check=True, text=True,
                          capture_output=True).stdout


def main():
    build, *libraries = sys.argv[1:]
    programs = [os.path.join(build, "bin", name) for name in ("spidar_tests.exe", "spidar_load_library.exe")]
    tables = {path: headers(path) for path in [*libraries, *programs]}
    for path, table in tables.items():
        imports = {name.lower() for name in re.findall(r"DLL Name: (\S+)", table)}
        check(imports and imports <= SYSTEM, f"{os.path.basename(path)} imports {', '.join(sorted(imports))}")
    for path in libraries:
        names = tables[path].split("[Ordinal/Name Pointer] Table")[-1]
        exported = re.findall(r"^\s*\[\s*\d+\].*?(\w+)\s*$", names, re.M)
        check(exported == ["spidar_g_library_init"], f"{os.path.basename(path)} exports {', '.join(exported)}")
    with tempfile.TemporaryDirectory(prefix="spidar_wine_") as prefix:
        wine(prefix, "wineboot", "-i")
        code, text = wine(prefix, programs[1], *libraries)
        print(text, end="")
        check(code == 0 and re.search(r"^\d+ passed, 0 failed", text, re.M), "every library loads")
        code, text = wine(prefix, programs[0])
        found = re.search(r"test cases: +(\d+) \| +(\d+) passed \| +(\d+) failed \| +(\d+) skipped", text)
        check(code == 0 and found and int(found[2]) > 200 and found[3] == found[4] == "0",
              f"core and device tests: {found[0] if found else text[-400:]}")
        if code != 0:
            print("\n".join(line for line in text.splitlines() if "ERROR" in line or "values" in line)[:4000])
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
