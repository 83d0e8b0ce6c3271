#!/usr/bin/env python3
"""Every structure through the whole chain, a line each: is the mesh valid, how bad are its elements, where is its surface.

    mesh_matrix.py BIN FILE... [--region both,interior] [--adapt 0.1,0] [--grid 513 | --spacing 0.5] [--threads N] [--cuts N]
                           [--log X]

Before: the mesh of density2tet. After: that of tetsmooth --density. Outside: elements in 10,000 with a dihedral angle
under 10 or over 160 degrees before (an upper limit: angles are counted), angles under 25 or over 140 after. Off: surface
points further than a fiftieth of a spacing from the isosurface, of them on closed cavities in brackets; far: surface
centroids in 1,000 further than a quarter; turned: surface triangles in 1,000 by more than 45 degrees; missing: volume
that the isosurface encloses beyond the mesh, per cent. Rate: elements a second of all phases of tetsmooth but reading and
writing. !: not valid, other pieces or Euler number than before, or a promise of the README not kept; exit status 1 then.
--cuts: that many boxes each, the same ones every time, that cut the surface somewhere.
--log: every line as JSON too, appended."""
import argparse
import itertools
import json
import pathlib
import random
import subprocess
import sys
import tempfile


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
            try:
                tool(arguments.bin / "pdb2hier", file, "-o", f"{folder}/hier")
                tool(arguments.bin / "hier2density", "-t", arguments.threads, *spacing, f"{folder}/hier", "-o", f"{folder}/vdb")
            except subprocess.CalledProcessError as error:
                print(f"! {file.name}: {error.stderr.strip()}", flush=True)
                bad = True
                continue
            boxes = cuts(arguments.bin, folder, arguments.cuts) if arguments.cuts else ["auto"]
            for region, adapt, box in itertools.product(arguments.region.split(","), arguments.adapt.split(","), boxes):
                try:
                    row = chain(arguments.bin, folder, arguments.threads, region, adapt, box)
                except subprocess.CalledProcessError as error:
                    print(f"! {file.name} {region} {adapt} {box}: {error.stderr.strip()}", flush=True)
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
                        print(json.dumps({"file": file.name, "region": region, "adapt": adapt, "box": box, **row}), file=log)
    return bad


def tool(*command):
    return subprocess.run([command[0], "-q", *command[1:]], check=True, stderr=subprocess.PIPE, text=True)


def stat(folder, binary, mesh):
    """tetstat's answer; a mesh that is not valid has status 5 and an answer too."""
    done = subprocess.run([binary / "tetstat", "-q", "--json", "--crossings", f"{folder}/{mesh}"], stdout=subprocess.PIPE)
    return json.loads(done.stdout)


def cuts(binary, folder, count):
    """Boxes of a fifth to the whole of the surface's extents, their middles in it."""
    tool(binary / "density2tet", "--region", "interior", f"{folder}/vdb", "-o", f"{folder}/in.vtu")
    box = stat(folder, binary, "in.vtu")["box"]
    numbers = random.Random(count)
    boxes = []
    for _ in range(count):
        ends = [[], []]
        for low, high in zip(box["low"], box["high"]):
            middle = numbers.uniform(low, high)
            half = numbers.uniform(0.1, 0.5) * (high - low)
            ends[0].append(f"{middle - half:.4f}")
            ends[1].append(f"{middle + half:.4f}")
        boxes.append(",".join(ends[0] + ends[1]))
    return boxes


def chain(binary, folder, threads, region, adapt, box):
    tool(binary / "density2tet", "-t", threads, "--region", region, "--adapt", adapt, f"--box={box}", f"{folder}/vdb",
         "-o", f"{folder}/in.vtu")
    tool(binary / "tetsmooth", "-t", threads, "--density", f"{folder}/vdb", f"{folder}/in.vtu", "-o", f"{folder}/out.vtu",
         "--report", f"{folder}/report")
    report = json.load(open(f"{folder}/report"))
    before, after = (stat(folder, binary, mesh) for mesh in ("in.vtu", "out.vtu"))
    counts, surface = report["counts"], report["counts"]["surface"]
    seconds = sum(p["seconds"] for p in report["phases"] if p["name"] not in ("read", "write"))
    angle = {name: (mesh["quality"]["dihedral"]["min"], mesh["quality"]["dihedral"]["max"])
             for name, mesh in (("before", before), ("after", after))}
    bins = before["quality"]["dihedral"]["histogram"]["counts"]  # of 5 degrees
    row = {"elements": after["tets"], "elements_before": before["tets"], **angle,
           "outside_before": 1e4 * (sum(bins[:2]) + sum(bins[32:])) / before["tets"],
           "outside_after": counts["quality_after"]["below_25"] + counts["quality_after"]["above_140"],
           "q": after["quality"]["joe_liu_q"]["min"], "ratio": after["quality"]["edge_ratio"]["max"],
           "off": surface["points_off"], "off_cavity": surface["points_off_cavity"],
           "off_wall": surface.get("points_off_wall", 0), "surface_points": surface["points"],
           "far": 1e3 * surface["centroids_off"] / surface["triangles"],
           "turned": 1e3 * surface["turned_45"] / surface["triangles"],
           "missing": 100 * surface["volume_missing"] / surface["volume"], "rate": before["tets"] / seconds,
           "peak_bytes": report["peak_rss_bytes"], "faults": [before["faults"], after["faults"]]}
    same = all(before["surface"][k] == after["surface"][k] for k in ("components", "euler"))
    row["kept"] = (before["valid"] and after["valid"] and same and row["outside_after"] == 0 and row["q"] >= 0.3
                   and row["ratio"] <= 6 and row["far"] <= 10 and row["turned"] <= 1 and abs(row["missing"]) <= 0.5)
    return row


if __name__ == "__main__":
    sys.exit(main())
