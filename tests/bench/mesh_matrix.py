#!/usr/bin/env python3
"""Every structure through the whole chain, a line each: is the mesh valid, how bad are its elements, where is its surface.

    mesh_matrix.py BIN FILE... [--region both,interior] [--adapt 0.1,0] [--grid 513 | --spacing 0.5] [--threads N] [--cuts N]
                           [--log X]

Before: the mesh of density2tet. After: that of tetsmooth --density. Outside: elements in 10,000 with a dihedral angle
under 10 or over 160 degrees before (an upper limit: angles are counted), angles under 25 or over 140 after. Off: surface
points further than a fiftieth of a spacing from the isosurface, of them on closed cavities in brackets; far: surface
centroids in 1,000 further than a quarter; turned: surface triangles in 1,000 by more than 45 degrees; missing: volume
that the isosurface encloses beyond the mesh, per cent. Rate: elements a second of all phases of tetsmooth but reading and
writing. !: not valid, other components or Euler number than before, or a promise not kept; exit status 1 then.
--cuts: that many boxes each, the same ones every time, that cut the surface somewhere.
--log: every line as JSON too, appended."""
import argparse
import itertools
import json
import pathlib
import sys
import tempfile

from chain import Chain, ToolError


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("file", type=pathlib.Path, nargs="+")
    parser.add_argument("--region", default="both")
    parser.add_argument("--adapt", default="auto")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--grid")
    size.add_argument("--spacing", default="0.5")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--cuts", type=int, default=0)
    parser.add_argument("--log", type=pathlib.Path)
    arguments = parser.parse_args()
    spacing = ["--grid", arguments.grid] if arguments.grid else ["--spacing", arguments.spacing]
    print(f"{'':28} {'region':8} {'adapt':>5} {'elements':>10} {'before':>15} {'outside':>7} {'after':>15} {'outside':>7} "
          f"{'Q':>5} {'ratio':>5} {'off':>9} {'far':>6} {'turned':>6} {'missing':>7} {'rate':>8}")
    bad = False
    for file in arguments.file:
        with tempfile.TemporaryDirectory() as folder:
            chain = Chain(arguments.bin, folder, arguments.threads)
            try:
                chain.hierarchy(file)
                chain.density(*spacing)
            except ToolError as error:
                print(f"! {file.name}: {error}", flush=True)
                bad = True
                continue
            boxes = chain.cuts(arguments.cuts) if arguments.cuts else ["auto"]
            for region, adapt, box in itertools.product(arguments.region.split(","), arguments.adapt.split(","), boxes):
                try:
                    row = chain.row(region, adapt, box)
                except ToolError as error:
                    print(f"! {file.name} {region} {adapt} {box}: {error}", flush=True)
                    bad = True
                    continue
                bad |= not row["kept"]
                print(f"{'' if row['kept'] else '! '}{file.name:28} {region:8} {adapt:>5} {row['elements']:10} "
                      f"{row['before'][0]:7.2f} {row['before'][1]:7.2f} {row['outside_before']:7.2f} "
                      f"{row['after'][0]:7.2f} {row['after'][1]:7.2f} {row['outside_after']:7} {row['q']:5.3f} "
                      f"{row['ratio']:5.2f} {row['off']:4} {'(%d)' % row['off_cavity']:>4} {row['far']:6.3f} "
                      f"{row['turned']:6.3f} {row['missing']:7.3f} {row['rate']:8.0f}", flush=True)
                if arguments.log:
                    with arguments.log.open("a") as log:
                        print(json.dumps({"file": file.name, "adapt": adapt, "box": box, **row}), file=log)
    return bad


if __name__ == "__main__":
    sys.exit(main())
