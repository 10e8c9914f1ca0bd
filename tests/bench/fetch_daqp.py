#!/usr/bin/env python3
"""The peer of the tension bench: DAQP 0.11.0 (MIT) from its PyPI source package, built into build/daqp/.

Nothing of it is committed. A second call finds the libraries and needs no network. It is built twice, for plain
x86-64 and for AVX2: the bench compares with the faster one.
"""

import glob
import os
import subprocess
import sys
import tarfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(ROOT, "build", "daqp")
VERSION = "0.11.0"
# Its own flags, without the clock calls of its profiling build.
FLAGS = ["-O3", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math", "-DNDEBUG", "-fPIC", "-shared"]
BUILDS = {"plain": [], "avx2": ["-march=x86-64-v3"]}


def sources():
    """The folder of DAQP's C sources, downloaded and unpacked when it is not there yet."""
    found = glob.glob(os.path.join(FOLDER, f"daqp-{VERSION}", "csrc"))
    if found:
        return found[0]
    archive = os.path.join(FOLDER, f"daqp-{VERSION}.tar.gz")
    if not os.path.isfile(archive):
        os.makedirs(FOLDER, exist_ok=True)
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", "daqp",
                   "--dest", FOLDER, f"daqp=={VERSION}"]
        if subprocess.run(command).returncode != 0 or not os.path.isfile(archive):
            sys.exit(f"fetch_daqp: pip could not bring daqp {VERSION}. Without a network, put its source "
                     f"package at build/daqp/daqp-{VERSION}.tar.gz and run this again.")
    with tarfile.open(archive) as package:
        package.extractall(FOLDER)
    return os.path.join(FOLDER, f"daqp-{VERSION}", "csrc")


def main():
    adapter = os.path.join(ROOT, "tests", "bench", "daqp", "adapter.c")
    for name, flags in BUILDS.items():
        library = os.path.join(FOLDER, f"libdaqp_{name}.so")
        if os.path.isfile(library) and os.path.getmtime(library) > os.path.getmtime(adapter):
            continue
        csrc = sources()
        files = sorted(glob.glob(os.path.join(csrc, "src", "*.c")))
        command = [os.environ.get("CC", "cc"), *FLAGS, *flags, "-I", os.path.join(csrc, "include"),
                   adapter, *files, "-lm", "-o", library]
        if subprocess.run(command).returncode != 0:
            sys.exit(f"fetch_daqp: cannot compile DAQP ({name}); the command is above.")
        print(f"fetch_daqp: {os.path.relpath(library, ROOT)}")


if __name__ == "__main__":
    main()
