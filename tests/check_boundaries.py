#!/usr/bin/env python3
"""What no compiler checks: which room may use which, and what no committed file may name.

Prints each complaint as FILE:LINE, then "N passed, N failed". With --rooms: the rooms and the arrows between them.
"""

import io
import os
import re
import subprocess
import sys
import zipfile

from boundaries import rooms

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Headers from outside, and the rooms that may include them; a room's name stands for the rooms inside it too. Headers of
# the standard library have no folder and no suffix: <vector>, <cmath>.
EVERYWHERE = ("core", "device", "godot")
OUTSIDE = (
    (r"<[a-z_0-9]+>", EVERYWHERE),
    (r"<glm/", EVERYWHERE),
    (r"<immintrin\.h>", ("core/tension/fast", "device/threads")),
    (r"<(pthread|sched|windows)\.h>|<sys/prctl\.h>", ("device/threads",)),
    (r"<hidapi/|<(dlfcn|unistd)\.h>|<sys/types\.h>", ("device/hid",)),
    (r"<asio/|<linux/serial\.h>", ("device/serial",)),
    (r"<(dlfcn|fcntl|poll|spawn|unistd)\.h>|<sys/(file|ioctl|mman|socket|wait)\.h>", ("device/serial",)),
    (r"<Jolt/", ("device/contact/shapes",)),
    (r'"spidar_(version|sources)\.h"', ("device/recording", "godot")),
    (r"<godot_cpp/|<gdextension_interface\.h>", ("godot",)),
)
# Where a committed file may send its reader. A script may fetch from none of them.
LINKS = (
    "github.com", "raw.githubusercontent.com", "godotengine.org", "docs.godotengine.org",
    "keepachangelog.com", "semver.org", "www.w3.org", "doi.org",
)
LINE_LIMIT = 400  # "one idea a file": a source longer than this holds two


def tracked_files():
    """Paths of all committed (or about to be committed) files."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    paths = [path for path in done.stdout.split("\0") if path]
    return [path for path in paths if os.path.isfile(os.path.join(ROOT, path))]


def lines_of(path):
    """(number, line) of a text file; nothing for a binary one."""
    with open(os.path.join(ROOT, path), "rb") as file:
        content = file.read()
    if b"\0" in content[:8000]:
        return []
    return list(enumerate(content.decode("utf-8", "replace").splitlines(), 1))


def sources_of(files, folder):
    found = [path for path in files if path.startswith(folder + "/")]
    return [path for path in found if path.endswith((".cpp", ".h"))]


def room_sources(files):
    """{path: text} of every file that lies in a room."""
    return {path: "\n".join(line for _, line in lines_of(path)) for path in files if rooms.room_of(path)}


def room_rules():
    with open(os.path.join(ROOT, rooms.LIST), encoding="utf-8") as file:
        return rooms.Rules(file.read())


def inside(room, folders):
    return any(room == folder or room.startswith(folder + "/") for folder in folders)


def outside_headers(sources):
    """Includes that are of no room, where the list above does not allow them."""
    for path, text in sources.items():
        for number, line in enumerate(text.splitlines(), 1):
            found = re.match(r'\s*#\s*include\s+(["<].*)', line)
            if not path.endswith((".cpp", ".h")) or not found or rooms.INCLUDE.match(line):
                continue
            room = rooms.room_of(path)
            if not any(re.match(rule, found.group(1)) and inside(room, allowed) for rule, allowed in OUTSIDE):
                yield path, number, f"{room} may not include {found.group(1)}"


def engine_names(files, folder):
    """Any word of the engine in code (comments may speak of it)."""
    for path in sources_of(files, folder):
        for number, line in lines_of(path):
            if re.search(r"godot|gdextension_", line.split("//")[0], re.IGNORECASE):
                yield path, number, f"{folder} names the engine: {line.strip()}"


def links(files):
    """Addresses outside the list above, and any address in a script of the build."""
    for path in files:
        script = path.endswith((".py", ".sh", "SConstruct", "SConscript")) or path in ("dev", ".ci/run")
        for number, line in lines_of(path):
            for host in re.findall(r"\b(?:https?|ftp|git|ssh)://([\w.-]+)", line):
                if script or host not in LINKS:
                    yield path, number, f"address of {host}"


def machine_names(files):
    """Absolute paths of somebody's machine, and package registries by name."""
    folders = re.compile(r"(?<![\w.$}/-])/(?:work|root|home/\w+|tmp/\w+/\w+|Users/\w+)/")
    hosts = re.compile(
        r"\b(?:deb|security|snapshot|registry|pypi|files|proxy|mirrors?|crates|static)"
        r"\.(?:[a-z0-9-]+\.)*(?:org|com|net|io|dev)\b"
    )
    for path in files:
        for number, line in lines_of(path):
            for pattern, what in ((folders, "path of a machine"), (hosts, "package registry")):
                found = pattern.search(line)
                if found:
                    yield path, number, f"{what}: {found.group(0)}"


def long_files(files):
    for folder in ("gdextension", "addons", "demo_project"):
        for path in files:
            if path.startswith(folder + "/") and path.endswith((".cpp", ".h", ".hpp", ".gd")):
                count = len(lines_of(path))
                if count > LINE_LIMIT:
                    yield path, count, f"{count} lines, the limit is {LINE_LIMIT}"


def versions(files):
    """version.py, plugin.cfg and CHANGELOG.md agree."""
    namespace = {}
    exec(open(os.path.join(ROOT, "version.py"), encoding="utf-8").read(), namespace)
    version = namespace["version"]
    wanted = {
        "addons/spidar_g/plugin.cfg": f'version="{version}"',
        "CHANGELOG.md": f"## [{version}]",
    }
    for path, text in wanted.items():
        lines = [line for _, line in lines_of(path)] if path in files else []
        if not any(line.startswith(text) for line in lines):
            yield path, 1, f"has no line {text} as version.py says"


def copies():
    """What the add-on carries for itself is what the repository says."""
    for name, copy in (("LICENSE", "LICENSE.md"), ("THIRDPARTY.md", "THIRDPARTY.md")):
        path = f"addons/spidar_g/{copy}"
        if not os.path.isfile(os.path.join(ROOT, path)) or lines_of(path) != lines_of(name):
            yield path, 1, f"is no copy of {name}"


def archive():
    """.gitattributes: an archive of the repository holds addons/ only."""
    command = ["git", "archive", "--worktree-attributes", "--format=zip", "HEAD"]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    for name in zipfile.ZipFile(io.BytesIO(done.stdout)).namelist():
        if not name.startswith("addons/"):
            yield ".gitattributes", 1, f"an archive would hold {name}"


def main():
    files = tracked_files()
    sources = room_sources(files)
    if sys.argv[1:] == ["--rooms"]:
        print("\n".join(rooms.table(sources, room_rules())))
        return 0
    checks = {
        f"rooms use each other as {rooms.LIST} says": rooms.complaints(sources, room_rules()),
        "headers from outside": outside_headers(sources),
        "core does not know the engine": engine_names(files, "gdextension/core"),
        "device does not know the engine": engine_names(files, "gdextension/device"),
        "addresses": links(files),
        "machine paths and registries": machine_names(files),
        "length of sources": long_files(files),
        "one version": versions(files),
        "copies": copies(),
        "archive": archive(),
    }
    failed = 0
    for root, name in rooms.ROOTS.items():  # a check that looks at nothing proves nothing
        if not any(path.startswith(root + "/") for path in sources):
            print(f"FAIL {name}: no sources")
            failed += 1
    for name, complaints in checks.items():
        complaints = list(complaints)
        failed += bool(complaints)
        print(f"{'FAIL' if complaints else 'ok  '} {name}")
        for path, number, text in complaints:
            print(f"     {path}:{number}: {text}")
    print(f"{len(checks) + len(rooms.ROOTS) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
