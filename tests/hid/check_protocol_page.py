#!/usr/bin/env python3
"""docs/reference/hid_protocol.md shows the report descriptor that the code has. Prints "N passed, N failed"."""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def main():
    header = read("gdextension/device/hid/protocol/hid_descriptor.h")
    body = header[header.index("kHidReportDescriptor") : header.index("};")]
    code = [int(byte, 16) for byte in re.findall(r"0x([0-9A-F]{2}),", re.sub(r"//.*", "", body))]
    page = read("docs/reference/hid_protocol.md")
    blocks = re.findall(r"```(?:text)?\n((?:[0-9A-F]{2}\s+)+)```", page)
    shown = [int(byte, 16) for byte in blocks[0].split()] if len(blocks) == 1 else []
    same = bool(code) and code == shown
    if not same:
        print(f"docs/reference/hid_protocol.md shows {len(shown)} bytes, the code has {len(code)}: not equal")
    print("1 passed, 0 failed" if same else "0 passed, 1 failed")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
