#!/usr/bin/env python3
"""resolution.py IMAGE.png LEVEL NAME MESH.vtu STRUCTURE.hier [MESH.vtu STRUCTURE.hier …]: molecular surfaces side by side.

The part of each surface whose nearest atom lies in group NAME of LEVEL (as `chain D`) is red, the rest is green.
Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/resolution.py …` without one).
"""
import sys
import numpy as np
import panels
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def atoms(path, level, name):
    """Positions, and whether each atom lies in the group."""
    positions, inside, within = [], [], False
    for line in open(path, encoding="utf-8"):
        field = line.split()
        if field and field[0] == level:
            within = field[1] == name
        if field and field[0] == "atom":
            positions.append([float(x) for x in field[3:6]])
            inside.append(within)
    return np.array(positions), np.array(inside)


def paint(mesh, positions, inside):
    cloud = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(positions, deep=True))
    cloud.SetPoints(points)
    locator = vtk.vtkStaticPointLocator()
    locator.SetDataSet(cloud)
    locator.BuildLocator()
    places = vtk_to_numpy(mesh.GetPoints().GetData())
    red = inside[[locator.FindClosestPoint(p) for p in places]]
    colours = np.where(red[:, None], (205, 60, 50), (130, 175, 140)).astype(np.uint8)
    array = numpy_to_vtk(colours, deep=True)
    array.SetName("colour")
    mesh.GetPointData().SetScalars(array)
    return mesh


def main():
    if len(sys.argv) < 6 or len(sys.argv) % 2 != 0:
        sys.exit(__doc__)
    image, level, name = sys.argv[1:4]
    meshes = [paint(panels.surface(path), *atoms(hier, level, name)) for path, hier in zip(sys.argv[4::2], sys.argv[5::2])]
    panels.draw(meshes, image, ambient=0.1)


main()
