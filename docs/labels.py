#!/usr/bin/env python3
"""labels.py LABELLED.vtu IMAGE.png: the molecular surface by chain, by residue, and with a named boundary.

Left: each chain a colour, paler where its share of the density is small. Middle: each residue a shade of its chain's colour. Right: patch 8
red. Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/labels.py …` without one).
"""
import sys
import numpy as np
import panels
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

CHAINS = np.array([(70, 120, 180), (230, 150, 60), (90, 160, 90), (200, 90, 90), (150, 120, 190), (140, 100, 80), (110, 190, 200)], float)


def array(mesh, name):
    return vtk_to_numpy(mesh.GetCellData().GetArray(name))


def colours(mesh):
    """Of the three panels, one a triangle."""
    chain = CHAINS[array(mesh, "chain") % len(CHAINS)]
    share = array(mesh, "chain_share")[:, None]
    shade = np.random.default_rng(7).uniform(0.55, 1.35, array(mesh, "residue").max() + 1)
    named = array(mesh, "patch") == 8
    return (chain * share + 255 * (1 - share), chain * shade[array(mesh, "residue")][:, None],
            np.where(named[:, None], (205, 60, 50), (185, 190, 195)))


def main(path, image):
    mesh = panels.surface(path)
    parts = []
    for colour in colours(mesh):
        part = vtk.vtkPolyData()
        part.DeepCopy(mesh)
        values = numpy_to_vtk(np.clip(colour, 0, 255).astype(np.uint8), deep=True)
        values.SetName("colour")
        part.GetCellData().SetScalars(values)
        parts.append(part)
    panels.draw(parts, image, ambient=0.15)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
