#!/usr/bin/python3
"""Reads each DIR/*.vtu with PROGRAM (vtk or meshio) and compares with DIR/*.json, what was written. Status 77: it is not
here."""
import glob
import json
import sys

program, folder = sys.argv[1:]
try:
    if program == "meshio":
        import meshio
    else:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
except ImportError as e:
    print(e)
    sys.exit(77)


def check(name, found, expected):
    if list(found) != expected:
        sys.exit(f"{name}: found {list(found)[:8]}..., expected {expected[:8]}...")


def with_vtk(path, e):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    check("points", vtk_to_numpy(grid.GetPoints().GetData()).ravel(), e["points"])
    cells = grid.GetCells()
    check("connectivity", vtk_to_numpy(cells.GetConnectivityArray()), e["connectivity"])
    check("types", vtk_to_numpy(grid.GetCellTypesArray()), e["types"])
    for name in ("region", "boundary", "part"):
        array = grid.GetCellData().GetArray(name)
        check(name, vtk_to_numpy(array) if array else [], e[name])
    for name, values in e["arrays"].items():
        check(name, vtk_to_numpy(grid.GetCellData().GetArray(name)), values)
    field = grid.GetFieldData()
    for name, text in e["texts"].items():
        check(name, [bytes(vtk_to_numpy(field.GetArray(name))).decode()], [text])
    check("isovalue", [field.GetArray("isovalue").GetValue(0)], [e["isovalue"]])
    for name in ("source", "creator"):
        check(name, [bytes(vtk_to_numpy(field.GetArray(name))).decode()], [e[name]])


def with_meshio(path, e):
    mesh = meshio.read(path)
    check("points", mesh.points.ravel(), e["points"])
    check("cells", [i for block in mesh.cells for i in block.data.ravel()], e["connectivity"])
    check("types", [{"tetra": 10, "triangle": 5}[b.type] for b in mesh.cells for _ in b.data], e["types"])
    for name in ("region", "boundary", "part"):
        blocks = mesh.cell_data.get(name, [])
        check(name, [v for block in blocks for v in block], e[name])
    for name, values in e["arrays"].items():
        check(name, [v for block in mesh.cell_data[name] for v in block], values)
    for name, text in e["texts"].items():
        check(name, [bytes(mesh.field_data[name]).decode()], [text])
    check("isovalue", mesh.field_data["isovalue"], [e["isovalue"]])
    for name in ("source", "creator"):
        check(name, [bytes(mesh.field_data[name]).decode()], [e[name]])


files = sorted(glob.glob(folder + "/*.vtu"))
if not files:
    sys.exit("no files")
for path in files:
    with open(path[:-3] + "json", encoding="utf-8") as f:
        expected = json.load(f)
    print(path)
    (with_meshio if program == "meshio" else with_vtk)(path, expected)
