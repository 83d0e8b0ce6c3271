#!/usr/bin/env python3
"""resolution.py IMAGE.png LEVEL NAME MESH.vtu STRUCTURE.hier [MESH.vtu STRUCTURE.hier …]: molecular surfaces side by side.

The part of each surface whose nearest atom lies in group NAME of LEVEL (as `chain D`) is red, the rest is green.
Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/resolution.py …` without one).
"""
import sys
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

PANEL, HEIGHT = 440, 420


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


def surface(path):
    """The triangles with boundary = 1."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    only = vtk.vtkThreshold()
    only.SetInputConnection(reader.GetOutputPort())
    only.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "boundary")
    only.SetLowerThreshold(1)
    only.SetUpperThreshold(1)
    triangles = vtk.vtkDataSetSurfaceFilter()
    triangles.SetInputConnection(only.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(triangles.GetOutputPort())
    normals.SplittingOff()
    normals.Update()
    return normals.GetOutput()


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


def main():
    if len(sys.argv) < 6 or len(sys.argv) % 2 != 0:
        sys.exit(__doc__)
    image, level, name = sys.argv[1:4]
    panels = list(zip(sys.argv[4::2], sys.argv[5::2]))
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(PANEL * len(panels), HEIGHT)
    window.SetMultiSamples(8)
    camera = None
    for k, (path, hier) in enumerate(panels):
        mesh = surface(path)
        paint(mesh, *atoms(hier, level, name))
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(mesh)
        shown = vtk.vtkActor()
        shown.SetMapper(mapper)
        shown.GetProperty().SetSpecular(0.15)
        shown.GetProperty().SetAmbient(0.1)
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(k / len(panels), 0, (k + 1) / len(panels), 1)
        renderer.AddActor(shown)
        if camera is None:  # the same view for all
            renderer.ResetCamera()
            camera = renderer.GetActiveCamera()
            camera.Elevation(-65)
            camera.Roll(20)
            renderer.ResetCamera()
            camera.Zoom(1.45)
        renderer.SetActiveCamera(camera)
        renderer.ResetCameraClippingRange()
        window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(image)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


main()
