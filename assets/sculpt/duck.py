#!/usr/bin/env python3
"""duck.py FOLDER: writes block.nrrd, a ball of clay on 66^3 voxels (70^3 nodes with the field's margin),
and duck.json, the strokes that make a duck of it. Nothing random."""

import json
import math
import pathlib
import sys

VOXELS, SPACING = 66, 0.0015  # m
SIDE = (VOXELS - 1) * SPACING


def block():
    """Values fall by 16 a voxel away from a ball of 22 mm about (0, -12, -4) mm; 128 is its surface."""
    values = bytearray()
    for k in range(VOXELS):
        for j in range(VOXELS):
            for i in range(VOXELS):
                x, y, z = (n * SPACING - SIDE / 2 for n in (i, j, k))
                off = math.sqrt(x * x + (y + 0.012) ** 2 + (z + 0.004) ** 2) - 0.022
                values.append(max(0, min(255, round(128 - 16 * off / SPACING))))
    # LPS: x is the scene's x, superior its y, and posterior the opposite of its z.
    mm, low = 1e3 * SPACING, 1e3 * SIDE / 2
    head = (f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {VOXELS} {VOXELS} {VOXELS}\nencoding: raw\n"
            "space: left-posterior-superior\n"
            f"space units: \"mm\" \"mm\" \"mm\"\nspace directions: ({mm},0,0) (0,0,{mm}) (0,{-mm},0)\nspace origin: ({-low},{low},{-low})\n\n")
    return head.encode() + bytes(values)


def stroke(tool, radius, *points, **more):
    return {"tool": tool, "radius": radius / 1e3, "points": [[c / 1e3 for c in p] for p in points], **more}


def arc(centre, radius, begin, end, count, height=lambda t: 0.0):
    """Places (mm) on a horizontal arc, degrees from +z towards +x."""
    for n in range(count + 1):
        t = n / count
        a = math.radians(begin + t * (end - begin))
        yield (centre[0] + radius * math.sin(a), centre[1] + height(t), centre[2] + radius * math.cos(a))


def duck():
    yield stroke("add", 14, (0, -14, -12), (0, -14, 6))  # a longer body
    yield stroke("add", 9, (0, 4, 8), (0, 12, 11))  # the neck
    yield stroke("add", 12.5, (0, 18, 13))  # the head
    yield stroke("drag", 14, (0, -4, -26), (0, 6, -35), strength=1.0)  # the tail, pulled up and back
    yield stroke("drag", 8, (0, 2, -33), (0, 9, -38), strength=1.0)
    for side in (-1, 1):  # wings: lifted, then a groove below each
        yield stroke("add", 5, *arc((0, -10, -5), 21, side * 60, side * 125, 12, lambda t: 3 * t), falloff=0.4)
        yield stroke("carve", 1.8, *arc((0, -16, -5), 24.5, side * 55, side * 125, 16, lambda t: 5 * t))
    yield stroke("smooth", 12, (-16, -8, -5), (-10, -4, -18), strength=0.6)
    yield stroke("smooth", 12, (16, -8, -5), (10, -4, -18), strength=0.6)
    yield stroke("add", 4.2, (-3.2, 14.5, 25), (3.2, 14.5, 25))  # the beak
    yield stroke("add", 3.4, (-2.5, 14.2, 29), (2.5, 14.2, 29))
    yield stroke("carve", 1.4, *arc((0, 14.0, 20), 13.4, -40, 40, 16))  # its mouth
    yield stroke("smooth", 10, (0, 8, 4), (0, 10, 17), strength=0.8)
    for side in (-1, 1):  # eyes: a hollow and a ball in it
        yield stroke("carve", 3.8, (side * 6.9, 22.4, 22.4))
        yield stroke("add", 3.0, (side * 6.0, 21.8, 21.1))
    yield stroke("carve", 30, (0, -20, 0))  # a slip of the hand
    yield {"tool": "undo"}
    yield stroke("carve", 12, *[(x, -39, z) for z in (-30, -15, 0, 15) for x in (-30, 0, 30)])  # a flat foot


folder = pathlib.Path(sys.argv[1])
folder.mkdir(parents=True, exist_ok=True)
(folder / "block.nrrd").write_bytes(block())
(folder / "duck.json").write_text(json.dumps({"sculpt": 1, "strokes": list(duck())}, indent=1) + "\n")
