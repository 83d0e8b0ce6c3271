#!/usr/bin/python3
"""Reads DIR/mesh.* with meshio, gmsh, h5py, DOLFINx and FreeFEM, GetFEM, Netgen and compares with DIR/expected.json, what was written.

Prints a line for each reader; "not here: …" for those that are not installed. Status 77 when not even meshio is.
"""
import json
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np

try:
    import meshio
except ImportError as e:
    print(e)
    sys.exit(77)

folder = sys.argv[1]
with open(folder + "/expected.json", encoding="utf-8") as f:
    E = json.load(f)
POINTS = np.array(E["points"]).reshape(-1, 3)
TETS = np.array(E["tets"]).reshape(-1, 4)
TRIS = np.array(E["tris"]).reshape(-1, 3)
REGION, PATCH = np.array(E["region"]), np.array(E["patch"])
SURFACE = np.array(E["boundary"]) == 1


def same(what, found, expected):
    found, expected = np.asarray(found), np.asarray(expected)
    if found.shape != expected.shape or not (found == expected).all():
        sys.exit(f"{what}: found {found.shape} {found.ravel()[:8]}, expected {expected.shape} {expected.ravel()[:8]}")


def same_cells(what, cells, tags, expected_cells, expected_tags):
    """In any order of the cells, each with its corners in order."""

    def table(c, t):
        rows = np.column_stack([c, t])
        return rows[np.lexsort(rows.T[::-1])]

    same(what, table(cells, tags), table(expected_cells, expected_tags))


def block(mesh, kind, data=None):
    cells = np.vstack([b.data for b in mesh.cells if b.type == kind])
    values = None if data is None else np.concatenate([d for b, d in zip(mesh.cells, mesh.cell_data[data]) if b.type == kind])
    return cells, values


def whole(what, mesh, tag):
    same(what + " points", mesh.points, POINTS)
    same_cells(what + " tetrahedra", *block(mesh, "tetra", tag), TETS, REGION)
    same_cells(what + " triangles", *block(mesh, "triangle", tag), TRIS, PATCH)


def gmsh_by_meshio(name):
    mesh = meshio.read(f"{folder}/{name}", file_format="gmsh")
    whole(name, mesh, "gmsh:physical")
    same(name + " names", sorted((k, int(v[0]), int(v[1])) for k, v in mesh.field_data.items()), sorted(map(tuple, E["groups"])))
    for array, values in E["arrays"].items() if name != "mesh.msh2" else ():
        values = np.array(values)
        same_cells(f"{name} {array}", *block(mesh, "tetra", array), TETS, values[: len(TETS)])
        same_cells(f"{name} {array}", *block(mesh, "triangle", array), TRIS, values[len(TETS) :])
    print(name, "meshio")


def gmsh_by_gmsh(name):
    try:
        import gmsh
    except ImportError as e:
        return print("not here:", e)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(f"{folder}/{name}")
    numbers, places, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(numbers)
    same(name + " points", places.reshape(-1, 3)[order], POINTS)
    groups = [(gmsh.model.getPhysicalName(d, t), t, d) for d, t in gmsh.model.getPhysicalGroups()]
    same(name + " names", sorted(groups), sorted(map(tuple, E["groups"])))
    for dimension, kind, expected, tags in ((3, 4, TETS, REGION), (2, 2, TRIS, PATCH)):
        cells, found = [], []
        for d, tag in gmsh.model.getPhysicalGroups(dimension):
            for entity in gmsh.model.getEntitiesForPhysicalGroup(d, tag):
                nodes = gmsh.model.mesh.getElementsByType(kind, entity)[1].astype(int).reshape(-1, expected.shape[1])
                cells.append(nodes - 1)
                found.append(np.full(len(nodes), tag))
        same_cells(name + " cells", np.vstack(cells), np.concatenate(found), expected, tags)
    kinds, numbers, nodes = gmsh.model.mesh.getElements()
    cells = {tuple(row - 1): n for k, element, corners in zip(kinds, numbers, nodes)
             for n, row in zip(element, corners.astype(int).reshape(-1, 3 if k == 2 else 4))}
    views = {gmsh.option.getString(f"View[{gmsh.view.getIndex(v)}].Name"): v for v in gmsh.view.getTags()}
    same(name + " arrays", sorted(views), sorted(E["arrays"]) if name != "mesh.msh2" else [])
    for array, view in views.items():
        _, elements, values, _, _ = gmsh.view.getModelData(view, 0)
        value = dict(zip(elements, (v[0] for v in values)))
        same(f"{name} {array}", [value[cells[tuple(c)]] for c in [*TETS, *TRIS]], E["arrays"][array])
    gmsh.finalize()
    print(name, "gmsh")


def tetgen():
    mesh = meshio.read(folder + "/mesh.ele")
    same("tetgen points", mesh.points, POINTS)
    same_cells("tetgen tetrahedra", *block(mesh, "tetra", "tetgen:ref"), TETS, REGION)
    print("mesh.node mesh.ele meshio")


def xdmf_by_meshio():
    """meshio takes one grid a file."""
    names = []
    for grid in xml.parse(folder + "/mesh.xdmf").getroot().find("Domain"):
        root = xml.Element("Xdmf", Version="3.0")
        xml.SubElement(root, "Domain").append(grid)
        names.append(grid.get("Name"))
        xml.ElementTree(root).write(f"{folder}/one_grid.xdmf")
        mesh = meshio.read(f"{folder}/one_grid.xdmf")
        same("xdmf points", mesh.points, POINTS)
        kind, cells, tag, tags, part = (("tetra", TETS, "region", REGION, slice(0, len(TETS))) if grid.get("Name") == "mesh"
                                        else ("triangle", TRIS, "patch", PATCH, slice(len(TETS), None)))
        same("xdmf cells", *([block(mesh, kind)[0], cells]))
        same("xdmf first array", list(mesh.cell_data)[0], tag)  # what DOLFINx takes for the tags
        same("xdmf " + tag, mesh.cell_data[tag][0].ravel(), tags)
        for array, values in E["arrays"].items():
            if array == "part" and kind == "triangle":
                continue
            same("xdmf " + array, mesh.cell_data[array][0].ravel(), np.array(values)[part])
    same("xdmf grids", names, ["mesh", "facets"])
    import h5py

    with h5py.File(folder + "/mesh.h5") as f:
        found = f["names/patch"][()].decode().split("\n")[:-1]
        same("xdmf names", sorted(found), sorted(f"{t} {n}" for n, t, d in E["groups"] if d == 2))
        for name, text in E["texts"].items():
            same("xdmf " + name, f["names/" + name][()].decode(), text)
    print("mesh.xdmf meshio h5py")


def xdmf_by_dolfinx():
    try:
        from dolfinx import cpp, io
        from mpi4py import MPI
    except ImportError as e:
        return print("not here:", e)
    with io.XDMFFile(MPI.COMM_WORLD, folder + "/mesh.xdmf", "r") as f:
        mesh = f.read_mesh(name="mesh")
        cells = f.read_meshtags(mesh, name="mesh")
        mesh.topology.create_connectivity(2, 3)
        mesh.topology.create_connectivity(2, 0)
        facets = f.read_meshtags(mesh, name="facets")
    same("DOLFINx cells", np.unique(cells.values, return_counts=True), np.unique(REGION, return_counts=True))
    same("DOLFINx facets", np.unique(facets.values, return_counts=True), np.unique(PATCH, return_counts=True))
    x = mesh.geometry.x

    def sizes(tags, corners):  # of all cells or facets of each tag
        measure = [np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0])) / 2 if corners == 3 else
                   abs(np.dot(np.cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0])) / 6
                   for p in x[cpp.mesh.entities_to_geometry(mesh._mesh, corners - 1, tags.indices, False)]]
        return np.bincount(tags.values, measure)

    for tags, cells_of, tag, corners in ((cells, TETS, REGION, 4), (facets, TRIS, PATCH, 3)):
        p = POINTS[cells_of]
        n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        measure = np.linalg.norm(n, axis=1) / 2 if corners == 3 else np.einsum("ij,ij->i", n, p[:, 3] - p[:, 0]) / 6
        if not np.allclose(sizes(tags, corners), np.bincount(tag, measure), rtol=1e-12):
            sys.exit(f"DOLFINx: found {sizes(tags, corners)}, expected {np.bincount(tag, measure)}")
    print("mesh.xdmf DOLFINx")


def measures():
    """Volume of each region, area of each label."""
    p, q = POINTS[TETS], POINTS[TRIS]
    volume = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0]) / 6
    area = np.linalg.norm(np.cross(q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]), axis=1) / 2
    return ({int(r): volume[REGION == r].sum() for r in np.unique(REGION)}, {int(l): area[PATCH == l].sum() for l in np.unique(PATCH)})


def freefem():
    plugins = subprocess.run(["find", "/usr/lib", "/usr/local/lib", "-name", "msh3.so", "-not", "-path", "*/mpi/*"], capture_output=True,
                             text=True, check=False).stdout.split()
    if not shutil.which("FreeFem++") or not plugins:
        return print("not here: FreeFem++ with msh3")
    volumes, areas = measures()
    with open(folder + "/read.edp", "w", encoding="ascii") as f:
        print(f'load "msh3"\nmesh3 Th("{folder}/mesh.mesh");\nofstream out("{folder}/read.txt");\nout.precision(17);', file=f)
        for kind, tags in (("int3d", volumes), ("int2d", areas)):
            for tag in tags:
                print(f"out << {kind}(Th, {tag})(1.) << endl;", file=f)
    subprocess.run(["FreeFem++", "-nw", "-v", "0", folder + "/read.edp"], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "FF_LOADPATH": os.path.dirname(plugins[0])})
    found = [float(x) for x in open(folder + "/read.txt", encoding="ascii").read().split()]
    if not np.allclose(found, [*volumes.values(), *areas.values()], rtol=1e-10):
        sys.exit(f"FreeFEM: found {found}, expected {volumes} {areas}")
    print("mesh.mesh FreeFEM")


def getfem():
    """One table of regions for elements and faces."""
    try:
        import getfem as gf
    except ImportError as e:
        return print("not here:", e)
    for name in ("mesh.msh2", "mesh.msh"):
        mesh = gf.Mesh("import", "gmsh", f"{folder}/{name}")
        same("GetFEM regions", sorted(mesh.regions()), sorted({t for _, t, _ in E["groups"]}))
        whole_element = 65535  # as the number of a face
        for tag in np.unique(REGION):
            same(f"GetFEM {name} region {tag}", mesh.region(int(tag))[1], np.full((REGION == tag).sum(), whole_element))
        for tag in np.unique(PATCH):
            faces = mesh.region(int(tag))
            assert (faces[1] < 4).all()
            found = {tuple(sorted(mesh.pid_in_faces(faces[:, [i]]))) for i in range(faces.shape[1])}
            same(f"GetFEM {name} label {tag}", len(found), (PATCH == tag).sum())
    print("mesh.msh2 mesh.msh GetFEM")


def netgen():
    try:
        from netgen.read_gmsh import ReadGmsh
    except ImportError as e:
        return print("not here:", e)
    shutil.copy(folder + "/mesh.msh2", folder + "/netgen.msh")
    mesh = ReadGmsh(folder + "/netgen.msh")
    elements = mesh.Elements3D()
    same("Netgen elements", len(elements), len(TETS))
    names = {t: n for n, t, d in E["groups"] if d == 3}
    found = {}
    for e in elements:
        found[mesh.GetMaterial(e.index)] = found.get(mesh.GetMaterial(e.index), 0) + 1
    same("Netgen materials", sorted(found.items()), sorted((names[t], int((REGION == t).sum())) for t in names))
    faces = {}
    for e in mesh.Elements2D():
        name = mesh.GetBCName(mesh.FaceDescriptor(e.index).bc - 1)
        faces[name] = faces.get(name, 0) + 1
    labels = {t: n for n, t, d in E["groups"] if d == 2}
    same("Netgen boundaries", sorted(faces.items()), sorted((labels[t], int((PATCH == t).sum())) for t in labels))
    print("mesh.msh2 Netgen")


def mcsf():
    """No reader in Python: the grammar of FEtk's own files, and what MC asks of a mesh."""
    text = open(folder + "/mesh.m", encoding="ascii").read()
    text = "\n".join(line.split("%")[0] for line in text.split("\n"))
    assert text.split()[0] == "mcsf_begin=1;" and text.split()[-1] == "mcsf_end=1;"
    sizes = {k: int(v) for k, v in (s.split("=") for s in text.replace(";", " ").split() if "=" in s and s[-1].isdigit())}
    assert (sizes["dim"], sizes["dimii"]) == (3, 3)
    vert = np.array(text.split("vert=[")[1].split("]")[0].split(), dtype=float).reshape(-1, 5)
    simp = np.array(text.split("simp=[")[1].split("]")[0].split(), dtype=int).reshape(-1, 11)
    assert (sizes["vertices"], sizes["simplices"]) == (len(vert), len(simp))
    same("mcsf numbers", vert[:, 0], np.arange(len(vert)))
    same("mcsf points", vert[:, 2:], POINTS)
    same("mcsf tetrahedra", simp[:, 7:], TETS)
    same("mcsf materials", simp[:, 2], REGION)
    typed = {}
    for row in simp:
        for face in range(4):
            if row[3 + face]:
                corners = tuple(sorted(np.delete(row[7:], face)))
                assert corners not in typed
                typed[corners] = (row[3 + face] + 1) // 2
    outer = {}  # triangles with one tetrahedron
    for tet in TETS:
        for face in range(4):
            corners = tuple(sorted(np.delete(tet, face)))
            outer[corners] = outer.get(corners, 0) + 1
    expected = {tuple(sorted(t)): p for t, p in zip(TRIS, PATCH) if outer[tuple(sorted(t))] == 1}
    assert typed == expected, (len(typed), len(expected))
    print("mesh.m, by its grammar")


def surface():
    used = np.unique(TRIS[SURFACE])
    for name in ("mesh.ply", "mesh.off"):
        mesh = meshio.read(f"{folder}/{name}")
        same(name + " points", mesh.points, POINTS[used])
        same(name + " triangles", used[block(mesh, "triangle")[0]], TRIS[SURFACE])
    mesh = meshio.read(folder + "/mesh.ply")
    same("ply patch", mesh.cell_data["patch"][0], PATCH[SURFACE])
    for array, values in E["arrays"].items():
        if array != "part":
            same("ply " + array, mesh.cell_data[array][0], np.array(values)[len(TETS) :][SURFACE])
    mesh = meshio.read(folder + "/mesh.stl")
    same("stl", mesh.points[block(mesh, "triangle")[0]], POINTS[TRIS[SURFACE]].astype(np.float32))
    print("mesh.ply mesh.off mesh.stl meshio")


def abaqus():
    """By its grammar: meshio 5.0 reads no surfaces."""
    keyword, cards = "", {}
    for line in open(folder + "/mesh.inp", encoding="ascii").read().split("\n"):
        if line.startswith("*"):
            keyword = line
        elif line and not keyword.startswith("*HEADING"):
            cards.setdefault(keyword, []).append(line.split(", "))
    same("inp points", np.array(cards["*NODE"], dtype=float)[:, 1:], POINTS)
    names = {t: n for n, t, d in E["groups"] if d == 3}
    faces = {"S1": (0, 1, 2), "S2": (0, 3, 1), "S3": (1, 3, 2), "S4": (2, 3, 0)}
    for tag, name in names.items():
        rows = np.array(cards[f"*ELEMENT, TYPE=C3D4, ELSET={name}"], dtype=int)
        same("inp " + name, rows[:, 1:] - 1, TETS[REGION == tag])
        same("inp numbers", rows[:, 0] - 1, np.flatnonzero(REGION == tag))
    for name, tag, dimension in E["groups"]:
        if dimension == 2:
            rows = cards[f"*SURFACE, TYPE=ELEMENT, NAME={name}"]
            found = [sorted(TETS[int(e) - 1][list(faces[s])]) for e, s in rows]
            same("inp " + name, found, np.sort(TRIS[PATCH == tag]))
    mesh = meshio.read(folder + "/mesh.inp")
    same("inp points by meshio", mesh.points, POINTS)
    print("mesh.inp, by its grammar and meshio")


def nastran():
    mesh = meshio.read(folder + "/mesh.bdf")
    if not np.allclose(mesh.points, POINTS, rtol=1e-9, atol=1e-12):
        sys.exit("bdf: points differ")
    same_cells("bdf tetrahedra", *block(mesh, "tetra", "nastran:ref"), TETS, REGION)
    same_cells("bdf triangles", *block(mesh, "triangle", "nastran:ref"), TRIS, PATCH)
    print("mesh.bdf meshio")


for n in ("mesh.msh", "binary.msh", "mesh.msh2"):
    gmsh_by_meshio(n)
    gmsh_by_gmsh(n)
whole("medit", meshio.read(folder + "/mesh.mesh"), "medit:ref")
print("mesh.mesh meshio")
abaqus()
nastran()
tetgen()
xdmf_by_meshio()
xdmf_by_dolfinx()
freefem()
getfem()
netgen()
mcsf()
surface()
