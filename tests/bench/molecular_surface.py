#!/usr/bin/env python3
"""The Gaussian body beside the molecular (solvent-excluded) surface: volume, area, tunnels, and the solvation energy by APBS.

    molecular_surface.py BIN FILE.pqr... [--spacing H] [--hier OPTIONS]... [--energy] [--apbs APBS]

BIN: folder of the tools. Each --hier is a set of options of pdb2hier, one row of results each (default: none, which are the defaults).
The molecular surface is where the distance from the accessible surface is the probe's radius, 1.4 Å: the distance is that from
points on the exposed spheres (0.12 Å apart) and circles (0.06 Å). Volume, area and Euler number of both bodies come from the same
marching tetrahedra on the same grid, so that their errors are alike; a surface of n components has n - Euler/2 tunnels. The field
of the Gaussian body is that of hier2density, by way of density2map.

--energy: linearised Poisson-Boltzmann by APBS, without salt, dielectric 2 and 78.54, on a grid of twice the spacing. Both bodies are given as dielectric maps,
the harmonic mean along each edge by where the field crosses it, so that their errors are alike. Hydrogens are those of the file, and so are
charges and radii; an atom of radius 0 has a charge alone. Needs numpy and scipy."""
import argparse
import gzip
import pathlib
import re
import shlex
import statistics
import subprocess
import tempfile

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

PROBE = 1.4
SOLUTE, SOLVENT = 2.0, 78.54
ROOM = 5.0  # Å round the fields' grid, which has 5 Å round the body


def read_pqr(file):
    """Coordinates, charges, radii."""
    rows = []
    with (gzip.open if file.endswith(".gz") else open)(file, "rt") as lines:
        for line in lines:
            if line.startswith(("ATOM", "HETATM")):
                words = line.split()
                if words[3] not in ("HOH", "WAT"):
                    rows.append([float(x) for x in words[-5:]])
    rows = np.array(rows)
    return rows[:, :3], rows[:, 3], rows[:, 4]


def sphere(n):
    i = np.arange(n) + 0.5
    polar, turn = np.arccos(1 - 2 * i / n), np.pi * (1 + 5**0.5) * i
    return np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], 1)


def accessible(points, centre, reach, others):
    for j in others:
        if not len(points):
            break
        points = points[np.square(points - centre[j]).sum(1) >= reach[j] ** 2 - 1e-9]
    return points


def accessible_surface(centre, radius, step=0.12):
    """Points on the surface on which the probe's centre may be, its creases among them."""
    reach, found = radius + PROBE, []
    near = cKDTree(centre).query_ball_point(centre, reach + reach.max())
    for i in range(len(centre)):
        others = np.array([j for j in near[i] if j != i], int)
        apart = np.linalg.norm(centre[others] - centre[i], axis=1)
        others, apart = others[apart < reach[i] + reach[others]], apart[apart < reach[i] + reach[others]]
        if ((apart + reach[i] <= reach[others]) & ((apart > 0) | (others < i))).any():
            continue  # within another sphere
        others, apart = others[np.argsort(apart)], np.sort(apart)
        found.append(accessible(centre[i] + reach[i] * sphere(int(4 * np.pi * reach[i] ** 2 / step**2)), centre, reach, others))
        for j, d in zip(others, apart):
            if j < i or d <= abs(reach[i] - reach[j]):
                continue
            along = (d * d + reach[i] ** 2 - reach[j] ** 2) / (2 * d)
            axis, wide = (centre[j] - centre[i]) / d, np.sqrt(max(reach[i] ** 2 - along**2, 0))
            e = np.cross(axis, np.eye(3)[np.argmin(abs(axis))])
            e /= np.linalg.norm(e)
            turn = np.linspace(0, 2 * np.pi, max(int(4 * np.pi * wide / step), 6), endpoint=False)[:, None]
            circle = centre[i] + along * axis + wide * (np.cos(turn) * e + np.sin(turn) * np.cross(axis, e))
            found.append(accessible(circle, centre, reach, others[others != j]))
    return np.concatenate(found)


def excluded_field(centre, radius, low, shape, h):
    """Distance from the molecular surface, positive inside, on a grid; cut off at 0.8 Å or more."""
    axes = [low[a] + h * np.arange(shape[a]) for a in range(3)]
    free = np.full(shape, 1.0)
    for c, r in zip(centre, radius + PROBE):
        box = [slice(max(0, int((c[a] - r - 1 - low[a]) / h)), max(0, int((c[a] + r + 1 - low[a]) / h) + 2)) for a in range(3)]
        d2 = sum(np.square(axes[a][box[a]] - c[a]).reshape([-1 if b == a else 1 for b in range(3)]) for a in range(3))
        part = free[tuple(box)]
        np.minimum(part, np.sqrt(d2) - r, out=part)
    field = -PROBE - np.maximum(free, 0)
    covered = np.argwhere(free < 0)
    distance, _ = cKDTree(accessible_surface(centre, radius)).query(low + h * covered, distance_upper_bound=PROBE + 0.8)
    field[tuple(covered.T)] = np.minimum(distance, PROBE + 0.8) - PROBE
    return field


NEIGHBORS = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1)]
JOINED = np.zeros((3, 3, 3), int)
for n in NEIGHBORS + [(0, 0, 0)]:
    JOINED[tuple(1 + x for x in n)] = JOINED[tuple(1 - x for x in n)] = 1
TETRAHEDRA = [[(0, 0, 0), tuple(a), tuple(b), (1, 1, 1)] for a in np.eye(3, dtype=int) for b in 1 - np.eye(3, dtype=int) if (a <= b).all()]


def measure(field, h):
    """Volume, area, components, tunnels of where the field is positive, by six tetrahedra a cell."""
    inside = field > 0
    near = np.zeros(np.array(field.shape) - 1, bool)  # cells that the surface crosses
    whole = np.ones_like(near)
    corner = lambda a, o: a[tuple(slice(x, n - 1 + x) for x, n in zip(o, a.shape))]
    for o in np.ndindex(2, 2, 2):
        near |= corner(inside, o)
        whole &= corner(inside, o)
    volume, area, triangles = float(whole.sum()), 0.0, 0
    cells = np.argwhere(near & ~whole)
    for t in TETRAHEDRA:
        value = np.stack([field[tuple((cells + o).T)] for o in t], 1)
        order = np.argsort(-value, 1)
        v, p = np.take_along_axis(value, order, 1), np.array(t, float)[order]
        count = (v > 0).sum(1)
        volume += (count == 4).sum() / 6
        for k in (1, 2, 3):
            u, x = v[count == k], p[count == k]
            cut = lambda a, b: x[:, a] + (u[:, a] / (u[:, a] - u[:, b]))[:, None] * (x[:, b] - x[:, a])
            tetra = lambda o, a, b, c: np.abs(np.einsum("ni,ni->n", a - o, np.cross(b - o, c - o))).sum() / 6
            side = lambda a, b, c: np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
            if k == 2:
                q = [cut(0, 2), cut(0, 3), cut(1, 3), cut(1, 2)]
                volume += tetra(x[:, 0], q[0], q[1], q[2]) + tetra(x[:, 0], q[0], q[2], q[3]) + tetra(x[:, 0], x[:, 1], q[2], q[3])
                area += side(q[0], q[1], q[2]) + side(q[0], q[2], q[3])
                triangles += 2 * len(u)
            else:
                tip, rest = (0, (1, 2, 3)) if k == 1 else (3, (0, 1, 2))
                q = [cut(tip, r) for r in rest]
                part = tetra(x[:, tip], *q)
                volume += part if k == 1 else len(u) / 6 - part
                area += side(*q)
                triangles += len(u)
    edges = 0
    for o in NEIGHBORS:
        a = inside[tuple(slice(0, n - x) for x, n in zip(o, inside.shape))]
        b = inside[tuple(slice(x, None) for x in o)]
        edges += int((a != b).sum())
    parts, outer = ndimage.label(inside, JOINED)[1], ndimage.label(~inside, JOINED)[1]
    return {"volume": volume * h**3, "area": area * h**2, "parts": parts, "cavities": outer - 1,
            "tunnels": parts + outer - 1 - (edges - triangles // 2) // 2}


def run(*command, **more):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True, **more).stdout


def gaussian_field(o, options, file, scratch):
    """ln G on a grid, positive inside, with the place of its first point."""
    hier, vdb, dx = f"{scratch}/s.hier", f"{scratch}/s.vdb", f"{scratch}/s.dx"
    run(f"{o.bin}/pdb2hier", "-q", *shlex.split(options), file, "-o", hier)
    run(f"{o.bin}/hier2density", "-q", "-t", 1, "--spacing", o.spacing, "--margin", 5, hier, "-o", vdb)
    run(f"{o.bin}/density2map", "-q", vdb, "-o", dx)
    with open(dx) as lines:
        for line in lines:
            w = line.split()
            if w[:1] == ["origin"]:
                low = np.array(w[1:4], float)
            if "gridpositions" in w:
                shape = [int(x) for x in w[-3:]]
            if "data" in w:
                break
        text = re.split(r"attribute|object|component", lines.read())[0]
    return np.log(np.maximum(np.fromstring(text, sep=" ", count=int(np.prod(shape))).reshape(shape), 1e-6)), low


def write_dx(file, low, h, values):
    with open(file, "w") as f:
        n = values.shape
        f.write(f"object 1 class gridpositions counts {n[0]} {n[1]} {n[2]}\norigin {low[0]} {low[1]} {low[2]}\n")
        f.write(f"delta {h} 0 0\ndelta 0 {h} 0\ndelta 0 0 {h}\nobject 2 class gridconnections counts {n[0]} {n[1]} {n[2]}\n")
        f.write(f"object 3 class array type double rank 0 items {values.size} data follows\n")
        different, which = np.unique(values.ravel(), return_inverse=True)  # nearly all are of one medium or the other
        f.write("".join(np.array([f"{x:g}\n" for x in different], object)[which].tolist()))


def inside(u, v):
    """The part of an edge that is inside, from the field at its ends."""
    positive, sum = np.maximum(u, 0) + np.maximum(v, 0), np.abs(u) + np.abs(v)
    return np.where((u > 0) == (v > 0), u > 0, positive / np.maximum(sum, 1e-12))


def total_energy(o, pqr, low, fine, scratch, field=None):
    """kJ/mol, with that of the charges' spreading on the grid; without a field in the solute's dielectric alone. Points of the grid are every second one
    of the field's."""
    xyz, charge, radius = pqr
    h = 2 * o.spacing
    need = (np.array(fine) / 2 + 2 * ROOM / h).max()
    dime = next(n for n in (65, 97, 129, 161, 193, 225, 257, 289, 321) if n >= need)
    shift = ((dime - np.array(fine) // 2) // 2).astype(int)
    first = low - shift * h
    with open(f"{scratch}/a.pqr", "w") as f:
        for x, q, r in zip(xyz, charge, radius):
            f.write("ATOM 1 X XXX 1 %.4f %.4f %.4f %.5f %.4f\n" % (*x, q, r))
    maps = ""
    if field is not None:
        padded = np.full(3 * [2 * dime + 1], -1.0)
        padded[tuple(slice(2 * s, 2 * s + n) for s, n in zip(shift, field.shape))] = field
        for axis, name in enumerate("xyz"):
            start, middle, end = (padded[tuple(slice(k if a == axis else 0, k + 2 * dime - 1 if a == axis else 2 * dime, 2) for a in range(3))] for k in range(3))
            part = (inside(start, middle) + inside(middle, end)) / 2
            write_dx(f"{scratch}/{name}.dx", first + np.eye(3)[axis] * h / 2, h, 1 / (part / SOLUTE + (1 - part) / SOLVENT))
        maps = f"diel dx {scratch}/x.dx {scratch}/y.dx {scratch}/z.dx\n"
    centre = first + (dime - 1) * h / 2
    with open(f"{scratch}/a.in", "w") as f:
        f.write(f"read\nmol pqr {scratch}/a.pqr\n{maps}end\nelec name one\nmg-manual\ndime {dime} {dime} {dime}\ngrid {h} {h} {h}\n"
                f"gcent {centre[0]} {centre[1]} {centre[2]}\nmol 1\nlpbe\nbcfl mdh\npdie {SOLUTE}\nsdie {SOLVENT if maps else SOLUTE}\nsrfm mol\n"
                f"chgm spl2\nsdens 20\nsrad {PROBE}\nswin 0.3\ntemp 298.15\ncalcenergy total\ncalcforce no\n{'usemap diel 1' if maps else ''}\nend\n"
                "print elecEnergy one end\nquit\n")
    return float(re.search(r"Global net ELEC energy = (\S+)", run(o.apbs, f"{scratch}/a.in", cwd=scratch)).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument("file", nargs="+")
    parser.add_argument("--spacing", type=float, default=0.5)
    parser.add_argument("--hier", action="append")
    parser.add_argument("--energy", action="store_true")
    parser.add_argument("--apbs", default="apbs")
    o = parser.parse_args()
    settings = o.hier or [""]
    off, holes, holes_there = {s: [] for s in settings}, {s: [] for s in settings}, []
    what = ["volume", "area"] + ["energy"] * o.energy
    print("| structure | atoms | molecular surface: " + ", ".join(what) + "; tunnels, cavities |" + "".join(f" {s or 'default'} |" for s in settings))
    print("|" + "---|" * (3 + len(settings)))
    for file in o.file:
        xyz, charge, radius = pqr = read_pqr(file)
        body = radius > 0
        reference, row = None, ""
        for s in settings:
            with tempfile.TemporaryDirectory() as scratch:
                field, low = gaussian_field(o, s, file, scratch)
                if reference is None:
                    excluded = excluded_field(xyz[body], radius[body], low, field.shape, o.spacing)
                    reference = measure(excluded, o.spacing)
                    if o.energy:
                        vacuum = total_energy(o, pqr, low, field.shape, scratch)
                        reference["energy"] = total_energy(o, pqr, low, field.shape, scratch, excluded) - vacuum
                found = measure(field, o.spacing)
                if o.energy:
                    found["energy"] = total_energy(o, pqr, low, field.shape, scratch, field) - vacuum
            off[s].append([100 * (found[w] / reference[w] - 1) for w in what])
            holes[s].append((found["tunnels"], found["cavities"]))
            row += " " + ", ".join(f"{x:+.1f}" for x in off[s][-1]) + f" %; {found['tunnels']}, {found['cavities']} |"
        holes_there.append((reference["tunnels"], reference["cavities"]))
        name = pathlib.Path(file).name.removesuffix(".gz").removesuffix(".pqr")
        print(f"| {name} | {len(xyz):,} | " + ", ".join(f"{reference[w]:,.0f}" for w in what) + f"; {reference['tunnels']}, {reference['cavities']} |{row}", flush=True)
    for s in settings:
        for w, column in zip(what, zip(*off[s])):
            print(f"{s or 'default'}, {w}: median {statistics.median(column):+.2f} %, from {min(column):+.1f} to {max(column):+.1f} %")
        ours, theirs = (tuple(map(sum, zip(*h))) for h in (holes[s], holes_there))
        print(f"{s or 'default'}: {ours[0]} tunnels, {ours[1]} cavities; the molecular surfaces have {theirs[0]} and {theirs[1]}")


if __name__ == "__main__":
    main()
