"""panels.py: molecular surfaces side by side, for the scripts beside it that draw them.

Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a` without one).
"""
import vtk

PANEL, HEIGHT = 440, 420


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


def draw(meshes, image, ambient):
    """Surfaces that carry their colours as scalars, from left to right, seen alike, into a PNG."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(PANEL * len(meshes), HEIGHT)
    window.SetMultiSamples(8)
    camera = None
    for k, mesh in enumerate(meshes):
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(mesh)
        shown = vtk.vtkActor()
        shown.SetMapper(mapper)
        shown.GetProperty().SetSpecular(0.15)
        shown.GetProperty().SetAmbient(ambient)
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(k / len(meshes), 0, (k + 1) / len(meshes), 1)
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
