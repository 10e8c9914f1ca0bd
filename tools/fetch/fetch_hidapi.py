#!/usr/bin/env python3
"""hidapi's sources for the Windows build, from PyPI's source package into build/hidapi/: nothing of it is committed.

On Linux the distribution's own library is linked; for a cross-compiler there is none. A second call finds the
sources and needs no network. Prints the folder.
"""

import hashlib
import json
import os
import subprocess
import sys
import tarfile
import urllib.parse
import urllib.request

from pip._internal.models.index import PyPI  # where pip looks when nothing else is set

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FOLDER = os.path.join(ROOT, "build", "hidapi")
ARCHIVE = "hidapi-0.14.0.post4.tar.gz"
SHA256 = "48fce253e526d17b663fbf9989c71c7ef7653ced5f4be65f1437c313fb3dbdf6"
TIMEOUT_S = 60


def index_url():
    """The package index that pip uses here."""
    setting = subprocess.run(
        [sys.executable, "-m", "pip", "config", "get", "global.index-url"], capture_output=True, text=True
    ).stdout.strip()
    return (os.environ.get("PIP_INDEX_URL") or setting or PyPI.simple_url).rstrip("/")


def download():
    request = urllib.request.Request(
        f"{index_url()}/hidapi/", headers={"Accept": "application/vnd.pypi.simple.v1+json"}
    )
    with urllib.request.urlopen(request, timeout=TIMEOUT_S) as answer:
        files = json.load(answer)["files"]
    url = next(file["url"] for file in files if file["filename"] == ARCHIVE)
    with urllib.request.urlopen(urllib.parse.urljoin(request.full_url, url), timeout=TIMEOUT_S) as answer:
        return answer.read()


def main():
    if not os.path.isdir(FOLDER):
        part = FOLDER + ".part"
        os.makedirs(part, exist_ok=True)
        data = download()
        digest = hashlib.sha256(data).hexdigest()
        if digest != SHA256:
            sys.exit(f"fetch_hidapi: {ARCHIVE} has sha256 {digest}, wanted {SHA256}: not the known package")
        path = os.path.join(part, ARCHIVE)
        with open(path, "wb") as file:
            file.write(data)
        with tarfile.open(path) as archive:
            archive.extractall(part)
        inner = os.path.join(part, ARCHIVE.removesuffix(".tar.gz"), "hidapi")
        os.rename(inner, FOLDER)
    print(FOLDER)


if __name__ == "__main__":
    main()
