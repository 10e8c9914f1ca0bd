#!/usr/bin/env python3
"""fetch_peers.py [--contacts]: peers of the benches.

With --contacts those of the contact bench: FCL and Bullet where Debian's packages libfcl-dev and libbullet-dev are
installed, and Jolt's own GJK. Otherwise the peers of the tension bench, from PyPI into build/peers/: nothing of them is committed.

DAQP 0.11.0 (MIT) must be there: figures are ratios to it. quadprog (GPL), eiquadprog (LGPL, needs Eigen) and
qpOASES (LGPL, its packaged library) come where they can be had; the bench says which are missing. Each is built with its
adapter in this folder; DAQP and eiquadprog twice, for plain x86-64 and for AVX2. A second call finds the libraries
and needs no network.
"""

import glob
import os
import shlex
import subprocess
import sys
import tarfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
FOLDER = os.path.join(ROOT, "build", "peers")
SHARED = ["-DNDEBUG", "-fPIC", "-shared"]
AVX2 = ["-march=x86-64-v3"]
EIGEN = "/usr/include/eigen3"


class Missing(Exception):
    """A peer that this machine cannot have; the text says why."""


def unpacked(package, version, source):
    """The folder of a package, fetched and unpacked when it is not there yet."""
    folder = os.path.join(FOLDER, f"{package}-{version}")
    if os.path.isdir(folder):
        return folder
    pattern = os.path.join(glob.escape(FOLDER), f"{package.replace('-', '_')}-{version}*")
    archives = glob.glob(pattern + (".tar.gz" if source else ".whl"))
    if not archives:
        kind = "--no-binary" if source else "--only-binary"
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", kind, package, "--dest", FOLDER,
                   f"{package}=={version}"]
        done = subprocess.run(command, capture_output=True, text=True)
        archives = glob.glob(pattern + (".tar.gz" if source else ".whl"))
        if done.returncode != 0 or not archives:
            why = (done.stderr.strip().splitlines() or ["no archive"])[-1]
            raise Missing(f"pip could not bring {package} {version} ({why}). Without a network, put its "
                          f"{'source archive' if source else 'wheel'} into build/peers/ and run this again")
    part = folder + ".part"
    opened = tarfile.open(archives[0]) if source else zipfile.ZipFile(archives[0])
    with opened as archive:
        archive.extractall(part)
    inner = os.path.join(part, f"{package}-{version}")
    os.rename(inner if source else part, folder)
    return folder


def compile_library(name, compiler, arguments):
    library = os.path.join(FOLDER, f"lib{name}.so")
    done = subprocess.run([*compiler, *SHARED, *arguments, "-lm", "-o", library], capture_output=True, text=True)
    if done.returncode != 0:
        raise Missing(f"cannot compile {name}:\n{done.stderr[-2000:]}")


def c_compiler():
    return shlex.split(os.environ.get("CC", "cc"))


def cxx_compiler():
    return [*shlex.split(os.environ.get("CXX", "c++")), "-std=c++17"]


def daqp(name, flags):
    csrc = os.path.join(unpacked("daqp", "0.11.0", source=True), "csrc")
    files = sorted(glob.glob(os.path.join(glob.escape(csrc), "src", "*.c")))
    # Its own flags, without the clock calls of its profiling build.
    own = ["-O3", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"]
    compile_library(name, c_compiler(),
                    [*own, *flags, "-I", os.path.join(csrc, "include"), os.path.join(HERE, "daqp.c"), *files])


def quadprog(name, flags):
    folder = os.path.join(unpacked("quadprog", "0.1.14", source=True), "quadprog")
    files = [os.path.join(folder, file) for file in ("linear-algebra.c", "qr-update.c", "solve.QP.c")]
    compile_library(name, c_compiler(), ["-O3", *flags, os.path.join(HERE, "quadprog.c"), *files])


def eiquadprog(name, flags):
    if not os.path.isdir(EIGEN):
        raise Missing(f"eiquadprog needs Eigen in {EIGEN} (Debian: libeigen3-dev)")
    folder = unpacked("eiquadprog", "1.3.2", source=False)
    compile_library(name, cxx_compiler(),
                    ["-O3", *flags, "-isystem", EIGEN, "-isystem", os.path.join(folder, "cmeel.prefix", "include"),
                     os.path.join(HERE, "eiquadprog.cc")])


def qpoases(name, flags):
    prefix = os.path.join(unpacked("cmeel-qpoases", "3.2.2", source=False), "cmeel.prefix")
    library = os.path.join(prefix, "lib")
    compile_library(name, cxx_compiler(),
                    ["-O3", *flags, "-isystem", os.path.join(prefix, "include"), os.path.join(HERE, "qpoases.cc"),
                     os.path.join(library, "libqpOASES.so.3.2"), "-Wl,-rpath,$ORIGIN/" + os.path.relpath(library, FOLDER)])


# Name of the library, its adapter, how it is made, flags.
PEERS = (
    ("daqp_plain", "daqp.c", daqp, []),
    ("daqp_avx2", "daqp.c", daqp, AVX2),
    ("quadprog", "quadprog.c", quadprog, []),
    ("eiquadprog_plain", "eiquadprog.cc", eiquadprog, []),
    ("eiquadprog_avx2", "eiquadprog.cc", eiquadprog, AVX2),
    ("qpoases", "qpoases.cc", qpoases, []),
)


def contacts(name, flags):
    """An adapter of the contact bench; flags: the folder of its headers, then libraries."""
    folder, *libraries = flags
    if not os.path.isdir(folder):
        raise Missing(f"{folder} is missing (Debian: libfcl-dev, libbullet-dev; Jolt comes with ./dev build)")
    adapter = os.path.join(HERE, name.removesuffix("_contacts") + ".cc")
    compile_library(name, cxx_compiler(), ["-O2", "-isystem", EIGEN, "-isystem", folder, adapter, *libraries])


CONTACT_PEERS = (
    ("fcl_contacts", "fcl.cc", contacts, ["/usr/include/fcl", "-lfcl", "-lccd"]),
    ("bullet_contacts", "bullet.cc", contacts, ["/usr/include/bullet", "-lBulletCollision", "-lLinearMath"]),
    ("jolt_contacts", "jolt.cc", contacts, [os.path.join(ROOT, "build", "jolt")]),
)


def main():
    os.makedirs(FOLDER, exist_ok=True)
    for name, adapter, make, flags in CONTACT_PEERS if "--contacts" in sys.argv[1:] else PEERS:
        library = os.path.join(FOLDER, f"lib{name}.so")
        if os.path.isfile(library) and os.path.getmtime(library) > os.path.getmtime(os.path.join(HERE, adapter)):
            continue
        try:
            make(name, flags)
            print(f"fetch_peers: {os.path.relpath(library, ROOT)}")
        except Missing as reason:
            if name == "daqp_plain":
                sys.exit(f"fetch_peers: {reason}.")
            print(f"fetch_peers: no {name}: {reason}.", file=sys.stderr)


if __name__ == "__main__":
    main()
