#!/usr/bin/python3
"""Reads each DIR/*.vdb with a program that is not ours and compares with DIR/*.json, what was written.

    read_vdb.py pyopenvdb|vdb_print|blender DIR

Status 77: that program is not here. Blender runs this file itself: its Python has pyopenvdb inside."""
import glob
import json
import shutil
import subprocess
import sys


def check(name, found, expected):
    if found != expected:
        sys.exit(f"{name}: found {found}, expected {expected}")


def with_pyopenvdb(path, e):
    try:
        import pyopenvdb as vdb
    except ImportError:
        try:
            import openvdb as vdb
        except ImportError as missing:
            print(missing)
            sys.exit(77)
    grids, _ = vdb.readAll(path)
    check("grids", [g.name for g in grids], ["density"])
    grid = grids[0]
    for name, value in e["metadata"].items():
        found = grid[name]
        check(name, list(found) if isinstance(found, tuple) else found, value)
    check("background", grid.background, 0.0)
    check("active voxels", grid.activeVoxelCount(), e["active"])
    for index, position in e["positions"]:
        check(f"position of {index}", list(grid.transform.indexToWorld(tuple(index))), position)
    get = grid.getConstAccessor()
    for index, value, active in e["points"]:
        found = get.probeValue(tuple(index))
        check(f"point {index}", [found[0], found[1]], [value, active])


def with_vdb_print(path, e):
    if not shutil.which("vdb_print"):
        print("no vdb_print")
        sys.exit(77)
    text = subprocess.run(["vdb_print", "-l", "-m", path], check=True, capture_output=True, text=True).stdout
    text = " ".join(text.split())
    for line in ("density", "Tree_float_5_4_3", f"isovalue: {e['metadata']['isovalue']:g}",
                 f"source: {e['metadata']['source']}", f"Number of active voxels: {e['active']:,}"):
        if line not in text:
            sys.exit(f"vdb_print: no '{line}' in\n{text}")


def with_blender(path, e):
    if not shutil.which("blender"):
        print("no blender")
        sys.exit(77)
    script = f"""
import bpy, sys
bpy.ops.object.volume_import(filepath={path!r}, files=[{{'name': {path.rsplit('/', 1)[1]!r}}}], directory={path.rsplit('/', 1)[0] + '/'!r})
grids = bpy.context.object.data.grids
assert grids.load(), grids.error_message
g = grids[0]
print('BLENDER', len(grids), g.name, g.data_type, g.channels, [list(r) for r in g.matrix_object])
"""
    text = subprocess.run(["blender", "-b", "--factory-startup", "--python-expr", script], capture_output=True, text=True)
    line = [l for l in text.stdout.splitlines() if l.startswith("BLENDER")]
    if not line:
        sys.exit(f"blender: {text.stdout}{text.stderr}")
    words = line[0].split(None, 5)
    check("blender", words[1:5], ["1", "density", "FLOAT", "1"])
    matrix = json.loads(words[5])
    for index, position in e["positions"]:
        found = [sum(row[a] * index[a] for a in range(3)) + row[3] for row in matrix[:3]]
        if max(abs(f - p) for f, p in zip(found, position)) > 1e-4:  # Blender's matrices are floats
            sys.exit(f"blender: {index} at {found}, expected {position}")


program, folder = sys.argv[1:]
paths = sorted(glob.glob(folder + "/*.vdb"))
for p in paths:
    {"pyopenvdb": with_pyopenvdb, "vdb_print": with_vdb_print, "blender": with_blender}[program](
        p, json.load(open(p[:-3] + "json")))
check("files", len(paths) > 0, True)
