#!/usr/bin/env python3
"""Tests of ./dev itself: its words, its table of stages, its runner, and a checkout in a folder of an awkward name.

Needs what ./dev build leaves: the API of a Godot in build/api. The last line is "N passed, N failed".
"""

import contextlib
import glob
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
AWKWARD = 'it\'s a "test" & $HOME'
LIMIT_S = 200

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what, flush=True)


def run(command, folder=ROOT, **more):
    """Exit code and whole output."""
    done = subprocess.run(command, cwd=folder, timeout=LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **more)
    return done.returncode, done.stdout


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


# --- Words ---------------------------------------------------------------------------------------


def check_words():
    code, output = run(["./dev", "help"])
    check(code == 0 and output == read("tools/dev/help.txt"), "help prints the commands")
    for words in ([], ["--help"], ["play", "--help"], ["test", "-h"]):
        code, other = run(["./dev", *words])
        check(code == 0 and other == output, f"./dev {' '.join(words)} prints the help")
    commands = set(re.findall(r"^([a-z][a-z-]*)(?: \||\))", read("dev").split("case $command in")[1], re.M))
    told = set(re.findall(r"\./dev ([a-z-]+)", output)) | {"help", "in-stage"}
    check(commands and commands == told, f"the help lists each command: {sorted(commands ^ told)}")
    for words, named in ((["frobnicate"], "unknown command frobnicate"), (["stage", "frobnicate"], "no stage frobnicate"),
                         (["stage"], "needs a name"), (["test", "play"], "takes no argument"),
                         (["in-stage", "frobnicate"], "has no stage_frobnicate")):
        code, output = run(["./dev", *words])
        check(code == 1 and named in output, f"./dev {' '.join(words)}: {output.strip().splitlines()[-1:]}")
    code, output = run(["./dev", "rooms"])
    check(code == 0 and output.strip(), "rooms prints the rooms")


def check_table():
    functions = set()
    for path in glob.glob(os.path.join(ROOT, "tools", "dev", "*.sh")):
        functions |= set(re.findall(r"^stage_(\w+)\(\)", read(path), re.M))
    code, output = run(["./dev", "stages"])
    lines = [line.split(None, 4) for line in output.splitlines()]
    check(code == 0 and lines and all(len(line) == 5 and line[3] == "s" for line in lines),
          "stages prints name, group, limit and what is checked")
    names = [line[0] for line in lines]
    check(len(names) == len(set(names)) and set(names) == functions,
          f"each stage of the table is written, and each that is written is in it: {sorted(set(names) ^ functions)}")


# --- The runner ----------------------------------------------------------------------------------

TABLE = """
good     quick 20 passes
silent   quick 20 notes nothing
broken   quick 20 breaks off
absent   quick 20 is not written
bad      quick 20 has a failed check
hangs    rest  2  never ends, nor do its children
messy    quick 20 leaves a file, and changes one that was changed before
long     rest  60 lasts until it is interrupted
"""
STAGES = """#!/bin/sh
result=build/logs/$2.result
case $2 in
good) echo "3 0" >>"$result" ;;
silent) ;;
broken) echo "1 0" >>"$result"; exit 0 ;;
bad) echo "2 1" >>"$result" ;;
hangs | long) timeout 300 sleep 291 & sleep 290 ;;
messy) echo more >>changed; echo new >left; mkdir -p ignored; echo x >ignored/x; echo "1 0" >>"$result" ;;
*) exit 1 ;;
esac
echo ended >>"$result"
"""


@contextlib.contextmanager
def runner_alone():
    """A git checkout that holds the runner, the table above and a ./dev with the stages above."""
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(os.path.join(folder, "tools", "dev"))
        shutil.copy(os.path.join(ROOT, "tools", "dev", "run_stages.py"), os.path.join(folder, "tools", "dev"))
        for name, text in (("tools/dev/stages.txt", TABLE), ("dev", STAGES), ("changed", "first\n"),
                           (".gitignore", "/build/\n/ignored/\n__pycache__/\n")):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        os.chmod(os.path.join(folder, "dev"), 0o755)
        for words in (["init", "-q"], ["add", "-A"],
                      ["-c", "user.name=test", "-c", "user.email=test@localhost", "commit", "-qm", "test"]):
            subprocess.run(["git", *words], cwd=folder, check=True)
        with open(os.path.join(folder, "changed"), "a", encoding="utf-8") as file:
            file.write("by the developer\n")
        yield folder


def sleepers():
    """How many of the stages' endless children run, of this user."""
    done = subprocess.run(["ps", "-eo", "args"], check=True, text=True, capture_output=True)
    return len(re.findall(r"^(?:timeout 300 )?sleep 29[01]$", done.stdout, re.M))


def check_runner():
    command = [sys.executable, "tools/dev/run_stages.py", "run"]
    for stage, wanted in (("good", "3 passed, 0 failed"), ("silent", "0 passed, 1 failed"),
                          ("broken", "1 passed, 1 failed"), ("absent", "0 passed, 1 failed"),
                          ("bad", "2 passed, 1 failed")):
        with runner_alone() as folder:
            code, output = run([*command, stage], folder)
            last = output.splitlines()[-1]
            check(last == wanted and code == int(not wanted.endswith(" 0 failed")), f"a stage that is {stage}: {last}")
    with runner_alone() as folder:
        before = sleepers()
        started = time.monotonic()
        code, output = run([*command, "hangs"], folder)
        check(code == 1 and "did not end within 2 s" in output and "--- hangs: FAIL" in output,
              "a stage that hangs fails at its limit")
        check(time.monotonic() - started < 30 and sleepers() == before, "its children are ended, of other groups too")
        code, output = run([*command, "good", "good"], folder)
        check(code == 0 and "--- clean_tree: PASS, 1 passed, 0 failed" in output and
              output.endswith("7 passed, 0 failed\n"), "what a developer changed before is no fault of the run")
        code, output = run([*command, "messy", "good"], folder)
        touched = re.findall(r"^FAIL (\S+): changed or left", output, re.M)
        check(code == 1 and touched == ["changed", "left"], f"a run that leaves files fails: {touched}")
    with runner_alone() as folder:
        before = sleepers()
        process = subprocess.Popen([*command, "long", "good"], cwd=folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT)
        end = time.monotonic() + 30
        while sleepers() == before and time.monotonic() < end:
            time.sleep(0.1)
        check(sleepers() > before, "a stage that lasts has begun")
        process.send_signal(signal.SIGTERM)
        output = process.communicate(timeout=60)[0]
        check(process.returncode == 130 and "=== good" not in output and sleepers() == before,
              "an interrupt ends the stage with its children, and the run")


# --- Jolt's sources --------------------------------------------------------------------------------


def check_jolt():
    """Sources that are not the known ones are refused, and nothing of them is left."""
    with tempfile.TemporaryDirectory() as folder:
        inner = os.path.join(folder, "godot-x", "thirdparty", "jolt_physics")
        os.makedirs(os.path.join(inner, "Jolt"))
        for name in ("LICENSE", "Jolt/Jolt.h"):
            with open(os.path.join(inner, name), "w", encoding="utf-8") as file:
                file.write("altered\n")
        archive = os.path.join(folder, "godot.orig.tar.xz")
        with tarfile.open(archive, "w:xz") as file:
            file.add(os.path.join(folder, "godot-x"), "godot-x")
        target = os.path.join(folder, "jolt")
        code, output = run(["python3", "tools/fetch/unpack_jolt.py", archive, target])
        check(code != 0 and "not the known sources" in output and not os.path.exists(target),
              "altered sources of Jolt are refused")
    code, output = run(["scons", "-Q", "-n", "jolt=/nowhere", "spidar_tests"])
    check(code == 2 and "no Jolt/Jolt.h" in output and "./dev build" in output, "scons says how to come by Jolt")


# --- A folder of an awkward name -------------------------------------------------------------------


def copy_sources(target):
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\0")
    for name in names:
        if name and os.path.isfile(os.path.join(ROOT, name)) and not name.startswith(("docs/", "demo_project/")):
            os.makedirs(os.path.join(target, os.path.dirname(name)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, name), os.path.join(target, name))


def names_folder(text):
    """Whether the text tells the awkward name, in whatever way a program or a shell left it."""
    return any(part in text for part in ("it's a", "it\\'s", "\"test\"", "\\\"test", "& $HOME", "$HOME"))


def check_commands(folder, api):
    """No command of a build may hold the folder's name: a dry run prints them all."""
    code, output = run(["scons", "-Q", "-n", "verbose=yes", "binding=in_tree", f"api={api}", "addon", "probe", "tests", "bench", "paper",
                        "hid_vm", "realtime"], folder)
    lines = output.splitlines()
    kinds = {"compile": " -c ", "archive": "ar rc ", "link": "-shared"}
    check(code == 0 and all(any(kind in line for line in lines) for kind in kinds.values()),
          f"scons tells what it would do: {len(lines)} lines, exit code {code}")
    telling = [line for line in lines if names_folder(line)]
    check(not telling, f"no command names the folder: {[line[:300] for line in telling[:2]]}")
    if code != 0:
        print(output[-2000:])


def smallest(folder, pattern):
    """The smallest file of this pattern, relative to the folder."""
    found = glob.glob(pattern, root_dir=folder, recursive=True)
    return min(found, key=lambda path: os.path.getsize(os.path.join(folder, path)))


def check_compilation(folder, api):
    core = smallest(folder, "gdextension/core/**/*.cpp")
    node = smallest(folder, "gdextension/godot/**/register_types.cpp")  # it includes what the build generates
    objects = [f"build/obj/{os.path.splitext(core)[0]}.os", f"build/obj/template_debug/{os.path.splitext(node)[0]}.os"]
    code, output = run(["scons", "-Q", "binding=in_tree", f"api={api}", *objects,
                        "addons/spidar_g/spidar_g.gdextension", "compile_commands.json"], folder)
    check(code == 0, f"a source of the core and one of the nodes compile: {output[-1000:] if code else core}")
    for path in objects:
        whole = os.path.join(folder, path)
        content = open(whole, "rb").read().decode("latin-1") if os.path.isfile(whole) else AWKWARD
        check(not names_folder(content), f"{path} does not tell where it was built")
    manifest = os.path.join(folder, "addons/spidar_g/spidar_g.gdextension")
    text = open(manifest, encoding="utf-8").read() if os.path.isfile(manifest) else ""
    check(re.search(r'^compatibility_minimum = "\d+\.\d+\.\d+"$', text, re.M), "the manifest is written")
    database = os.path.join(folder, "compile_commands.json")
    entries = json.load(open(database, encoding="utf-8")) if os.path.isfile(database) else []
    check(len(entries) > 100 and all(entry["file"] in shlex.split(entry["command"]) for entry in entries),
          f"compile_commands.json holds {len(entries)} commands")
    code, output = run(["clang-tidy", "-p", ".", "--quiet", core], folder)
    check(code == 0, f"clang-tidy reads them: {output[-1000:] if code else core}")


def check_kept_binding(folder):
    """./dev build binding=... holds for later commands; scons is one that only tells what it was given."""
    tools = os.path.join(os.path.dirname(folder), "tools")
    os.makedirs(tools, exist_ok=True)
    scons = os.path.join(tools, "scons")
    with open(scons, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\necho \"binding <$GODOT_CPP> words <$*>\"\n")
    os.chmod(scons, 0o755)
    environment = {name: value for name, value in os.environ.items() if name != "GODOT_CPP"}
    environment["PATH"] = tools + os.pathsep + environment["PATH"]
    mine = os.path.join(folder, "my godot-cpp")
    for words, more, wanted in (([], {}, ""), (["binding=my godot-cpp", "verbose=yes"], {}, mine), ([], {}, mine),
                                ([], {"GODOT_CPP": "/other"}, "/other"), (["binding=in_tree"], {}, "in_tree"),
                                ([], {}, "in_tree")):
        code, output = run(["./dev", "build", *words], folder, env=dict(environment, **more))
        given = " verbose=yes" if "verbose=yes" in words else ""
        check(code == 0 and f"binding <{wanted}>" in output and re.search(rf"words <-Q -j\d+{given}>", output),
              f"./dev build {' '.join(words)} uses the binding {wanted or 'that is found'}: {output.strip()[-300:]}")


def check_awkward_folder():
    apis = sorted(glob.glob(os.path.join(glob.escape(ROOT), "build", "api", "*", "extension_api.json")))
    check(apis, "the API of a Godot is in build/api (./dev build)")
    if not apis:
        return
    with tempfile.TemporaryDirectory() as place:
        folder = os.path.join(place, AWKWARD)
        copy_sources(folder)
        code, output = run(["./dev", "stages"], folder)
        check(code == 0 and output == run(["./dev", "stages"])[1], "./dev works in a folder of an awkward name")
        check_kept_binding(folder)
        check_commands(folder, apis[-1])
        check_compilation(folder, apis[-1])


if __name__ == "__main__":
    check_words()
    check_jolt()
    check_table()
    check_runner()
    check_awkward_folder()
    print(f"{passed} passed, {failed} failed")
    sys.exit(1 if failed or not passed else 0)
