#!/usr/bin/env python3
"""How far interfaces between domains are from where shares are equal, by brute force over all atoms.

    interface_distances.py MESH.vtu FILE.hier [SPACING]

For points and centroids of the triangles of boundaries 8 and more: |ln of the quotient of the two shares| over the length of its gradient
(central differences), Å, also in spacings. The outermost level must be the one that --regions named. Needs numpy and meshio."""
import sys

import meshio
import numpy as np


def read_hier(path):
    """Atoms; a tree (exponent, children), whose leaves are ranges of atoms."""
    levels, atoms, root = [], [], []
    open_groups = [root]
    for line in open(path):
        word = line.split()
        if word[0] == "levels":
            levels = word[1:]
        elif word[0] == "atom":
            atoms.append([float(x) for x in word[3:7]])
            open_groups[-1].append(len(atoms) - 1)
        elif word[0] in levels:
            depth = levels.index(word[0])
            del open_groups[depth + 1:]
            children = []
            open_groups[-1].append((float(word[2]), children))
            open_groups.append(children)
    return np.array(atoms), root


def ln_sum(children, terms):
    rows = [terms[c] if isinstance(c, int) else c[0] * ln_sum(c[1], terms) for c in children]
    return np.logaddexp.reduce(rows, axis=0)


def ln_domains(p, atoms, root, decay):
    out = []
    for start in range(0, len(p), 200):
        q = p[start:start + 200]
        terms = decay * (atoms[:, 3:4] ** 2 - ((q[None] - atoms[:, None, :3]) ** 2).sum(2))
        out.append(np.array([c[0] * ln_sum(c[1], terms) for c in root]))
    return np.concatenate(out, axis=1)


def main():
    mesh = meshio.read(sys.argv[1])
    atoms, root = read_hier(sys.argv[2])
    spacing = float(sys.argv[3]) if len(sys.argv) > 3 else 1
    text = bytes(mesh.field_data["region_names"]).decode().split("\n")
    name = {line.split(" ", 1)[1]: int(line.split(" ", 1)[0]) - 4 for line in text if line}
    label = dict(line.split(" ", 1) for line in bytes(mesh.field_data["boundary_names"]).decode().split("\n") if line)
    decay = float(mesh.field_data["decay"][0])
    triangles = np.concatenate([c.data for c in mesh.cells if c.type == "triangle"])
    boundary = np.concatenate([d for c, d in zip(mesh.cells, mesh.cell_data["boundary"]) if c.type == "triangle"])
    for b in np.unique(boundary[boundary > 7]):
        pair = [name[n] for n in name if label[str(b)] in (n + "-" + o for o in name) or label[str(b)] in (o + "-" + n for o in name)]
        here = triangles[boundary == b]
        for what, p in (("points", mesh.points[np.unique(here)]), ("centroids", mesh.points[here].mean(1))):
            p = p[:: max(1, len(p) // 2000)]

            def f(q):
                ln = ln_domains(q, atoms, root, decay)
                return ln[pair[0]] - ln[pair[1]]

            step = 1e-4
            gradient = np.array([(f(p + step * e) - f(p - step * e)) / (2 * step) for e in np.eye(3)])
            d = np.abs(f(p)) / np.linalg.norm(gradient, axis=0)
            print(f"{label[str(b)]} {what} {len(p)}: mean {d.mean() / spacing:.4f} h, 99 % {np.quantile(d, .99) / spacing:.4f} h, "
                  f"most {d.max() / spacing:.4f} h ({d.max():.4f} Å)")


if __name__ == "__main__":
    main()
