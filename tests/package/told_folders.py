#!/usr/bin/env python3
"""Fails when a library or program names a folder of the machine that it was built on: told_folders.py FILE..."""

import re
import sys

# A path from the root of the file system, of a folder where sources, headers or tools lie; what the program opens when it
# runs lies elsewhere.
FOLDER = re.compile(rb"(?<![\w.])/(?:usr|home|root|work|tmp|build|opt|srv|mnt)/[\w.+/-]+")


def told_folders(path):
    with open(path, "rb") as file:
        return sorted({found.decode() for found in FOLDER.findall(file.read())})


if __name__ == "__main__":
    told = {path: told_folders(path) for path in sys.argv[1:]}
    for path, folders in told.items():
        if folders:
            print(f"{path} names {', '.join(folders[:5])}")
    sys.exit(1 if any(told.values()) or not told else 0)
