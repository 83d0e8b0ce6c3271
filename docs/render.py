#!/usr/bin/env python3
"""render.py MESH.vtu IMAGE.png: a mesh cut open, whole tetrahedra beside the cut, coloured by worst dihedral angle.

Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/render.py …` without one).
The front half of the surroundings is taken away, and of the molecule the quarter in front on the right: its tetrahedra show
their smallest dihedral angle, those outside are grey, closed cavities purple. `pngquant --nofs 200` on the image leaves a
third of its bytes.
"""
import sys
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

WIDTH, HEIGHT = 1200, 900


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def smallest_dihedral(points, tets):
    """Degrees, one a tetrahedron."""
    p = points[tets]
    normals = []
    for i in range(4):
        a, b, c = (p[:, j] for j in range(4) if j != i)
        n = np.cross(b - a, c - a)
        n *= np.sign(np.einsum("ij,ij->i", n, a - p[:, i]))[:, None]  # outwards
        normals.append(n / np.linalg.norm(n, axis=1)[:, None])
    pairs = [(i, j) for i in range(4) for j in range(i)]
    cosines = [-np.einsum("ij,ij->i", normals[i], normals[j]) for i, j in pairs]
    return np.degrees(np.arccos(np.clip(cosines, -1, 1))).min(axis=0)


def part(points, cells, keep, scalars):
    """The cells of `keep` with their scalars, as a grid of tetrahedra."""
    cells = cells[keep]
    array = vtk.vtkCellArray()
    ids = np.hstack([np.full((len(cells), 1), 4), cells]).astype(np.int64).ravel()
    array.SetCells(len(cells), numpy_to_vtk(ids, deep=True, array_type=vtk.VTK_ID_TYPE))
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    grid.SetCells(vtk.VTK_TETRA, array)
    values = numpy_to_vtk(scalars[keep], deep=True)
    values.SetName("angle")
    grid.GetCellData().SetScalars(values)
    return grid


def actor(grid, table=None, colour=None, edges=0.35):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    shown = vtk.vtkActor()
    shown.SetMapper(mapper)
    look = shown.GetProperty()
    if table:
        mapper.SetLookupTable(table)
        mapper.SetScalarRange(table.GetRange())
    else:
        mapper.ScalarVisibilityOff()
        look.SetColor(*colour)
    look.SetInterpolationToFlat()
    look.SetAmbient(0.25)
    look.SetDiffuse(0.8)
    look.EdgeVisibilityOn()
    look.SetEdgeColor(*[0.15] * 3)
    look.SetLineWidth(edges)
    return shown


def colours(low, high):
    steps = vtk.vtkColorTransferFunction()
    steps.SetColorSpaceToLab()
    for x, rgb in ((0, (0.75, 0.15, 0.1)), (0.25, (0.95, 0.6, 0.25)), (0.5, (0.95, 0.92, 0.6)), (1, (0.2, 0.5, 0.6))):
        steps.AddRGBPoint(low + x * (high - low), *rgb)
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(128)
    table.SetRange(low, high)
    for i in range(128):
        table.SetTableValue(i, *steps.GetColor(low + (high - low) * i / 127), 1)
    return table


def main(mesh, image):
    grid = read(mesh)
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    types = vtk_to_numpy(grid.GetCellTypesArray())
    count = int((types == vtk.VTK_TETRA).sum())
    tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray())[: 4 * count].reshape(-1, 4)
    region = vtk_to_numpy(grid.GetCellData().GetArray("region"))[:count]
    centre = points[np.unique(tets[region == 1])].mean(axis=0)
    size = np.ptp(points[np.unique(tets[region == 1])], axis=0).max()
    towards = np.array([0.0, -1.0, 0.0])  # the camera looks along +y
    depth = (points[tets].mean(axis=1) - centre) @ towards
    angle = smallest_dihedral(points, tets)
    table = colours(10, 60)

    scene = vtk.vtkRenderer()
    scene.SetBackground(1, 1, 1)
    aside = (points[tets].mean(axis=1) - centre) @ np.array([1.0, 0.0, 0.0])
    behind, open_quarter = depth < 0, (depth > 0) & (aside > 0)
    offset = np.abs(points[tets].mean(axis=1) - centre)
    near = (offset[:, 0] < size) & (offset[:, 2] < 0.8 * size) & (depth > -0.1 * size)
    scene.AddActor(actor(part(points, tets, ~open_quarter & (region == 1), angle), table=table))
    for label, colour, keep in ((2, (0.86, 0.88, 0.9), behind & near), (3, (0.55, 0.3, 0.65), ~open_quarter)):
        if (keep & (region == label)).any():
            scene.AddActor(actor(part(points, tets, keep & (region == label), angle), colour=colour))

    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle(" ")
    bar.SetNumberOfLabels(6)
    bar.SetLabelFormat("%.0f°")
    bar.SetOrientationToHorizontal()
    bar.SetPosition(0.03, 0.02)
    bar.SetPosition2(0.36, 0.09)
    bar.DrawBackgroundOn()
    bar.GetBackgroundProperty().SetColor(1, 1, 1)
    bar.UnconstrainedFontSizeOn()
    title = vtk.vtkTextActor()
    title.SetInput("smallest dihedral angle of a tetrahedron")
    title.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    title.SetPosition(0.045, 0.085)
    for text in (title.GetTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontSize(17)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    scene.AddActor2D(bar)
    scene.AddActor2D(title)

    camera = scene.GetActiveCamera()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + size * (2.5 * towards + np.array([0.8, 0, 0.6]))))
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(22.5)
    scene.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH, HEIGHT)
    window.AddRenderer(scene)
    window.Render()
    picture = vtk.vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(image)
    writer.SetInputConnection(picture.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
