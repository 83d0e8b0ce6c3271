#!/usr/bin/env python3
"""How long does tetsmooth take to find out that nothing helps?

    fans.py BIN

Fans: 50, 200, 1,000 and 5,000 thin elements round one edge. Microseconds for each element on one thread, of all phases but
reading and writing: the least of 25 passes over all fans. The goal is 50. Status 5 where it is missed."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile


def fan(n):
    """A .vtu of n elements round an edge from (0, 0, 0) to (0, 0, 1), whose other corners are on a circle."""
    points = "0 0 0 0 0 1 " + " ".join(f"{math.cos(2 * math.pi * k / n)!r} {math.sin(2 * math.pi * k / n)!r} 0.5" for k in range(n))
    corners = " ".join(f"0 1 {2 + k} {2 + (k + 1) % n}" for k in range(n))
    array = '<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">{}</DataArray>'
    return (f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<Piece NumberOfPoints="{n + 2}" NumberOfCells="{n}"><Points>{array.format("Float64", "Points", 3, points)}</Points><Cells>'
            + array.format("Int32", "connectivity", 1, corners)
            + array.format("Int32", "offsets", 1, " ".join(str(4 * k + 4) for k in range(n)))
            + array.format("UInt8", "types", 1, " ".join(["10"] * n))
            + '</Cells></Piece></UnstructuredGrid></VTKFile>')


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    sizes = 50, 200, 1000, 5000
    least = dict.fromkeys(sizes, math.inf)
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        for n in sizes:
            pathlib.Path(at(f"{n}.vtu")).write_text(fan(n))
        for _ in range(25):
            for n in sizes:
                subprocess.run([os.path.join(sys.argv[1], "tetsmooth"), "-q", "-t", "1", at(f"{n}.vtu"), "-o", at("out.vtu"),
                                "--report", at("report.json")], check=True)
                phases = json.loads(pathlib.Path(at("report.json")).read_text())["phases"]
                least[n] = min(least[n], sum(p["seconds"] for p in phases if p["name"] not in ("read", "write")))
    met = True
    for n in sizes:
        each = least[n] / n
        print(f"{n:6,} elements: {1e6 * each:6.1f} µs each")
        met = met and each <= 50e-6
    return 0 if met else 5


if __name__ == "__main__":
    sys.exit(main())
