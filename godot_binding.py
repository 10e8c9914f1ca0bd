"""What the nodes are compiled with: the in-tree binding, generated from the API of a Godot, or a godot-cpp that the user
has built."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

from methods import BuildError, link_inside

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "gdextension", "binding"))
from build_profile import listed_classes  # noqa: E402
from generate import snake  # noqa: E402

MINIMUM_GODOT = (4, 4)  # classdb_register_extension_class4 and construct_object2
IN_TREE = "in_tree"


# --- Godot API -----------------------------------------------------------------------------------


class GodotApi:
    """What the in-tree binding is generated from."""

    def __init__(self, json_path, header_path):
        for path in (json_path, header_path):
            if not os.path.isfile(path):
                raise BuildError(
                    f"{path}: no such file. api=FILE needs extension_api.json and, beside it or "
                    "by interface=FILE, gdextension_interface.h; both come from "
                    "godot --headless --dump-extension-api --dump-gdextension-interface"
                )
        self.json_path = json_path
        self.header_path = header_path
        with open(json_path, encoding="utf-8") as file:
            head = file.read(2000)
        parts = [re.search(rf'"version_{name}":\s*(\d+)', head) for name in ("major", "minor", "patch")]
        if not all(parts):
            raise BuildError(f"{json_path}: holds no version; it is no Godot extension API dump")
        self.version = tuple(int(part.group(1)) for part in parts)
        if self.version < MINIMUM_GODOT:
            raise BuildError(
                f"{json_path}: API of Godot {dotted(self.version)}; "
                f"{dotted(MINIMUM_GODOT)} or later is needed"
            )


def dotted(version):
    return ".".join(str(part) for part in version)


def find_godot(option):
    """The Godot program: `godot=`, then $GODOT, then PATH. None when there is none."""
    for name in (option, os.environ.get("GODOT")):
        if name:
            found = shutil.which(name)
            if not found:
                raise BuildError(f"godot={name}: no such program")
            return os.path.abspath(found)
    return shutil.which("godot") or shutil.which("godot4")


def run_godot(godot, *arguments, cwd=None):
    """The output of Godot; a Godot that fails or hangs is a BuildError."""
    command = [godot, "--headless", *arguments]
    try:
        done = subprocess.run(
            command, cwd=cwd, timeout=120, check=True, text=True, capture_output=True
        )
    except (OSError, subprocess.SubprocessError) as error:
        detail = (getattr(error, "stderr", "") or str(error)).strip()
        raise BuildError(f"{' '.join(command)} failed: {detail}") from error
    return done.stdout


def dump_api(godot, cache):
    """The API of `godot`, dumped once and kept in `cache`/VERSION/."""
    if not godot:
        raise BuildError(
            f"no Godot {dotted(MINIMUM_GODOT)} or later found for its API: put godot on PATH, set "
            "$GODOT or godot=PROGRAM, give api=FILE, or run ./dev build, which brings its own"
        )
    lines = run_godot(godot, "--version").strip().splitlines()
    if not lines:
        raise BuildError(f"{godot} --version printed nothing")
    folder = os.path.join(cache, lines[-1].strip())
    if not os.path.isdir(folder):
        os.makedirs(cache, exist_ok=True)
        temporary = tempfile.mkdtemp(dir=cache)
        try:
            run_godot(
                godot, "--dump-extension-api", "--dump-gdextension-interface", cwd=temporary
            )
            os.chmod(temporary, 0o755)
            os.rename(temporary, folder)  # whole or not at all
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
    return GodotApi(
        os.path.join(folder, "extension_api.json"),
        os.path.join(folder, "gdextension_interface.h"),
    )


# --- Real godot-cpp ------------------------------------------------------------------------------

HOW_TO_BUILD = "docs/how_to/building.md has the commands; binding=in_tree builds without it"
# In a library that was built with hot reload, Wrapped has a member for the object that is made again.
HOT_RELOAD = re.compile(rb"_ZN5godot7Wrapped\d+[a-z_]*recreate")
PLATFORM_DEFINES = {"linux": ["LINUX_ENABLED", "UNIX_ENABLED"], "windows": ["WINDOWS_ENABLED"]}


class GodotCpp:
    """A godot-cpp that the user has built: a checkout built by SCons or CMake, CMake's build folder, or a prefix with
    include/ and lib/. `library`: the name of the file for this platform, target and processor."""

    def __init__(self, root, library, platform):
        if not os.path.isdir(root):
            raise BuildError(f"binding={root}: no such folder; give one that holds godot-cpp, or binding=in_tree")
        self.root = root
        trees = list(self.trees())
        for includes, folders in trees:
            self.includes = [path for path in includes if os.path.isdir(path)]
            found = [os.path.join(folder, library) for folder in folders]
            self.library = next((path for path in found if os.path.isfile(path)), None)
            if self.library and self.header("godot_cpp/godot.hpp") and self.header("godot_cpp/classes/node.hpp"):
                break
        else:
            raise BuildError(self.what_is_missing(trees, library))
        if not self.header("gdextension_interface.h"):
            raise BuildError(f"{root}: no gdextension_interface.h in include/, gen/include/ or gdextension/: copy there the "
                             "one that this godot-cpp was built with")
        self.version = self.read_version()
        listed = [name for name in listed_classes() if not self.header(f"godot_cpp/classes/{snake(name)}.hpp")]
        if listed:
            raise BuildError(f"{root} was built without {', '.join(listed)}: its build profile must name all classes of "
                             f"gdextension/binding/classes.txt. {HOW_TO_BUILD}")
        with open(self.library, "rb") as file:
            self.hot_reload = HOT_RELOAD.search(file.read()) is not None
        # What godot-cpp's own build defines for whoever uses it: its headers and its library must agree.
        self.defines = ["GDEXTENSION", "THREADS_ENABLED", *PLATFORM_DEFINES[platform]]
        self.defines += ["HOT_RELOAD_ENABLED"] if self.hot_reload else []

    def trees(self):
        """Where headers and libraries may be together: pairs of lists of folders, all by a path inside our checkout."""
        def below(folder, *names):
            return [os.path.join(folder, *name.split("/")) for name in names]
        root = link_inside("build/godot_cpp", self.root)
        yield (below(root, "include", "gen/include", "gdextension"),
               below(root, "bin", "lib", "lib64", "lib/x86_64-linux-gnu", "lib/aarch64-linux-gnu"))
        for name in ("", *sorted(os.listdir(self.root))):
            home = cmake_home(os.path.join(self.root, name))
            if home and (not name or os.path.realpath(home) == os.path.realpath(self.root)):
                source = root if name else link_inside("build/godot_cpp_source", home)
                build = os.path.join(root, name)
                yield below(source, "include", "gdextension") + below(build, "gen/include"), below(build, "bin")

    def what_is_missing(self, trees, library):
        headers = [path for includes, _ in trees for path in includes]
        if not any(os.path.isfile(os.path.join(path, "godot_cpp", "godot.hpp")) for path in headers):
            return f"{self.root}: no include/godot_cpp/godot.hpp; it is no godot-cpp. Give binding=PATH or binding=in_tree"
        others = sorted({name for _, folders in trees for folder in folders if os.path.isdir(folder)
                         for name in os.listdir(folder) if name.startswith("libgodot-cpp")})
        if others:
            return (f"{self.root}: no {library} with its generated headers, only {', '.join(others)}. Build it for this "
                    f"platform and target, in single precision and with threads. {HOW_TO_BUILD}")
        return f"{self.root}: godot-cpp is not built: no {library} in bin/, lib/ or a CMake build folder. {HOW_TO_BUILD}"

    def header(self, name):
        paths = (os.path.join(folder, name) for folder in self.includes)
        return next((path for path in paths if os.path.isfile(path)), None)

    def read_version(self):
        path = self.header("godot_cpp/core/version.hpp")
        text = open(path, encoding="utf-8").read() if path else ""
        parts = [re.search(rf"#define\s+GODOT_VERSION_{name}\s+(\d+)", text) for name in ("MAJOR", "MINOR", "PATCH")]
        if not all(parts):
            raise BuildError(f"{self.root}: no Godot version in godot_cpp/core/version.hpp")
        version = tuple(int(part.group(1)) for part in parts)
        if version < MINIMUM_GODOT:
            raise BuildError(f"{self.root} was built from the API of Godot {dotted(version)}; {dotted(MINIMUM_GODOT)} or "
                             f"later is needed. {HOW_TO_BUILD}")
        return version

    def __str__(self):
        return (f"godot-cpp at {self.root}, API of Godot {dotted(self.version)}, "
                f"{'with' if self.hot_reload else 'without'} hot reload")


def cmake_home(build):
    """The folder of the sources that a CMake build folder belongs to; None when it is none."""
    cache = os.path.join(build, "CMakeCache.txt")
    if not os.path.isfile(cache):
        return None
    with open(cache, encoding="utf-8", errors="replace") as file:
        home = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.+)$", file.read(), re.M)
    return home[1] if home and os.path.isdir(home[1]) else None


def find_godot_cpp(option, library, platform):
    """`binding=`, then $GODOT_CPP, then a folder godot-cpp/ here. None: the in-tree binding."""
    chosen = option or os.environ.get("GODOT_CPP") or ("godot-cpp" if os.path.isdir("godot-cpp") else IN_TREE)
    return None if chosen == IN_TREE else GodotCpp(chosen, library, platform)


def refuse_api_options(godot_cpp, options):
    """A godot-cpp has its API inside: an option that names another would be ignored."""
    given = [name for name in ("api", "interface", "godot") if options[name]]
    if given:
        raise BuildError(f"{given[0]}= is for the in-tree binding, but this build uses {godot_cpp}. Its API was fixed when it "
                         f"was built: leave {given[0]}= out, or give binding=in_tree")


def in_use(godot_cpp, includes):
    """What the tests want to know of the binding that the last build used, as JSON."""
    return json.dumps({"godot_cpp": godot_cpp and str(godot_cpp), "includes": [os.path.abspath(p) for p in includes]}) + "\n"
