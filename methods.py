"""Helpers of SConstruct: sources, options, libraries of others, the release zip. What the nodes are compiled with is in
godot_binding.py."""

import hashlib
import os
import platform
import shlex
import subprocess
import zipfile

SANITIZERS = ("address", "undefined", "thread", "realtime")  # realtime: clang 20 and later


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
    """The library tells nobody where it was built, nor where the headers of others lay. Its debug information names the
    compiler's current folder, and a check in a header the header."""
    for folder, shown in (("/usr", "usr"), (env["glm"].rstrip("/"), "glm")):
        if os.path.isabs(folder) and accepts(env, "-ffile-prefix-map=/a=b"):
            env.Append(CCFLAGS=[f"-ffile-prefix-map={folder}/={shown}/".replace("$", "$$")])
    flag = "-fdebug-compilation-dir=."
    if accepts(env, flag):
        env.Append(CCFLAGS=[flag])
    elif os.path.isdir("/proc/self/cwd"):
        # GCC has no such flag, but takes the name of its current folder from PWD if that is one.
        env["ENV"]["PWD"] = "/proc/self/cwd"


def link_inside(link, folder):
    """`link`, a path inside the checkout, made to lead to a folder of any name elsewhere."""
    wanted = os.path.abspath(folder)
    if not os.path.islink(link) or os.readlink(link) != wanted:
        os.makedirs(os.path.dirname(link), exist_ok=True)
        if os.path.lexists(link):
            os.unlink(link)
        os.symlink(wanted, link)
    return link


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


# --- Linux on arm64, cross-compiled -----------------------------------------------------------------


def use_cross_compiler(env):
    """Debian's cross-compiler. It finds headers that are the same for all in the host's /usr/include."""
    prefix = "aarch64-linux-gnu-"
    env.Replace(CC=prefix + "gcc", CXX=prefix + "g++", AR=prefix + "ar", RANLIB=prefix + "ranlib")


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


def library_path(addon, platform_name, arch, target):
    name = f"spidar_g.{platform_name}.{target}.{arch}"
    return f"{addon}/bin/{name}.dll" if platform_name == "windows" else f"{addon}/bin/lib{name}.so"


def guard_path(addon, arch):
    """The guard of serial boards; device/serial/port_guard.cpp looks for it by this name."""
    return f"{addon}/bin/spidar_g_guard.{arch}"


def other_libraries(addon, targets):
    """What a release holds beside what is built for this machine, which is Linux on x86-64."""
    paths = [library_path(addon, "windows", "x86_64", target) for target in targets]
    paths += [library_path(addon, "linux", "arm64", target) for target in targets]
    return [*paths, guard_path(addon, "arm64")]


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
            f"{name} is missing: install hidapi with its static library (Debian: libhidapi-dev, for another "
            "processor libhidapi-dev:arm64), or give hidapi=FILE"
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
    return link_inside("build/jolt", root)


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
