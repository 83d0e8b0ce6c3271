#!/usr/bin/env python3
"""The default surface beside the solvent-excluded one: volumes and Euler numbers, from our own output.

    surface_volume.py BIN FILE... [--spacing H] [--setting 'P_R P_C DECAY [ISOVALUE]' | --setting default]...

BIN: folder of the tools. The solvent-excluded volume is that of what is farther than the probe's radius, 1.4 Å, from every place
where its centre can be; summed on grids of 0.35 and 0.25 Å and extrapolated to none, since its error is proportional to the
step (1CRN: 4,786, 4,748, 4,732, 4,709, 4,696 Å³ at 0.35, 0.25, 0.2, 0.14, 0.1 Å). Two kinds of radii: those of the .hier file, and, where
the file has no hydrogens, radii that make room for them (EDTSurf's). Needs numpy and scipy."""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np
from scipy import ndimage

PROBE = 1.4
STEPS = 0.35, 0.25
WITH_HYDROGENS = {"CA": 1.90, "C": 1.88, "CB": 1.96, "N": 1.63, "NE": 1.63, "O": 1.48, "S": 1.78, "P": 1.87}


def volume_on_grid(atoms, step):
    xyz, radius = atoms[:, :3], atoms[:, 3]
    low = xyz.min(0) - radius.max() - 2 * PROBE - 2 * step
    shape = np.ceil((xyz.max(0) + radius.max() + 2 * PROBE + 2 * step - low) / step).astype(int) + 1
    free = np.full(shape, 2.0, np.float32)  # distance beyond the surface on which the probe's centre may be, up to 2 Å
    axes = [low[a] + step * np.arange(shape[a]) for a in range(3)]
    for c, r in zip(xyz, radius):
        reach = r + PROBE + 2
        box = [slice(max(0, int((c[a] - reach - low[a]) / step)), int((c[a] + reach - low[a]) / step) + 2) for a in range(3)]
        d2 = sum(np.square(axes[a][box[a]] - c[a]).reshape([-1 if b == a else 1 for b in range(3)]) for a in range(3))
        part = free[box[0], box[1], box[2]]
        np.minimum(part, np.sqrt(d2) - (r + PROBE), out=part)
    distance, nearest = ndimage.distance_transform_edt(free < 0, sampling=step, return_indices=True)
    sure = int((distance > PROBE + step).sum())
    # Where it is close, the distance from the surface itself, seen from the grid points behind it.
    x = np.argwhere((distance > PROBE - 2 * step) & (distance <= PROBE + step) & (free < 0))
    y = np.stack([n[tuple(x.T)] for n in nearest], 1)
    d = np.full(len(x), np.inf)
    for offset in np.ndindex(5, 5, 5):
        at = np.clip(y + np.array(offset) - 2, 0, shape - 1)
        f = free[tuple(at.T)]
        d = np.where(f >= 0, np.minimum(d, step * np.sqrt(np.square(x - at).sum(1)) - f), d)
    return (sure + float(np.clip((d - PROBE) / step + 0.5, 0, 1).sum())) * step**3


def solvent_excluded_volume(atoms):
    coarse, fine = (volume_on_grid(atoms, step) for step in STEPS)
    return fine - (coarse - fine) * STEPS[1] / (STEPS[0] - STEPS[1])


def radius_with_hydrogens(name, element, radius):
    of_name = WITH_HYDROGENS.get(name) if name.startswith(element) else None  # not calcium for CA
    return of_name or WITH_HYDROGENS.get(element) or radius


def tool(folder, name, *arguments):
    subprocess.run([f"{folder}/{name}", "-q", "-t", "1", *arguments], check=True)


def surface(folder, hier, spacing, decay, isovalue, scratch):
    vdb, vtu = f"{scratch}/s.vdb", f"{scratch}/s.vtu"
    tool(folder, "hier2density", "--spacing", str(spacing), "--decay", decay, "--isovalue", isovalue, hier, "-o", vdb)
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
    settings = [tuple(s.split()) for s in o.setting or ["default"]]
    ratio = {s: ([], []) for s in settings}
    print("| structure | atoms | hydrogens | solvent-excluded, Å³ | with room for hydrogens |" + "".join(f" {' '.join(s)}: volume, Euler, components |" for s in settings))
    print("|" + "---|" * (5 + len(settings)))
    for file in o.file:
        name = pathlib.Path(file).name.split(".")[0]
        with tempfile.TemporaryDirectory() as scratch:
            hier = f"{scratch}/s.hier"
            line, excluded = "", None
            for s in settings:
                default = s == ("default",)
                tool(o.bin, "pdb2hier", *([] if default else ["-r", f"* P_R={s[0]} P_C={s[1]}"]), file, "-o", hier)
                if excluded is None:
                    words = [w.split() for w in open(hier) if w.lstrip().startswith("atom ")]
                    atoms = np.array([[float(x) for x in w[3:7]] for w in words])
                    hydrogens = sum(w[2] == "H" for w in words)
                    excluded = [solvent_excluded_volume(atoms)] * 2
                    if hydrogens == 0:
                        atoms[:, 3] = [radius_with_hydrogens(w[1], w[2], float(w[6])) for w in words]
                        excluded[1] = solvent_excluded_volume(atoms)
                    line = f"| {name} | {len(atoms):,} | {hydrogens:,} | {excluded[0]:,.0f} | {excluded[1]:,.0f} |"
                volume, euler, components = surface(o.bin, hier, o.spacing, "1" if default else s[2], s[3] if len(s) > 3 else "1", scratch)
                deviation = [100 * (volume / e - 1) for e in excluded]
                for kind in (0, 1):
                    ratio[s][kind].append(deviation[kind])
                line += f" {volume:,.0f} ({deviation[0]:+.1f} %, {deviation[1]:+.1f} %), {euler}, {components} |"
            print(line, flush=True)
    for s, kinds in ratio.items():
        for kind, radii in zip(kinds, ("the file's radii", "room for hydrogens")):
            print(f"{' '.join(s)}, {radii}: median {statistics.median(kind):+.2f} %, median of absolute values "
                  f"{statistics.median(map(abs, kind)):.2f} %, from {min(kind):+.1f} to {max(kind):+.1f} %")


if __name__ == "__main__":
    main()
