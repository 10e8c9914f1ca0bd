"""Helpers of SConstruct: sources, options, the Godot API dump, real godot-cpp, the release zip."""

import hashlib
import os
import platform
import re
import shlex
import shutil
import subprocess
import tempfile
import zipfile

SANITIZERS = ("address", "undefined", "thread", "realtime")  # realtime: clang 20 and later
MINIMUM_GODOT = (4, 4)  # classdb_register_extension_class4 and construct_object2


class BuildError(Exception):
    """Something the user can put right; SConstruct prints it and stops."""


# --- Options -------------------------------------------------------------------------------------


def architecture():
    machine = platform.machine().lower()
    return {"amd64": "x86_64", "aarch64": "arm64"}.get(machine, machine)


def sanitizers(value):
    """The names in `sanitize=a,b`, in a fixed order so that one set has one build folder."""
    names = [name for name in value.split(",") if name]
    unknown = [name for name in names if name not in SANITIZERS]
    if unknown:
        raise BuildError(f"sanitize={value}: unknown {unknown[0]}; use {', '.join(SANITIZERS)}")
    if {"thread", "realtime"} & set(names) and len(names) > 1:
        raise BuildError(f"sanitize={value}: thread and realtime stand alone")
    return [name for name in SANITIZERS if name in names]


def compiler(env):
    """The C++ compiler as the start of an argument list: CXX may be two words, as in CXX="ccache g++"."""
    return shlex.split(env.subst("$CXX"))


def accepts(env, *flags):
    """Whether the C++ compiler takes these flags."""
    command = [*compiler(env), *flags, "-E", "-x", "c++", os.devnull]
    try:
        return subprocess.run(command, check=False, capture_output=True).returncode == 0
    except OSError:
        return False


# --- A checkout in a folder of any name ------------------------------------------------------------
# SCons joins a command into one line for a shell, and expands $NAME in every path it is given. A path relative to the
# checkout holds nothing of the checkout's own name, so only such paths are used for what lies inside it.


def escape_for_shell(text):
    """One word of a shell command. SCons calls it for every file and folder of a command."""
    return shlex.quote(text)


def hide_build_folder(env):
    """The library tells nobody where it was built. Its debug information names the compiler's current folder."""
    flag = "-fdebug-compilation-dir=."
    if accepts(env, flag):
        env.Append(CCFLAGS=[flag])
    elif os.path.isdir("/proc/self/cwd"):
        # GCC has no such flag, but takes the name of its current folder from PWD if that is one.
        env["ENV"]["PWD"] = "/proc/self/cwd"


# --- Sources -------------------------------------------------------------------------------------


def find_sources(root, suffix=".cpp"):
    """Every source under `root`, in a fixed order; an absent folder has none."""
    found = []
    for folder, _, names in os.walk(root):
        found += [os.path.join(folder, name) for name in names if name.endswith(suffix)]
    return sorted(found)


def objects(env, root, folder):
    """Compile all sources under `root` into `folder`, keeping their paths. Returns the nodes."""
    nodes = []
    for source in find_sources(root):
        nodes += env.SharedObject(os.path.join(folder, os.path.splitext(source)[0]), source)
    return nodes


def system_include(env, *folders):
    """Headers of others: no warnings from them. -isystem silences, CPPPATH lets SCons see changes
    (the compiler ignores -I for a folder that is also given by -isystem)."""
    for folder in folders:
        env.Append(CPPPATH=[folder], CCFLAGS=[("-isystem", env.Dir(folder))])


def write_if_changed(path, text):
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            if file.read() == text:
                return
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def version_header(version):
    return (
        "// Written by the build from version.py.\n"
        "#pragma once\n\n"
        "namespace spidar {\n\n"
        f'inline constexpr char kVersion[] = "{version}";\n\n'
        "} // namespace spidar\n"
    )


# --- Windows, cross-compiled -----------------------------------------------------------------------

MINGW = "x86_64-w64-mingw32-"


def use_mingw(env):
    """Programs and flags of mingw-w64, with the threads of the -posix variant and nothing linked at run time."""
    env.Replace(
        CC=MINGW + "gcc-posix",
        CXX=MINGW + "g++-posix",
        AR=MINGW + "ar",
        RANLIB=MINGW + "ranlib",
        PROGSUFFIX=".exe",
        SHLIBSUFFIX=".dll",
    )
    env.Append(
        # This compiler does not align the stack to 32 bytes: aligned moves of spilled AVX registers would fault.
        CCFLAGS=["-Wa,-muse-unaligned-vector-move"],
        # hidapi is inside our own library: nothing of it is for others.
        CPPDEFINES=[("_WIN32_WINNT", "0x0A00"), "HID_API_NO_EXPORT_DEFINE"],
        LINKFLAGS=["-static", "-static-libgcc", "-static-libstdc++"],
    )
    # Headers alone, shared with the host; its /usr/include as a whole would bring the wrong C library.
    folder = "build/host_headers"
    os.makedirs(folder, exist_ok=True)
    for name in ("glm", "doctest", "asio"):
        source = os.path.join("/usr/include", name)
        link = os.path.join(folder, name)
        if os.path.isdir(source) and not os.path.islink(link):
            os.symlink(source, link)
    system_include(env, "#" + folder)


def windows_hidapi(env, build):
    """hidapi's Windows backend, compiled here: its folder is what tools/fetch/fetch_hidapi.py brought."""
    folder = "build/hidapi"
    source = os.path.join(folder, "windows", "hid.c")
    if not os.path.isfile(source):
        raise BuildError(f"{source} is missing: run tools/fetch/fetch_hidapi.py")
    headers = "build/host_headers/hidapi"
    if not os.path.islink(headers):
        os.symlink(os.path.abspath(os.path.join(folder, "hidapi")), headers)
    hidapi = env.Clone()
    hidapi.Append(CPPPATH=["#" + folder + "/hidapi"])
    return [hidapi.StaticLibrary(f"{build}/lib/hidapi", hidapi.SharedObject(f"{build}/obj/hidapi_hid", source))]


def library_path(addon, platform_name, target):
    name = f"spidar_g.{platform_name}.{target}.{architecture()}"
    return f"{addon}/bin/{name}.dll" if platform_name == "windows" else f"{addon}/bin/lib{name}.so"


# --- compile_commands.json -----------------------------------------------------------------------


def keep_common_flags(files, flags):
    """clangd and clang-tidy are clang, and refuse what only GCC knows."""
    for node in files:
        with open(str(node), encoding="utf-8") as file:
            text = file.read()
        for flag in flags:
            text = text.replace(" " + flag, "")
        with open(str(node), "w", encoding="utf-8") as file:
            file.write(text)


# --- hidapi --------------------------------------------------------------------------------------


def find_hidapi(env):
    """hidapi's static library as a list of nodes: `hidapi=`, or where the compiler finds it."""
    name = "libhidapi-hidraw.a"
    path = env["hidapi"]
    if not path:
        command = [*compiler(env), f"-print-file-name={name}"]
        done = subprocess.run(command, check=False, text=True, capture_output=True)
        path = done.stdout.strip()
    if not os.path.isfile(path):
        raise BuildError(
            f"{name} is missing: install hidapi with its static library (Debian: libhidapi-dev), "
            "or give hidapi=FILE"
        )
    return [env.File(os.path.abspath(path))]


# --- Jolt ----------------------------------------------------------------------------------------

JOLT_VERSION = "5.4.0"
JOLT_SOURCES = (
    "AABBTree/AABBTreeBuilder",
    "Core/Memory",
    "Geometry/ConvexHullBuilder",
    "Geometry/ConvexHullBuilder2D",
    "TriangleSplitter/TriangleSplitter",
    "TriangleSplitter/TriangleSplitterBinning",
)
# Its memory comes from the C++ library like ours, so nothing is registered before its first use; no asserts.
JOLT_DEFINES = ["JPH_DISABLE_CUSTOM_ALLOCATOR", "JPH_NO_DEBUG"]


def find_jolt(option):
    """Jolt's sources as a folder inside the checkout, a link to where they are: `jolt=`, or the user's cache."""
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    root = option or os.path.join(cache, "spidar_g", f"jolt-{JOLT_VERSION}")
    if not os.path.isfile(os.path.join(root, "Jolt", "Jolt.h")):
        raise BuildError(
            f"{root}: no Jolt/Jolt.h: run ./dev build, which brings Jolt {JOLT_VERSION}, or give "
            "a checkout of it by jolt=PATH"
        )
    link = "build/jolt"
    wanted = os.path.abspath(root)
    if not os.path.islink(link) or os.readlink(link) != wanted:
        os.makedirs("build", exist_ok=True)
        if os.path.lexists(link):
            os.unlink(link)
        os.symlink(wanted, link)
    return link


def sources_header(*roots):
    """One number for what is in all sources under `roots`: builds of the same number hold the servo step's memory in
    the same way, and can replay each other's recordings."""
    digest = hashlib.sha256()
    for path in sorted(path for root in roots for path in find_sources(root, (".cpp", ".h"))):
        digest.update(path.replace(os.sep, "/").encode() + b"\0")
        with open(path, "rb") as file:
            digest.update(file.read() + b"\0")
    return (
        "// Written by the build from the sources.\n"
        "#pragma once\n\n"
        "#include <cstdint>\n\n"
        "namespace spidar {\n\n"
        f"inline constexpr std::uint64_t kSourcesHash = 0x{digest.hexdigest()[:16]}U;\n\n"
        "} // namespace spidar\n"
    )


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


class GodotCpp:
    """A godot-cpp that the user has: a built checkout, or a prefix with include/ and lib/."""

    def __init__(self, root, library):
        self.includes = [
            os.path.join(root, *parts)
            for parts in (("include",), ("gen", "include"), ("gdextension",))
            if os.path.isdir(os.path.join(root, *parts))
        ]
        if not self.header("godot_cpp/godot.hpp"):
            raise BuildError(f"{root}: no include/godot_cpp/godot.hpp; it is no godot-cpp")
        if not self.header("godot_cpp/classes/node.hpp"):
            raise BuildError(
                f"{root}: godot-cpp is not built: no gen/include/godot_cpp/classes/node.hpp. "
                "Build it by its own instructions, or leave it out to use the in-tree binding"
            )
        names = [os.path.join(root, part, library) for part in ("bin", "lib", "lib64")]
        self.library = next((name for name in names if os.path.isfile(name)), None)
        if not self.library:
            raise BuildError(f"{root}: no {library} in bin/ or lib/; build godot-cpp for it")
        self.version = self.read_version()
        if not self.version:
            raise BuildError(f"{root}: no Godot version in include/godot_cpp/core/version.hpp")

    def header(self, name):
        paths = (os.path.join(folder, name) for folder in self.includes)
        return next((path for path in paths if os.path.isfile(path)), None)

    def read_version(self):
        path = self.header("godot_cpp/core/version.hpp")
        text = open(path, encoding="utf-8").read() if path else ""
        parts = [
            re.search(rf"#define\s+GODOT_VERSION_{name}\s+(\d+)", text)
            for name in ("MAJOR", "MINOR", "PATCH")
        ]
        return tuple(int(part.group(1)) for part in parts) if all(parts) else None


def find_godot_cpp(option, library):
    """`godot_cpp=`, then $GODOT_CPP, then a folder godot-cpp/ here. None: the in-tree binding."""
    for root in (option, os.environ.get("GODOT_CPP")):
        if root:
            return GodotCpp(root, library)
    return GodotCpp("godot-cpp", library) if os.path.isdir("godot-cpp") else None


# --- Class documentation ---------------------------------------------------------------------------


def write_class_documentation(target, source, env):
    """The XML files as one C++ source, for gdextension/godot/base/class_documentation.h."""
    texts = []
    for node in source:
        with open(str(node), encoding="utf-8") as file:
            texts.append(f'R"xml({file.read()})xml",\n')
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write(
            "// Written by the build from gdextension/doc_classes/.\n"
            '#include "godot/base/class_documentation.h"\n\n'
            "namespace spidar {\n\n"
            f"const int kClassDocumentationCount = {len(texts)};\n"
            "const char *const kClassDocumentation[] = {\n"
            f"{''.join(texts)}nullptr}};\n\n"
            "} // namespace spidar\n"
        )


# --- The add-on's files --------------------------------------------------------------------------


def write_manifest(target, source, env):
    """The manifest that Godot reads. Its compatibility_minimum is the version of the API that the library was built
    from; source: the template, and that version."""
    template, version = source
    with open(str(template), encoding="utf-8") as file:
        text = file.read()
    if text.count("@GODOT_VERSION@") != 1:
        raise BuildError(f"{template}: needs @GODOT_VERSION@ exactly once")
    with open(str(target[0]), "w", encoding="utf-8") as file:
        file.write(text.replace("@GODOT_VERSION@", version.get_text_contents()))


def write_package(target, source, env):
    """A zip that unpacks as addons/spidar_g/, the same bytes for the same files."""
    addon = env["ADDON"]
    libraries = {os.path.normpath(str(node)) for node in env["PACKAGE_LIBRARIES"]}
    entries = set()
    for folder, folders, names in os.walk(addon):
        folders[:] = [name for name in folders if name not in (".godot", "__pycache__")]
        for name in names:
            path = os.path.normpath(os.path.join(folder, name))
            if os.path.dirname(path) == os.path.join(addon, "bin") and path not in libraries:
                continue  # a leftover of another build
            entries.add(path)
    for name in ("LICENSE.md", "THIRDPARTY.md", "README.md"):
        if os.path.join(addon, name) not in entries:
            raise BuildError(f"{addon}/{name} is missing; a release must hold it")
    with zipfile.ZipFile(str(target[0]), "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(entries):
            info = zipfile.ZipInfo(name.replace(os.sep, "/"), (1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name in libraries else 0o644) << 16
            with open(name, "rb") as file:
                archive.writestr(info, file.read())
    with open(str(target[0]), "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    print(f"{target[0]}: {len(entries)} files, sha256 {digest}")
