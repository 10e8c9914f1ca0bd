#!/usr/bin/env python3
"""unpack_jolt.py ARCHIVE FOLDER: takes Jolt's sources out of Godot's source archive into FOLDER, whole or not at all.

apt has checked the archive against Debian's signature. What is pinned here are the sources themselves, which stay the
same from one release of Godot to the next while they are of the same version of Jolt.
"""

import hashlib
import os
import shutil
import sys
import tarfile

PLACE = "thirdparty/jolt_physics/"
SHA256 = "d20cdc861da9d516a971d8039894567e38ffa19545a57648cd6f361dda074ae4"


def wanted(name):
    """The path inside Jolt of a file of the archive; None for what is not needed."""
    inner = name.partition("/")[2]
    if not inner.startswith(PLACE):
        return None
    path = inner[len(PLACE):]
    return path if path == "LICENSE" or path.startswith("Jolt/") else None


def digest_of(files):
    """One number for all names and bytes."""
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update(path.encode() + b"\0" + hashlib.sha256(files[path]).digest())
    return digest.hexdigest()


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    archive_path, folder = sys.argv[1:]
    files = {}
    with tarfile.open(archive_path) as archive:
        for member in archive:
            path = wanted(member.name) if member.isfile() else None
            if path:
                files[path] = archive.extractfile(member).read()
    digest = digest_of(files)
    if digest != SHA256:
        sys.exit(
            f"unpack_jolt: the {len(files)} files of Jolt in {os.path.basename(archive_path)} have sha256 {digest}, "
            f"wanted {SHA256}: not the known sources. Give a checkout of Jolt 5.4.0 by jolt=PATH"
        )
    part = folder + ".part"
    shutil.rmtree(part, ignore_errors=True)
    for path, content in files.items():
        place = os.path.join(part, path)
        os.makedirs(os.path.dirname(place), exist_ok=True)
        with open(place, "wb") as file:
            file.write(content)
    os.rename(part, folder)


if __name__ == "__main__":
    main()
