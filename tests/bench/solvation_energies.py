#!/usr/bin/env python3
"""`make X.energy` beside the molecular surface: the solvation energy by APBS on finer and finer grids; volume, area, tunnels, cavities.

    solvation_energies.py BIN FILE.pqr... [--spacing H]... [--make 'VARIABLE=VALUE ...'] [--apbs APBS]

BIN: folder of the tools. The files are those of molecular_set.py, and so is the molecular surface that of molecular_surface.py: its own field, as
dielectric maps for APBS on a grid of twice each --spacing (default 0.35 and 0.25 Å). A map's energy has no surface of APBS's own in it, but
errs by up to 1 % to either side as the grid happens to lie. Volume, area, tunnels and cavities are those of the field at the last spacing, and
of the mesh of X.energy. Seconds are of the processor, for the whole of `make`, the solver included; memory is that of its largest program. Needs numpy, scipy."""
import argparse
import json
import pathlib
import shlex
import shutil
import statistics
import sys
import tempfile

import numpy as np

import molecular_surface as ms

USED = """import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stderr=subprocess.DEVNULL)
u = resource.getrusage(resource.RUSAGE_CHILDREN)
print("used", u.ru_utime + u.ru_stime, u.ru_maxrss)"""
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def chain(o, file, scratch):
    """What make X.energy says, and what it takes."""
    shutil.copy(file, f"{scratch}/x.pqr")
    command = ["make", "-s", "-f", SOURCE / "Makefile.pipeline", f"BIN={o.bin}", "PDB2HIER_FLAGS=-q", "TETSMOOTH_FLAGS=-q", "DENSITY2TET_FLAGS=-q",
               *shlex.split(o.make), "x.energy"]
    # By a small process: what a large one starts has its memory at first.
    said, used = ms.run(sys.executable, "-c", USED, *command, cwd=scratch).rsplit("used ", 1)
    words, (seconds, kilobytes) = said.split("energy ")[1].split(), map(float, used.split())
    stat = json.loads(ms.run(o.bin / "tetstat", "--json", f"{scratch}/x.solvent.vtu"))
    bodies = json.loads(ms.run(o.bin / "tetstat", "--json", "--bodies", f"{scratch}/x.solvent.vtu"))["bodies"]
    assert stat["valid"]
    surface, parts = stat["surface"], sum(b["region"] == 1 for b in bodies)
    return {"energy": float(words[0]), "unknowns": int(words[words.index("unknowns,") - 1]), "elements": stat["tets"],
            "seconds": seconds, "megabytes": kilobytes / 1024, "volume": surface["volume"], "area": surface["area"],
            "tunnels": surface["components"] - surface["euler"] // 2, "cavities": surface["components"] - parts}


def surface_field(o, h, scratch):
    """The distance from the molecular surface near it, positive inside, with the place of its first point."""
    report = f"{scratch}/d.json"
    ms.run(o.bin / "hier2density", "-q", "--surface", "ses", "--spacing", h, "--margin", 5, f"{scratch}/x.hier", "-o", f"{scratch}/d.vdb", "--report", report)
    ms.run(o.bin / "density2map", "-q", f"{scratch}/d.vdb", "-o", f"{scratch}/d.map")
    with open(report) as f:
        origin = json.load(f)["counts"]["origin"]
    map_bytes = pathlib.Path(f"{scratch}/d.map").read_bytes()
    shape = np.frombuffer(map_bytes, np.int32, 3)
    values = np.frombuffer(map_bytes, np.float32, int(np.prod(shape)), 1024).reshape(shape[::-1]).T
    return np.log(np.maximum(values, 1e-6)).astype(float), np.array(origin)


def reference(o, file, h, scratch):
    """The molecular surface's measures, its energy by APBS among them."""
    o.spacing = h
    field, low = surface_field(o, h, scratch)
    pqr = ms.read_pqr(str(file))
    return ms.measure(field, h) | {"energy": ms.total_energy(o, pqr, low, field.shape, scratch, field) - ms.total_energy(o, pqr, low, field.shape, scratch)}


def extrapolated(spacings, energies):
    """To a spacing of 0, from the last two: the error falls with its square."""
    if len(energies) == 1:
        return energies[0]
    a, b = (h * h for h in spacings[-2:])
    return energies[-1] + (energies[-1] - energies[-2]) * b / (a - b)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("file", nargs="+", type=pathlib.Path)
    parser.add_argument("--spacing", action="append", type=float)
    parser.add_argument("--make", default="")
    parser.add_argument("--apbs", default="apbs")
    o = parser.parse_args()
    spacings = o.spacing or [0.35, 0.25]
    print("| structure | atoms | APBS, kJ/mol | extrapolated | `X.energy` | off | volume | area | tunnels, cavities | the molecular "
          "surface's | elements | unknowns | processor, s | memory, MB |")
    print("|" + "---|" * 14)
    off, holes = [], []
    for file in o.file:
        with tempfile.TemporaryDirectory() as scratch:
            ours = chain(o, file, scratch)
            theirs = [reference(o, file, h, scratch) for h in spacings]
        last = theirs[-1]
        true = extrapolated(spacings, [t["energy"] for t in theirs])
        off.append([100 * (ours["energy"] / true - 1)] + [100 * (ours[w] / last[w] - 1) for w in ("volume", "area")])
        holes.append([ours["tunnels"], ours["cavities"], last["tunnels"], last["cavities"]])
        print(f"| {file.name.removesuffix('.pqr')} | {len(ms.read_pqr(str(file))[0]):,} | " + ", ".join(f"{t['energy']:,.1f}" for t in theirs) +
              " (" + ", ".join(f"{2 * h:g}" for h in spacings) + " Å)" +
              f" | {true:,.1f} | {ours['energy']:,.1f} | " + " | ".join(f"{x:+.1f} %" for x in off[-1]) + " | {}, {} | {}, {} |".format(*holes[-1]) +
              f" {ours['elements']:,} | {ours['unknowns']:,} | {ours['seconds']:.0f} | {ours['megabytes']:,.0f} |", flush=True)
    for what, column in zip(("energy", "volume", "area"), zip(*off)):
        print(f"{what}: median {statistics.median(column):+.2f} %, of absolute values {statistics.median(map(abs, column)):.2f} %, "
              f"from {min(column):+.1f} to {max(column):+.1f} %")
    print("tunnels, cavities: {}, {}; the molecular surfaces have {}, {}".format(*map(sum, zip(*holes))))


if __name__ == "__main__":
    main()
