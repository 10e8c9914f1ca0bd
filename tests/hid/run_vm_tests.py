#!/usr/bin/env python3
"""Runs spidar_hid_vm in a virtual machine: QEMU, a Debian kernel, its uhid and USB gadget drivers.

run_vm_tests.py PROGRAM KERNEL_FOLDER GODOT [--log FILE] [--only DOCTEST_FILTER]

KERNEL_FOLDER holds vmlinuz and the modules (tools/dev/kernel.sh fills it). The machine's clock counts instructions
(QEMU's icount), so that times inside are the same on a busy computer as on an idle one. No root, no KVM.
Prints the guest's output, then "N passed, N failed".
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from godot_project import ADDONS, list_extensions  # noqa: E402

LIMIT_S = 400
START_LIMIT_S = 60
LINES_OF_A_CHECK = 3
# In the order of their dependences; those that the kernel has built in are not there as files.
MODULES = (
    "usb-common", "usbcore", "hid", "hid-generic", "usbhid", "uhid", "udc-core", "configfs",
    "libcomposite", "usb_f_hid", "dummy_hcd",
)
# A game's own start of Godot: its real files stand beside it, whatever script started it outside.
START_GODOT = """#!/bin/sh
export HOME=/game/home
exec /game/lib/{loader} --library-path /game/lib /game/lib/{program} "$@"
"""
# Loaded by name when it runs, so ldd does not list it.
LOADED_LIBRARIES = ("libudev.so.1",)


def libraries_of(path):
    """Paths of the shared libraries that a program or library needs, the loader included."""
    output = subprocess.run(["ldd", path], check=True, capture_output=True, text=True).stdout
    return re.findall(r"(?:=> )?(/\S+) \(0x", output)


def find_library(name):
    output = subprocess.run(
        ["/sbin/ldconfig", "-p"], check=True, capture_output=True, text=True
    ).stdout
    found = re.search(rf"{re.escape(name)} .*=> (\S+)", output)
    if not found:
        raise SystemExit(f"run_vm_tests: {name} is missing on this machine")
    return found.group(1)


def mapped_files(godot):
    """What a running Godot has mapped: its program, its loader and its libraries; GODOT may be a script."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "wait.gd"), "w", encoding="utf-8") as file:
            file.write('extends SceneTree\nfunc _initialize() -> void:\n\tprint("waits")\n')
        with open(os.path.join(folder, "project.godot"), "w", encoding="utf-8") as file:
            file.write("config_version=5\n")
        command = ["timeout", str(START_LIMIT_S), godot, "--headless", "--audio-driver", "Dummy", "--path", folder,
                   "-s", "wait.gd"]
        running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            while (line := running.stdout.readline()) and line.strip() != "waits":
                pass
            if not line:
                raise SystemExit(f"run_vm_tests: {godot} did not start")
            children = open(f"/proc/{running.pid}/task/{running.pid}/children", encoding="utf-8").read().split()
            maps = open(f"/proc/{children[0]}/maps", encoding="utf-8").read()
        finally:
            running.terminate()
            running.wait()
    return sorted(set(re.findall(r"r-xp (?:\S+ ){3} *(/.+)$", maps, re.MULTILINE)))


def add_game(root, godot):
    """/game: Godot, the add-on as it is built, and the game of two devices."""
    here = os.path.dirname(os.path.abspath(__file__))
    game = os.path.join(root, "game")
    os.makedirs(os.path.join(game, "lib"))
    os.makedirs(os.path.join(game, "home"))
    project = os.path.join(game, "project")
    shutil.copytree(os.path.join(here, "game"), project)
    add_on = os.path.join(project, "addons/spidar_g")
    shutil.copytree(os.path.join(ADDONS, "spidar_g"), add_on,
                    ignore=shutil.ignore_patterns("*.dll", "*template_release*"))
    list_extensions(project)
    files = mapped_files(godot)
    names = [os.path.basename(path) for path in files]
    loader = next(name for name in names if name.startswith("ld-linux"))
    program = next(name for name in names if ".so" not in name)
    library = next(path for path in os.listdir(os.path.join(add_on, "bin")) if path.endswith(".so"))
    # What the add-on needs beyond Godot's own.
    files += [path for path in libraries_of(os.path.join(add_on, "bin", library))
              if os.path.basename(path) not in names]
    for path in files:
        shutil.copy(path, os.path.join(game, "lib", os.path.basename(path)))
        # Programs ask for a library by a shorter name, that of a link beside it.
        for other in os.listdir(os.path.dirname(path)):
            same = os.path.realpath(os.path.join(os.path.dirname(path), other)) == os.path.realpath(path)
            if same and not os.path.lexists(os.path.join(game, "lib", other)):
                os.symlink(os.path.basename(path), os.path.join(game, "lib", other))
    start = os.path.join(game, "godot")
    with open(start, "w", encoding="utf-8") as file:
        file.write(START_GODOT.format(loader=loader, program=program))
    os.chmod(start, 0o755)


def fill_root(root, program, kernel, only):
    """The files of the initial RAM disk."""
    for folder in ("bin", "proc", "sys", "dev", "modules"):
        os.makedirs(os.path.join(root, folder))
    busybox = shutil.which("busybox")
    shutil.copy(busybox, os.path.join(root, "bin/busybox"))
    shutil.copy(program, os.path.join(root, "bin/spidar_hid_vm"))
    here = os.path.dirname(os.path.abspath(__file__))
    shutil.copy(os.path.join(here, "vm_init.sh"), os.path.join(root, "init"))
    os.chmod(os.path.join(root, "init"), 0o755)
    wanted = [find_library(name) for name in LOADED_LIBRARIES]
    libraries = set(wanted)
    for path in [program, *wanted]:
        libraries.update(libraries_of(path))
    for path in libraries:
        target = root + path
        os.makedirs(os.path.dirname(target), exist_ok=True)
        shutil.copy(path, target)
    names = [f"{name}.ko" for name in MODULES]
    names = [name for name in names if os.path.isfile(os.path.join(kernel, name))]
    for name in names:
        shutil.copy(os.path.join(kernel, name), os.path.join(root, "modules", name))
    with open(os.path.join(root, "modules/order"), "w", encoding="utf-8") as file:
        file.write("\n".join(names) + "\n")
    with open(os.path.join(root, "arguments"), "w", encoding="utf-8") as file:
        file.write("--no-colors\n" + (f"--test-case={only}\n" if only else ""))


def pack(root, archive):
    names = subprocess.run(["find", "."], cwd=root, check=True, capture_output=True).stdout
    packed = subprocess.run(
        ["cpio", "--quiet", "-o", "-H", "newc"], cwd=root, input=names, check=True,
        capture_output=True,
    ).stdout
    with open(archive, "wb") as file:
        file.write(packed)


def run_machine(kernel, archive, log):
    command = [
        "qemu-system-x86_64", "-accel", "tcg", "-cpu", "Nehalem", "-smp", "1",
        "-icount", "shift=1,sleep=off", "-m", "1536", "-nodefaults", "-no-user-config",
        "-display", "none", "-serial", "stdio", "-no-reboot",
        "-kernel", os.path.join(kernel, "vmlinuz"), "-initrd", archive,
        "-append", "console=ttyS0 quiet panic=-1 mitigations=off",
    ]
    lines = []
    with open(log, "w", encoding="utf-8") as file:
        machine = subprocess.Popen(
            ["timeout", str(LIMIT_S), *command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, errors="replace",
        )
        for line in machine.stdout:
            line = line.rstrip("\r\n")
            print(line, flush=True)
            print(line, file=file)
            lines.append(line)
        machine.wait()
    return lines


def found_wrong(lines):
    """The lines of failed checks: doctest's with the two that follow (expression and values), and the game's."""
    wrong = []
    for i, line in enumerate(lines):
        if re.search(r"\.(cpp|h):\d+: (FATAL )?ERROR", line):
            wrong += lines[i:i + LINES_OF_A_CHECK]
        elif line.startswith("WRONG"):
            wrong.append(line)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("kernel")
    parser.add_argument("godot")
    parser.add_argument("--log", default=os.devnull)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        root = os.path.join(folder, "root")
        fill_root(root, options.program, options.kernel, options.only)
        add_game(root, options.godot)
        archive = os.path.join(folder, "initrd")
        pack(root, archive)
        lines = run_machine(options.kernel, archive, options.log)
    text = "\n".join(lines)
    counts = re.search(r"test cases: +\d+ \| +(\d+) passed \| +(\d+) failed", text)
    passed, failed = (int(counts.group(1)), int(counts.group(2))) if counts else (0, 1)
    if not re.search(r"^RESULT rc=0\s*$", text, re.MULTILINE) and failed == 0:
        print("run_vm_tests: the guest did not end well")
        failed = 1
    if failed:
        # Said again at the end: a log that keeps only its tail must still name what failed.
        print("\n".join(["run_vm_tests: what the guest found wrong:", *found_wrong(lines)]))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
