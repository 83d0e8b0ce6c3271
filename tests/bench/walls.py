#!/usr/bin/env python3
"""Are the walls of meshes planes, and whole?

    walls.py MESH.vtu…

Of every side of the box that has triangles: all of their corners have one coordinate, to the last bit, and no point of the mesh lies beyond.
Beside the planes: the box asked for, where the run report MESH.tet.vtu.json says it. A side of a mesh of both regions is covered once: areas of its
triangles add up to the rectangle's (largest relative difference). Of an exterior the part that its own triangles cover. Status 5: a wall is no
plane, not that of the box asked for, or not covered."""
import array
import json
import pathlib
import re
import sys

KIND = {"Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B"}


def read(path):
    """The arrays of one of our .vtu by name."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"<AppendedData")
    start = data.index(b"_", end) + 1
    arrays = {}
    for kind, name, offset in re.findall(rb'<DataArray type="(\w+)" Name="([^"]+)"[^>]*offset="(\d+)"', data[:end]):
        at = start + int(offset)
        size = int.from_bytes(data[at:at + 8], "little")
        values = array.array(KIND[kind.decode()])
        values.frombytes(data[at + 8:at + 8 + size])
        arrays[name.decode()] = values
    return arrays


def box_of(mesh):
    """What density2tet was asked for, -x to +z; None: a margin, or no report."""
    try:
        report = json.loads(pathlib.Path(mesh.removesuffix(".vtu") + ".tet.vtu.json").read_text())
        x = [float(v) for v in report["options"]["box"].split(",")]
    except (OSError, ValueError, KeyError):
        return None
    return [x[0], x[3], x[1], x[4], x[2], x[5]] if len(x) == 6 else None


def walls(mesh):
    a = read(mesh)
    point, corner, offset, label = a["Points"], a["connectivity"], a["offsets"], a["boundary"]
    low, high = [min(point[k::3]) for k in range(3)], [max(point[k::3]) for k in range(3)]
    extent = [h - l for l, h in zip(low, high)]
    asked, good, covered, planes = box_of(mesh), True, [], []
    area, count = [0.0] * 6, [0] * 6
    for cell, side in enumerate(label):
        side -= 2
        if not 0 <= side < 6 or offset[cell] - offset[cell - 1] != 3:
            continue
        axis, u, v = side // 2, (side // 2 + 1) % 3, (side // 2 + 2) % 3
        plane = high[axis] if side % 2 else low[axis]
        p, q, r = (3 * i for i in corner[offset[cell] - 3:offset[cell]])
        good = good and point[p + axis] == point[q + axis] == point[r + axis] == plane
        area[side] += abs((point[q + u] - point[p + u]) * (point[r + v] - point[p + v]) -
                          (point[q + v] - point[p + v]) * (point[r + u] - point[p + u])) / 2
        count[side] += 1
    regions = set(a["region"])
    for side in range(6):
        axis = side // 2
        plane = high[axis] if side % 2 else low[axis]
        planes.append(plane)
        if count[side]:
            covered.append(area[side] / (extent[(axis + 1) % 3] * extent[(axis + 2) % 3]))
            if asked and plane != asked[side]:
                good = False
    text = "no walls"
    if covered:
        whole = any(r not in (0, 2, 3) for r in regions) and 2 in regions
        off = max(abs(c - 1) for c in covered)
        good = good and (off < 1e-11 if whole else max(covered) < 1 + 1e-11)
        text = f"{sum(count):,} triangles in {len(covered)} planes" + (", the box asked for" if asked else "") + (
            f", covered but for {off:.0e}" if whole else f", {min(covered):.4f} to {max(covered):.4f} covered")
    print(f"{mesh}: {text}{'' if good else ' — WRONG'}")
    return good


sys.exit(0 if all([walls(m) for m in sys.argv[1:]]) else 5)
