#!/usr/bin/env python3
"""A short movie of a play's frames: python3 make_movie.py DIR FILE.webp (needs Pillow; DIR from --movie)"""

import glob
import os
import sys

FRAME_MS = 80
QUALITY = 55


def main(folder, path):
    from PIL import Image

    names = sorted(glob.glob(os.path.join(folder, "film_*.png")))
    if not names:
        print(f"make_movie: no film_*.png in {folder}; play with --movie first", file=sys.stderr)
        return 1
    frames = [Image.open(name).convert("RGB") for name in names]
    times = [FRAME_MS] * (len(frames) - 1) + [1500]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=times, loop=0, quality=QUALITY, method=4)
    print(f"{path}: {len(frames)} frames, {os.path.getsize(path) / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
