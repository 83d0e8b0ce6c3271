#!/usr/bin/env python3
"""labels.py LABELLED.vtu IMAGE.png: the molecular surface by chain, by residue, and with a named boundary.

Left: each chain a colour, paler where its share of the density is small. Middle: each residue a shade of its chain's colour. Right: patch 8
red. Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/labels.py …` without one).
"""
import sys
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

PANEL, HEIGHT = 440, 420
CHAINS = np.array([(70, 120, 180), (230, 150, 60), (90, 160, 90), (200, 90, 90), (150, 120, 190), (140, 100, 80), (110, 190, 200)], float)


def surface(path):
    """The triangles with boundary = 1 and their arrays."""
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
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(3 * PANEL, HEIGHT)
    window.SetMultiSamples(8)
    camera = None
    mesh = surface(path)
    for k, colour in enumerate(colours(mesh)):
        part = vtk.vtkPolyData()
        part.DeepCopy(mesh)
        values = numpy_to_vtk(np.clip(colour, 0, 255).astype(np.uint8), deep=True)
        values.SetName("colour")
        part.GetCellData().SetScalars(values)
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(part)
        shown = vtk.vtkActor()
        shown.SetMapper(mapper)
        shown.GetProperty().SetSpecular(0.15)
        shown.GetProperty().SetAmbient(0.15)
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(k / 3, 0, (k + 1) / 3, 1)
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


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
