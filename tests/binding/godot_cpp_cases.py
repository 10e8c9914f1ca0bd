"""The choice of the binding, on folders laid out like a godot-cpp; and a build of the probe with a stand-in for one.

The stand-in is the in-tree binding in the clothes of a godot-cpp: it shows that `binding=PATH` finds, compiles and links
what lies there, and nothing about godot-cpp's own headers.
"""

import contextlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))
import godot_binding  # noqa: E402
from methods import BuildError, architecture  # noqa: E402

NAME = f"libgodot-cpp.linux.template_debug.{architecture()}.a"
VERSION = "#define GODOT_VERSION_MAJOR {}\n#define GODOT_VERSION_MINOR {}\n#define GODOT_VERSION_PATCH {}\n"
HOT = b"\0_ZN5godot7Wrapped28_constructing_recreate_ownerE\0"
BUILD_LIMIT_S = 300


def put(path, content=""):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def lay(root, include="include", generated="gen/include", library=f"bin/{NAME}", version=(4, 6, 3), content=b"!<arch>",
        without=()):
    """A folder with the files that the build looks at."""
    put(root / include / "godot_cpp" / "godot.hpp")
    put(root / "gdextension" / "gdextension_interface.h")
    put(root / generated / "godot_cpp" / "core" / "version.hpp", VERSION.format(*version))
    for name in godot_binding.listed_classes():
        if name not in without:
            put(root / generated / "godot_cpp" / "classes" / f"{godot_binding.snake(name)}.hpp")
    if library:
        put(root / library, content)
    return root


def layout_cases(check, scratch):
    def accepted(name, root, hot_reload=False):
        try:
            found = godot_binding.GodotCpp(str(root), NAME, "linux")
        except BuildError as error:
            check(False, f"{name}: {error}")
            return
        paths = [found.library, *found.includes]
        check(os.path.isfile(found.library) and found.header("godot_cpp/godot.hpp") and found.version == (4, 6, 3)
              and ("HOT_RELOAD_ENABLED" in found.defines) == hot_reload, f"{name}: {vars(found)}")
        check(not any(os.path.isabs(path) or "$HOME" in path for path in paths), f"{name}: paths of ours: {paths}")

    def refused(name, root, *words, library=NAME):
        try:
            told = f"accepted: {vars(godot_binding.GodotCpp(str(root), library, 'linux'))}"
        except BuildError as error:
            told = str(error)
        check(all(word in told for word in words), f"{name}: {told}")

    awkward = scratch / "it's a \"test\" & $HOME"
    accepted("a checkout that SCons built", lay(awkward / "scons"))
    accepted("a library with hot reload", lay(awkward / "hot", content=b"!<arch>" + HOT), hot_reload=True)
    accepted("a prefix", lay(awkward / "prefix", generated="include", library=f"lib/{NAME}"))
    inside = lay(awkward / "cmake", generated="out/gen/include", library=f"out/bin/{NAME}")
    put(inside / "out" / "CMakeCache.txt", f"CMAKE_HOME_DIRECTORY:INTERNAL={inside}\n")
    accepted("a checkout that CMake built", inside)
    beside = lay(awkward / "source", generated="../beside/gen/include", library=f"../beside/bin/{NAME}")
    put(awkward / "beside" / "CMakeCache.txt", f"A:B=C\nCMAKE_HOME_DIRECTORY:INTERNAL={beside}\n")
    accepted("a CMake build folder", awkward / "beside")
    refused("a CMake build folder elsewhere", beside, "not built", "docs/how_to/building.md")
    refused("no such folder", scratch / "nowhere", "no such folder", "in_tree")
    (scratch / "empty").mkdir(parents=True)
    refused("no godot-cpp", scratch / "empty", "it is no godot-cpp")
    refused("not built", lay(scratch / "bare", library=None), "is not built", NAME)
    refused("built for another target", lay(scratch / "other"), NAME, "template_release", library=NAME.replace("debug", "release"))
    refused("a class is missing", lay(scratch / "trimmed", without=("Shader", "Joint3D")), "Joint3D, Shader", "build profile")
    refused("an older API", lay(scratch / "old", version=(4, 3, 0)), "4.3.0", "4.4")
    shutil.rmtree(lay(scratch / "headless") / "gdextension")
    refused("no interface", scratch / "headless", "no gdextension_interface.h")


def choice_cases(check, scratch):
    def chosen(option="", variable=None):
        with contextlib.ExitStack() as stack:
            old = os.environ.pop("GODOT_CPP", None)
            stack.callback(lambda: os.environ.pop("GODOT_CPP", None))
            if old is not None:
                stack.callback(lambda: os.environ.__setitem__("GODOT_CPP", old))
            if variable is not None:
                os.environ["GODOT_CPP"] = variable
            found = godot_binding.find_godot_cpp(option, NAME, "linux")
            return found and found.root

    a, b = (str(lay(scratch / name)) for name in ("a", "b"))
    check(chosen() is None, "in-tree where nothing is said")
    check(chosen(a) == a and chosen(variable=b) == b and chosen(a, b) == a, "binding= goes before $GODOT_CPP")
    lay(Path("godot-cpp"))
    check(chosen() == "godot-cpp" and chosen(variable=b) == b, "a folder godot-cpp/ is taken")
    check(chosen("in_tree") is None and chosen(variable="in_tree") is None and chosen("in_tree", a) is None,
          "in_tree forces the in-tree binding")
    try:
        godot_binding.refuse_api_options(godot_binding.GodotCpp(a, NAME, "linux"), {"api": "x.json", "interface": "", "godot": ""})
        check(False, "api= with a godot-cpp is refused")
    except BuildError as error:
        check("api=" in str(error) and a in str(error) and "binding=in_tree" in str(error), f"api= is refused: {error}")
    godot_binding.refuse_api_options(godot_binding.GodotCpp(a, NAME, "linux"), {"api": "", "interface": "", "godot": ""})


def stand_in_cases(check, scratch, godot):
    """The probe built by scons with a stand-in, in a copy of the sources, and its tests run there."""
    with open(ROOT / "build" / "binding" / "in_use.json", encoding="utf-8") as file:
        binding = json.load(file)
    if binding["godot_cpp"]:
        return  # a real one is in use
    stand_in = scratch / "stand_in"
    for folder in binding["includes"]:
        shutil.copytree(folder, stand_in / "include", dirs_exist_ok=True)
    (stand_in / "lib").mkdir()
    shutil.copy(ROOT / "build" / "binding" / "template_debug" / "libgodot_binding.a", stand_in / "lib" / NAME)
    copy = scratch / "copy"
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\0")
    for name in names:
        if name and (ROOT / name).is_file() and not name.startswith(("docs/", "demo_project/", "addons/")):
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, copy / name)
    environment = {name: value for name, value in os.environ.items() if name != "GODOT_CPP"}

    def run(*command, **more):
        done = subprocess.run(command, cwd=copy, timeout=BUILD_LIMIT_S, text=True, errors="replace", env=dict(environment, **more),
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout

    code, output = run("scons", "-Q", "-j2", f"binding={stand_in}", "probe")
    check(code == 0 and f"binding: godot-cpp at {stand_in}" in output, f"scons binding=PATH probe: {output[-1500:]}")
    if code == 0:
        code, output = run(sys.executable, "tests/binding/run_binding_tests.py", godot, "build/binding/probe/libbinding_probe.so",
                           GODOT=godot)
        check(code == 0 and "left out with a godot-cpp" in output, f"the probe's tests with it: {output[-1500:]}")
    code, output = run("scons", "-Q", "-n", "api=some.json", "probe", GODOT_CPP=str(stand_in))
    check(code == 2 and "api= is for the in-tree binding" in output, f"api= is no silent wish: {output[-500:]}")
    code, output = run("scons", "-Q", "-n", f"godot_cpp={stand_in}", "probe")
    check(code == 2 and "binding=PATH" in output, f"the old name is told the new one: {output[-500:]}")


def run(check, scratch, godot):
    scratch = scratch / "godot_cpp_cases"
    scratch.mkdir()
    with contextlib.chdir(scratch):  # the links that lead to a godot-cpp are made in the current folder
        layout_cases(check, scratch / "layouts")
        choice_cases(check, scratch / "choices")
    stand_in_cases(check, scratch, godot)
