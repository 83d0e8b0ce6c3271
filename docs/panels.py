"""panels.py: meshes in panels beside each other, with letters, legends, scale bars and colour bars, for the scripts beside it.

Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a` without one). Projections are parallel, so that a
scale bar holds for the whole panel.
"""
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

INK = (0.1, 0.1, 0.1)
GREY = (186, 192, 198)
WORDS = 26  # pixels


# --- meshes


class Mesh:
    """points; tets and triangles, four and three indices each; arrays of both by name; names of the groups of a level."""

    def __init__(self, path):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        grid = self.grid = reader.GetOutput()
        self.points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
        corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        count = self.count = int((vtk_to_numpy(grid.GetCellTypesArray()) == vtk.VTK_TETRA).sum())
        self.tets = corners[: 4 * count].reshape(-1, 4).astype(np.int64)
        self.triangles = corners[4 * count :].reshape(-1, 3).astype(np.int64)
        self.middles = self.points[self.tets].mean(axis=1)

    def of_tets(self, name):
        return vtk_to_numpy(self.grid.GetCellData().GetArray(name))[: self.count]

    def of_triangles(self, name):
        return vtk_to_numpy(self.grid.GetCellData().GetArray(name))[self.count :]

    def names(self, level):
        """As tetlabel wrote them; a copy's name is that of the piece and a number."""
        return bytes(vtk_to_numpy(self.grid.GetFieldData().GetArray(level + "_names"))).decode().split("\n")

    def keys(self, faces):
        """One number for each set of three points."""
        a, b, c = np.sort(faces, axis=1).T
        return (a * len(self.points) + b) * len(self.points) + c

    def molecule(self):
        """Which triangles are of the molecular surface."""
        return self.of_triangles("boundary") == 1


def polygons(points, triangles, colours=None):
    """Triangles as VTK draws them, with colours (0 to 255) of triangles or of points."""
    used, index = np.unique(triangles, return_inverse=True)
    shape = vtk.vtkPolyData()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points[used], deep=True))
    shape.SetPoints(places)
    list_of = vtk.vtkCellArray()
    ids = np.hstack([np.full((len(triangles), 1), 3), index.reshape(-1, 3)]).astype(np.int64).ravel()
    list_of.SetCells(len(triangles), numpy_to_vtk(ids, deep=True, array_type=vtk.VTK_ID_TYPE))
    shape.SetPolys(list_of)
    if colours is not None:
        of_points = len(colours) != len(triangles)
        values = numpy_to_vtk(np.clip(colours[used] if of_points else colours, 0, 255).astype(np.uint8), deep=True)
        values.SetName("colour")
        (shape.GetPointData() if of_points else shape.GetCellData()).SetScalars(values)
    return shape


def surface(mesh, colours=None, keep=None):
    """The molecular surface, smoothly shaded; `colours` and `keep` one a triangle of the mesh, or colours one a point."""
    keep = mesh.molecule() if keep is None else keep
    if colours is not None and len(colours) == len(mesh.triangles):
        colours = colours[keep]
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(polygons(mesh.points, mesh.triangles[keep], colours))
    normals.SplittingOff()
    normals.Update()
    return normals.GetOutput()


def opened(mesh, keep, of_tets, of_triangles=None):
    """What is seen of the tetrahedra `keep`: each face in the colour of its tetrahedron, or, where it is of the molecular
    surface and these are given, in the colour of its triangle."""
    tets = mesh.tets[keep]
    faces = np.concatenate([tets[:, [1, 2, 3]], tets[:, [0, 3, 2]], tets[:, [0, 1, 3]], tets[:, [0, 2, 1]]])
    owner = np.tile(np.arange(len(tets)), 4)
    keys = mesh.keys(faces)
    _, first, times = np.unique(keys, return_index=True, return_counts=True)
    once = first[times == 1]
    faces, colours = faces[once], np.asarray(of_tets, float)[keep][owner[once]]
    if of_triangles is not None:
        shown = mesh.molecule()
        known, at = np.unique(mesh.keys(mesh.triangles[shown]), return_index=True)
        place = np.minimum(np.searchsorted(known, keys[once]), len(known) - 1)
        hit = known[place] == keys[once]
        colours[hit] = np.asarray(of_triangles, float)[shown][at][place[hit]]
    return polygons(mesh.points, faces, colours)


def palette(count):
    """Distinct colours."""
    base = [(86, 140, 190), (232, 152, 74), (104, 168, 104), (204, 96, 92), (154, 124, 190), (150, 112, 92), (116, 190, 200),
            (214, 134, 178), (172, 172, 84), (124, 132, 148), (70, 150, 140), (230, 190, 110)]
    return np.array([base[i % len(base)] for i in range(count)], float)


# --- what a panel shows


def actors(shape, edges=0, ambient=0.12):
    """A surface in its own colours, and the edges of its triangles where `edges` > 0: how dark they are, up to 1."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(shape)
    faces = vtk.vtkActor()
    faces.SetMapper(mapper)
    look_of = faces.GetProperty()
    look_of.SetAmbient(ambient)
    look_of.SetDiffuse(0.88)
    if not edges:
        look_of.SetSpecular(0.12)
        look_of.SetSpecularPower(12)
        return [faces]
    look_of.SetInterpolationToFlat()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(1, 1)
    wires = vtk.vtkPolyDataMapper()
    wires.SetInputData(shape)
    wires.ScalarVisibilityOff()
    lines = vtk.vtkActor()
    lines.SetMapper(wires)
    lines.GetProperty().SetRepresentationToWireframe()
    lines.GetProperty().SetColor(0.1, 0.1, 0.14)
    lines.GetProperty().SetLighting(False)
    lines.GetProperty().SetOpacity(edges)
    return [faces, lines]


class Panel:
    """What one panel shows, a list of actors. view: azimuth and elevation of the viewer in degrees, as tetreport has them; roll: of
    the picture. like: another panel, whose camera this one shares. legend: words and their colours."""

    def __init__(self, shown, caption="", view=(-60, 25), roll=0, like=None, legend=()):
        self.shown, self.caption, self.view, self.roll, self.like, self.legend = shown, caption, view, roll, like, legend


def look(renderer, panel, below):
    """The camera of a panel: parallel, from azimuth and elevation; `below`: pixels that the mesh leaves free there."""
    azimuth, elevation = np.radians(panel.view)
    away = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*away)
    camera.SetViewUp(*((0, 1, 0) if abs(elevation) > 1.55 else (0, 0, 1)))
    camera.Roll(panel.roll)
    renderer.ResetCamera()
    # The frame fits what is seen, not its bounds.
    shapes = [shown.GetMapper().GetInput() for shown in panel.shown]
    places = np.vstack([vtk_to_numpy(shape.GetPoints().GetData())[::7] if shape.IsA("vtkPolyData") else
                        np.reshape(shape.GetBounds(), (3, 2)).T for shape in shapes])
    to_view = camera.GetViewTransformMatrix()
    axes = np.array([[to_view.GetElement(i, j) for j in range(3)] for i in range(2)])
    low, high = (places @ axes.T).min(axis=0), (places @ axes.T).max(axis=0)
    width, height = renderer.GetSize()
    scale = max((high - low)[1] / (height - WORDS - below), (high - low)[0] / (0.94 * width))  # Å a pixel
    camera.SetParallelScale(scale * height / 2)
    middle = (low + high) / 2 + np.array([0, scale * (WORDS - below) / 2])
    shift = (middle - axes @ camera.GetFocalPoint()) @ axes
    camera.SetFocalPoint(*(camera.GetFocalPoint() + shift))
    camera.SetPosition(*(camera.GetPosition() + shift))


def text(words, place, size, centred=False, bold=False):
    shown = vtk.vtkTextActor()
    shown.SetInput(words)
    shown.GetPositionCoordinate().SetCoordinateSystemToViewport()
    shown.SetPosition(*place)
    look_of = shown.GetTextProperty()
    look_of.SetFontSize(size)
    look_of.SetColor(*INK)
    look_of.SetBold(bold)
    if centred:
        look_of.SetJustificationToCentered()
    return shown


def rectangle(x, y, width, height, colour):
    """In pixels of the panel."""
    points = vtk.vtkPoints()
    for corner in ((x, y), (x + width, y), (x + width, y + height), (x, y + height)):
        points.InsertNextPoint(*corner, 0)
    quad = vtk.vtkCellArray()
    quad.InsertNextCell(4, (0, 1, 2, 3))
    shape = vtk.vtkPolyData()
    shape.SetPoints(points)
    shape.SetPolys(quad)
    mapper = vtk.vtkPolyDataMapper2D()
    mapper.SetInputData(shape)
    shown = vtk.vtkActor2D()
    shown.SetMapper(mapper)
    shown.GetProperty().SetColor(*colour)
    return shown


def scale_bar(renderer):
    """At the lower right: a round length, a tenth to a quarter of the panel."""
    width, height = renderer.GetSize()
    pixels = height / (2 * renderer.GetActiveCamera().GetParallelScale())
    length = max(f * 10.0**e for e in range(-1, 5) for f in (1, 2, 5) if f * 10.0**e <= width / pixels / 4)
    across = length * pixels
    renderer.AddActor2D(rectangle(width - 12 - across, 10, across, 3, INK))
    renderer.AddActor2D(text(f"{length:g} Å", (width - 12 - across / 2, 17), 13, centred=True))


def colour_bar(renderer, words, low, high, shade, unit="°", ticks=range(0, 181, 20)):
    """At the lower left; `shade`: from values to colours; `ticks`: those besides the ends that have room."""
    width, steps = 200, 100
    for i in range(steps):
        colour = shade(np.array([low + (high - low) * (i + 0.5) / steps]))[0] / 255
        renderer.AddActor2D(rectangle(16 + i * width / steps, 24, width / steps + 1, 10, colour))
    for value in [low, *(v for v in ticks if low + (high - low) / 14 < v < high), high]:
        renderer.AddActor2D(text(f"{value:g}{unit}", (16 + (value - low) / (high - low) * width, 8), 12, centred=True))
    renderer.AddActor2D(text(words, (12, 39), 13))


def draw(panels, image, columns=None, size=(440, 420), bar=None):
    """Panels row by row, into a PNG. bar: the colour bar of the first one, what colour_bar takes."""
    columns = columns or len(panels)
    rows = -(-len(panels) // columns)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(size[0] * columns, size[1] * rows)
    window.SetMultiSamples(8)
    drawn = {}
    for k, panel in enumerate(panels):
        row, column = divmod(k, columns)
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(column / columns, 1 - (row + 1) / rows, (column + 1) / columns, 1 - row / rows)
        window.AddRenderer(renderer)
        for shown in panel.shown:
            renderer.AddViewProp(shown)
        if panel.like is None:
            look(renderer, panel, 2 * WORDS if bar else WORDS)
        else:
            renderer.SetActiveCamera(drawn[id(panel.like)].GetActiveCamera())
        drawn[id(panel)] = renderer
        renderer.ResetCameraClippingRange()
        lettered = len(panels) > 1
        if lettered:
            renderer.AddActor2D(text(f"({chr(97 + k)})", (8, size[1] - 22), 17, bold=True))
        for i, line in enumerate(panel.caption.split("\\n")):
            renderer.AddActor2D(text(line, (40 if lettered else 8, size[1] - 21 - 18 * i), 14))
        scale_bar(renderer)
        if bar and k == 0:
            colour_bar(renderer, *bar)
        for i, (words, colour) in enumerate(reversed(panel.legend)):
            renderer.AddActor2D(rectangle(10, 10 + 20 * i, 14, 14, [c / 255 for c in colour]))
            renderer.AddActor2D(text(words, (30, 9 + 20 * i), 14))
    for panel in panels:  # those that share a camera
        drawn[id(panel)].ResetCameraClippingRange()
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(image))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
