#!/usr/bin/env python3
"""The release as a newcomer gets it: run_package_tests.py GODOT ZIP

Unpacks it into an empty project, lets Godot run a script there, and reads what the libraries ask of a system.
The last line is "N passed, N failed".
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import godot_project  # noqa: E402
from told_folders import told_folders  # noqa: E402

ADDON = "addons/spidar_g/"
NEEDED = ["README.md", "LICENSE.md", "THIRDPARTY.md", "plugin.cfg", "spidar_g.gdextension",
          "udev/70-spidar-g.rules", "bin/spidar_g_guard.x86_64", "bin/spidar_g_guard.arm64",
          "stand_in/.gdignore", "stand_in/spidar_g.gd"]
PLATFORMS = ["linux.debug.x86_64", "linux.release.x86_64", "linux.debug.arm64", "linux.release.arm64",
             "windows.debug.x86_64", "windows.release.x86_64"]
# docs/how_to/building.md gives this number to the user.
GLIBC_FLOOR = (2, 35)
LIMIT_S = 120

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what)


def run_smoke(godot, project):
    shutil.copy(os.path.join(HERE, "smoke.gd"), project)
    command = [godot, "--headless", "--path", project, "--fixed-fps", "60", "-s", "res://smoke.gd"]
    try:
        done = subprocess.run(command, timeout=LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        return 1, f"not done in {LIMIT_S} s"
    return done.returncode, done.stdout


def machine_of(program):
    """The processor in an ELF file's header."""
    with open(program, "rb") as file:
        return {62: "x86_64", 183: "arm64"}.get(int.from_bytes(file.read(20)[18:], "little"))


def needed_glibc(library):
    table = subprocess.run(["objdump", "-T", library], check=True, text=True, capture_output=True).stdout
    return max(tuple(int(n) for n in v.split(".")) for v in re.findall(r"GLIBC_(\d+\.\d+)", table))


def main():
    godot, archive = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="spidar_package_") as project:
        with zipfile.ZipFile(archive) as package:
            names = package.namelist()
            package.extractall(project)
        check(all(name.startswith(ADDON) for name in names), "all is below addons/spidar_g/")
        for name in NEEDED:
            check(ADDON + name in names, f"holds {name}")
        manifest = os.path.join(project, ADDON, "spidar_g.gdextension")
        with open(manifest, encoding="utf-8") as file:
            text = file.read()
        named = dict(re.findall(r'^(\w+\.(?:debug|release)\.\w+) = "(.*)"', text, re.M))
        libraries = list(named.values())
        check(sorted(named) == sorted(PLATFORMS), f"the manifest names a library for each of {', '.join(named)}")
        for library in libraries:
            check(ADDON + library in names, f"holds {library}")
        guards = dict(re.findall(r'^(\w+\.\w+\.\w+) = \{ "res://addons/spidar_g/(.*)": "" \}', text, re.M))
        check(all(guards.get(platform) == "bin/spidar_g_guard." + platform.split(".")[2]
                  for platform in PLATFORMS if platform.startswith("linux")), "the manifest exports each Linux library's guard")
        programs = [name for name in libraries if name.endswith(".so")] + sorted(set(guards.values()))
        for name in programs:
            machine = machine_of(os.path.join(project, ADDON, name))
            check(machine == name.removesuffix(".so").split(".")[-1], f"{os.path.basename(name)} is for {machine}")
        for library in (os.path.join(project, ADDON, name) for name in programs):
            found = needed_glibc(library)
            check(found <= GLIBC_FLOOR, f"{os.path.basename(library)} needs glibc {found[0]}.{found[1]}")
        # The debug DLL has mingw-w64's runtime inside, whose debug information names that one's own folders.
        ours = [name for name in libraries if name.endswith(".so") or "release" in name]
        for library in (os.path.join(project, ADDON, name) for name in [*ours, *sorted(set(guards.values()))]):
            check(not told_folders(library), f"{os.path.basename(library)} names no folder of its builder: "
                  f"{told_folders(library)[:3]}")
        with open(os.path.join(project, "project.godot"), "w", encoding="utf-8") as file:
            file.write("config_version=5\n")
        godot_project.list_extensions(project)
        code, output = run_smoke(godot, project)
        check(code == 0 and "SMOKE passed" in output, f"the simulated device moves and pulls (exit code {code})")
        noise = re.findall(r"^.*(?:ERROR|WARNING).*$", output, re.M)
        check(not noise, f"no warning, no error printed: {noise[:3]}")
        if code != 0:
            print(output[-3000:])
        # A Godot that is too old for the release must say so, and load nothing.
        with open(manifest, "w", encoding="utf-8") as file:
            file.write(re.sub(r'compatibility_minimum = "[\d.]+"', 'compatibility_minimum = "99.0"', text))
        code, output = run_smoke(godot, project)
        told = re.search(r"^.*99\.0.*$", output, re.M)
        check(code != 0 and "no class SpidarG" in output and told,
              f"a Godot below compatibility_minimum is told so: {told[0].strip() if told else output[-300:]}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
