#!/usr/bin/env python3
"""How far the surface of a mesh is from the isosurface of another, finer grid: what a coarse grid costs.

    surface_between.py MESH.vtu FINE.mrc [ISOVALUE]

FINE.mrc: density2map of the finer density; its isosurface is that of ln G, by marching cubes. Of 20,000 triangles of the molecular surface, spread
evenly over the list: the distance of the centroid from the nearest place of it, Å. Needs numpy and VTK's Python module."""
import pathlib
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs"))
from panels import Mesh


def isosurface(path, isovalue):
    header = np.fromfile(path, "<i4", 256)
    nx, ny, nz = (int(n) for n in header[:3])
    numbers = header.view("<f4")
    spacing, origin = float(numbers[10]) / header[7], numbers[49:52].astype(float)
    if not origin.any():
        origin = header[4:7] * spacing
    values = np.array(np.memmap(path, "<f4", "r", 1024 + int(header[23]), nx * ny * nz))
    np.log(np.maximum(values, 1e-3, out=values), out=values)
    image = vtk.vtkImageData()
    image.SetDimensions(nx, ny, nz)
    image.SetSpacing(spacing, spacing, spacing)
    image.SetOrigin(*origin)
    image.GetPointData().SetScalars(numpy_to_vtk(values))
    contour = vtk.vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, np.log(isovalue))
    contour.ComputeNormalsOff()
    contour.Update()
    return contour.GetOutput()


mesh = Mesh(sys.argv[1])
surface = isosurface(sys.argv[2], float(sys.argv[3]) if len(sys.argv) > 3 else 1)
triangles = mesh.triangles[mesh.molecule()]
triangles = triangles[:: max(1, len(triangles) // 20000)]
locator = vtk.vtkStaticCellLocator()
locator.SetDataSet(surface)
locator.BuildLocator()
foot, cell, part, squared = [0.0] * 3, vtk.reference(0), vtk.reference(0), vtk.reference(0.0)
distance = []
for centroid in mesh.points[triangles].mean(axis=1):
    locator.FindClosestPoint(centroid, foot, cell, part, squared)
    distance.append(float(squared) ** 0.5)
distance = np.sort(distance)
print(f"{sys.argv[1]}: {len(distance):,} triangles, mean {distance.mean():.3f} Å, median {distance[len(distance) // 2]:.3f} Å, "
      f"95 % within {distance[int(0.95 * len(distance))]:.3f} Å, largest {distance[-1]:.2f} Å")
