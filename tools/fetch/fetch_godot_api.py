#!/usr/bin/env python3
"""The API of the lowest Godot that a release supports, from the Rust crate gdextension-api (MPL-2.0, data dumped by
Godot itself) into build/api/lowest/: nothing of it is committed. A second call needs no network. Prints the file.
"""

import hashlib
import io
import os
import sys
import tarfile
import urllib.request

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, ROOT)
import methods  # noqa: E402

CRATE = "gdextension-api-0.5.1"
URL = f"https://static.crates.io/crates/gdextension-api/{CRATE}.crate"
SHA256 = "3489a9e7463353467db3cfe3eb12de31c9b6200e4f928bde4959bf5db5b31d2f"
FILE = os.path.join(ROOT, "build", "api", "lowest", "extension_api.json")
TIMEOUT_S = 120


def main():
    if not os.path.isfile(FILE):
        with urllib.request.urlopen(URL, timeout=TIMEOUT_S) as answer:
            data = answer.read()
        digest = hashlib.sha256(data).hexdigest()
        if digest != SHA256:
            sys.exit(f"fetch_godot_api: {CRATE} has sha256 {digest}, wanted {SHA256}: not the known crate")
        with tarfile.open(fileobj=io.BytesIO(data)) as archive:
            member = f"{CRATE}/src/{methods.dotted(methods.MINIMUM_GODOT)}/extension_api.json"
            text = archive.extractfile(member).read()
        os.makedirs(os.path.dirname(FILE), exist_ok=True)
        with open(FILE + ".part", "wb") as file:
            file.write(text)
        os.rename(FILE + ".part", FILE)
    print(FILE)


if __name__ == "__main__":
    main()
