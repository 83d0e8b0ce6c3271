#!/usr/bin/python3
"""foreign_meshes.py BIN: meshes of two regions by Gmsh, TetGen and CGAL, through every format that is read.

A box around a cube, regions 7 and 12. Through each format tetsmooth keeps the surface between them exactly in the planes of the
cube, all corners, volumes, labels and their areas, and reaches 25 degrees; tetconvert keeps them all. Status 77: nothing to do it with.
"""
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import meshio
    import numpy as np
except ImportError as e:
    print("SKIPPED:", e)
    sys.exit(77)
try:
    import gmsh
except ImportError as e:
    gmsh = None
    print("not here:", e)

BIN = os.path.realpath(sys.argv[1])
HERE = os.path.dirname(os.path.realpath(__file__))
WORK = tempfile.TemporaryDirectory()
os.chdir(WORK.name)
SMALL, LARGE = 0.4, 1.0  # half the edges of the cube and of the box


def program(name, *args, status=(0,)):
    run = subprocess.run([f"{BIN}/{name}", *args], capture_output=True, text=True, check=False)
    if run.returncode not in status:
        sys.exit(f"{name} {' '.join(args)}: status {run.returncode}, expected {status}: {run.stderr}")
    return run.stderr


def by_gmsh():
    """Names of the files; regions 7 and 12 of the physical groups, entities 1 and 2 where a format has no groups."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    occ = gmsh.model.occ
    box = occ.addBox(*[-LARGE] * 3, *[2 * LARGE] * 3)
    cube = occ.addBox(*[-SMALL] * 3, *[2 * SMALL] * 3)
    occ.fragment([(3, box)], [(3, cube)])
    occ.synchronize()
    volumes = sorted((t for _, t in gmsh.model.getEntities(3)), key=lambda t: -occ.getMass(3, t))
    sides = [{t for _, t in gmsh.model.getBoundary([(3, v)], oriented=False)} for v in volumes]
    between = sides[0] & sides[1]
    outer = sorted(sides[0] - between)
    for dimension, entities, tag, name in ((3, volumes[:1], 7, "solvent"), (3, volumes[1:], 12, "solid part"), (2, sorted(between), 3, "interface"),
                                           (2, outer[:1], 4, "inlet"), (2, outer[1:], 5, "wall")):
        gmsh.model.addPhysicalGroup(dimension, entities, tag)
        gmsh.model.setPhysicalName(dimension, tag, name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.3)
    gmsh.model.mesh.generate(3)
    files = []
    for version in (2.2, 4.1):
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            files.append(f"gmsh-{version}-{'binary' if binary else 'text'}.msh")
            gmsh.write(files[-1])
    for binary in (0, 1):
        gmsh.option.setNumber("Mesh.Binary", binary)
        files.append(f"gmsh-{binary}.vtk")
        gmsh.write(files[-1])
    gmsh.option.setNumber("Mesh.Binary", 0)
    files.append("gmsh.mesh")
    gmsh.write(files[-1])
    gmsh.finalize()
    meshio.write("gmsh.vtu", meshio.read("gmsh-4.1-text.msh"))
    return files + ["gmsh.vtu"]


def cgal(points, tets, region, triangles, label):
    """As CGAL writes .mesh: version 1, references of vertices, each facet between regions from both of its sides."""
    with open("cgal.mesh", "w", encoding="ascii") as f:
        print("MeshVersionFormatted 1\nDimension 3\nVertices", len(points), sep="\n", file=f)
        for p in points:
            print(*p, 1, file=f)
        both = [(t[::s], m) for t, m in zip(triangles, label) for s in ((1, -1) if m == 3 else (1,))]
        print("Triangles", len(both), sep="\n", file=f)
        for t, m in both:
            print(*(np.array(t) + 1), m, file=f)
        print("Tetrahedra", len(tets), sep="\n", file=f)
        for t, r in zip(tets, region):
            print(*(t + 1), r, file=f)
        print("End", file=f)
    return ["cgal.mesh"]


def by_cgal():
    """By Mesh_3: cgal_source makes them anew where it is built, else what it made is in tests/data/cgal."""
    files = ["cgal-mesh3.mesh", "cgal-mesh3.vtu", "cgal-mesh3-binary.vtu"]
    if os.path.exists(f"{BIN}/cgal_source"):
        subprocess.run([f"{BIN}/cgal_source", str(SMALL), str(LARGE)], check=True)
    else:
        for file in files:
            shutil.copy(os.path.join(HERE, "..", "data", "cgal", file), file)
    return files


def by_tetgen():
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    with open("t.poly", "w", encoding="ascii") as f:
        print(16, 3, 0, 0, file=f)
        for i, (h, c) in enumerate([(h, c) for h in (LARGE, SMALL) for c in corners]):
            print(i + 1, *(h * x for x in c), file=f)
        print(12, 1, file=f)
        for k in range(2):
            for face in faces:
                print(1, 0, 3 if k else 4, "\n4", *(v + 1 + 8 * k for v in face), file=f)
        print("0\n2\n1 0.7 0 0 7 0\n2 0 0 0 12 0", file=f)
    subprocess.run(["tetgen", "-pq1.3a0.004AgkQ", "t.poly"], check=True, stdout=subprocess.DEVNULL)
    shutil.move("t.1.vtk", "tetgen.vtk")
    shutil.move("t.1.mesh", "tetgen.mesh")
    return ["tetgen.mesh", "tetgen.vtk"]


class Mesh:
    """What must not change, of a .vtu by us."""

    def __init__(self, file):
        m = meshio.read(file)
        blocks = {b.type: i for i, b in enumerate(m.cells)}
        tets, triangles = m.cells[blocks["tetra"]].data, m.cells[blocks["triangle"]].data
        data = m.cell_data
        name = "patch" if "patch" in data else "boundary"
        self.points, self.region, label = m.points, data["region"][blocks["tetra"]], data[name][blocks["triangle"]]
        p, q = m.points[tets], m.points[triangles]
        volume = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0]) / 6
        area = np.linalg.norm(np.cross(q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]), axis=1) / 2
        assert (volume > 0).all()
        self.volumes = {int(r): volume[self.region == r].sum() for r in np.unique(self.region)}
        self.areas = {int(l): area[label == l].sum() for l in np.unique(label)}
        inner = (np.abs(q) <= SMALL + 0.1).all(axis=(1, 2))
        self.exact = bool((np.abs(q[inner]) == SMALL).all(axis=1).any(axis=1).all())
        self.corners = sum((np.abs(m.points) == h).all(axis=1).sum() for h in (SMALL, LARGE))
        self.inner_area = area[inner].sum()


def close(a, b):
    return a.keys() == b.keys() and all(abs(a[k] - b[k]) < 1e-12 for k in a)


def try_file(file):
    said = program("tetconvert", file, "-o", "plain.vtu")
    assert "regions are the values of" in said, said
    program("tetsmooth", "--min-dihedral", "25", file, "-o", "better.vtu")
    before, after = Mesh("plain.vtu"), Mesh("better.vtu")
    assert len(before.volumes) == 2, before.volumes
    assert close(before.volumes, after.volumes) and close(before.areas, after.areas), (before.areas, after.areas)
    assert abs(min(after.volumes.values()) - (2 * SMALL) ** 3) < 1e-12
    assert before.exact and after.exact and abs(after.inner_area - 24 * SMALL**2) < 1e-12
    assert before.corners == 16 and after.corners == 16, (before.corners, after.corners)
    if file.endswith("msh") or file.startswith(("cgal.", "tetgen")) or file == "gmsh.vtu":
        assert set(after.volumes) == {7, 12}, after.volumes
    for ending in ("msh", "mesh"): # and to other formats and back
        program("tetconvert", "better.vtu", "-o", "other." + ending)
        program("tetconvert", "other." + ending, "-o", "back.vtu")
        back = Mesh("back.vtu")
        assert close(back.volumes, after.volumes) and close(back.areas, after.areas), (ending, back.areas, after.areas)
    print(file, "kept, 25 degrees")


files = []
if gmsh:
    files += by_gmsh()
    source = meshio.read("gmsh-4.1-text.msh")
    tetra = np.vstack([b.data for b in source.cells if b.type == "tetra"])
    triangle = np.vstack([b.data for b in source.cells if b.type == "triangle"])
    tags = source.cell_data["gmsh:physical"]
    files += cgal(source.points, tetra, np.concatenate([t for b, t in zip(source.cells, tags) if b.type == "tetra"]), triangle,
                  np.concatenate([t for b, t in zip(source.cells, tags) if b.type == "triangle"]))
if shutil.which("tetgen"):
    files += by_tetgen()
else:
    print("not here: tetgen")
files += by_cgal()
for name in files:
    try_file(name)
