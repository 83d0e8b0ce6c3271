#!/usr/bin/python3
"""The default surface beside the solvent-excluded one: volumes and Euler numbers (design.md §4), from our own output.

    surface_table.py BIN FILE... [--spacing H] [--setting 'P_R P_C DECAY']...

BIN: folder of the tools. The solvent-excluded volume is summed on a grid of 0.35 Å from the same atoms and radii, probe 1.4 Å:
what is farther than the probe's radius from every place where its centre can be; a lone sphere of 2 Å comes out 0.006 Å too
large. Needs numpy and scipy."""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np
from scipy import ndimage

PROBE, STEP = 1.4, 0.35


def solvent_excluded_volume(atoms):
    xyz, radius = atoms[:, :3], atoms[:, 3]
    low = xyz.min(0) - radius.max() - 2 * PROBE - 2 * STEP
    shape = np.ceil((xyz.max(0) + radius.max() + 2 * PROBE + 2 * STEP - low) / STEP).astype(int) + 1
    free = np.full(shape, 2.0, np.float32)  # distance beyond the surface on which the probe's centre may be, up to 2 Å
    axes = [low[a] + STEP * np.arange(shape[a]) for a in range(3)]
    for c, r in zip(xyz, radius):
        reach = r + PROBE + 2
        box = [slice(max(0, int((c[a] - reach - low[a]) / STEP)), int((c[a] + reach - low[a]) / STEP) + 2) for a in range(3)]
        d2 = sum(np.square(axes[a][box[a]] - c[a]).reshape([-1 if b == a else 1 for b in range(3)]) for a in range(3))
        part = free[box[0], box[1], box[2]]
        np.minimum(part, np.sqrt(d2) - (r + PROBE), out=part)
    distance, nearest = ndimage.distance_transform_edt(free < 0, sampling=STEP, return_indices=True)
    sure = int((distance > PROBE + STEP).sum())
    # Where it is close, the distance from the surface itself, seen from the grid points behind it.
    x = np.argwhere((distance > PROBE - 2 * STEP) & (distance <= PROBE + STEP) & (free < 0))
    y = np.stack([n[tuple(x.T)] for n in nearest], 1)
    d = np.full(len(x), np.inf)
    for offset in np.ndindex(5, 5, 5):
        at = np.clip(y + np.array(offset) - 2, 0, shape - 1)
        f = free[tuple(at.T)]
        d = np.where(f >= 0, np.minimum(d, STEP * np.sqrt(np.square(x - at).sum(1)) - f), d)
    return (sure + float(np.clip((d - PROBE) / STEP + 0.5, 0, 1).sum())) * STEP**3


def tool(folder, name, *arguments):
    subprocess.run([f"{folder}/{name}", "-q", "-t", "1", *arguments], check=True)


def surface(folder, hier, spacing, decay, scratch):
    vdb, vtu = f"{scratch}/s.vdb", f"{scratch}/s.vtu"
    tool(folder, "hier2density", "--spacing", str(spacing), "--decay", str(decay), hier, "-o", vdb)
    tool(folder, "density2tet", "--adapt", "0", "--region", "interior", vdb, "-o", vtu)
    text = subprocess.run([f"{folder}/tetstat", "--json", vtu], capture_output=True, text=True).stdout
    found = json.loads(text)["surface"]
    return found["volume"], found["euler"], found["components"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("file", nargs="+")
    parser.add_argument("--spacing", type=float, default=0.5)
    parser.add_argument("--setting", action="append")
    o = parser.parse_args()
    settings = [tuple(s.split()) for s in o.setting or ["0.3 1 1"]]
    ratio = {s: [] for s in settings}
    print("| structure | atoms | hydrogens | solvent-excluded, Å³ |" + "".join(f" {' '.join(s)}: volume, Euler, components |" for s in settings))
    print("|" + "---|" * (4 + len(settings)))
    for file in o.file:
        name = pathlib.Path(file).name.split(".")[0]
        with tempfile.TemporaryDirectory() as scratch:
            hier = f"{scratch}/s.hier"
            line, excluded = "", None
            for s in settings:
                tool(o.bin, "pdb2hier", "-r", f"* P_R={s[0]} P_C={s[1]}", file, "-o", hier)
                if excluded is None:
                    words = [w.split() for w in open(hier) if w.lstrip().startswith("atom ")]
                    atoms = np.array([[float(x) for x in w[3:7]] for w in words])
                    excluded = solvent_excluded_volume(atoms)
                    line = f"| {name} | {len(atoms):,} | {sum(w[2] == 'H' for w in words):,} | {excluded:,.0f} |"
                volume, euler, components = surface(o.bin, hier, o.spacing, s[2], scratch)
                ratio[s].append(volume / excluded)
                line += f" {volume:,.0f} ({100 * (volume / excluded - 1):+.1f} %), {euler}, {components} |"
            print(line, flush=True)
    for s, r in ratio.items():
        deviation = [100 * (x - 1) for x in r]
        print(f"{' '.join(s)}: median {statistics.median(deviation):+.2f} %, median of absolute values "
              f"{statistics.median(map(abs, deviation)):.2f} %, from {min(deviation):+.1f} to {max(deviation):+.1f} %")


main()
