#!/usr/bin/env python3
"""peers.py BIN FILE... [--spacing H] [--install] [-o TABLE.md]: from atoms to a mesh of the molecule and its surroundings, by these programs and by others.

One run of each, one thread, processor seconds of all programs of a chain. The others: EDTSurf (molecular surface by marching cubes) with Gmsh's HXT or
with TetGen, on a surface of about as many triangles as ours has, in the same box; and CGAL's Mesh_3 on our own density, the molecule alone, with about
those triangles too (BIN/cgal_peer: `cmake --build build --target cgal_peer`). Peers that are not here are left out with a line on standard error;
--install gets them by apt-get (edtsurf, gmsh, tetgen).
"""
import argparse
import gzip
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

EFFORTS = ("fast", "good", "best")
PEERS = {"EDTSurf": "edtsurf", "gmsh": "gmsh", "tetgen": "tetgen"}


class Failed(Exception):
    """A program of a chain ended with another status than 0, or left no file."""


class Clock:
    """Processor seconds and the largest peak memory of the programs run since it was made, and of those on the clock before it."""

    def __init__(self, folder, before=None):
        self.folder = folder
        self.seconds, self.bytes = (before.seconds, before.bytes) if before else (0, 0)

    def run(self, *command):
        words = [str(c) for c in command]
        with open(self.folder / "log", "wb") as log:
            process = subprocess.Popen(words, cwd=self.folder, stdout=log, stderr=log)
            _, status, usage = os.wait4(process.pid, 0)
        self.seconds += usage.ru_utime + usage.ru_stime
        self.bytes = max(self.bytes, usage.ru_maxrss * 1024)
        if status != 0:
            raise Failed(f"{words[0]}: status {os.waitstatus_to_exitcode(status)}")


def read_ply(path):
    """EDTSurf's: text, a line for each vertex, coordinates first, and for each triangle."""
    with open(path) as file:
        counts = {}
        for line in file:
            words = line.split()
            if words[0] == "element":
                counts[words[1]] = int(words[2])
            if words[0] == "end_header":
                break
        points = [tuple(map(float, file.readline().split()[:3])) for _ in range(counts["vertex"])]
        return points, [tuple(map(int, file.readline().split()[1:4])) for _ in range(counts["face"])]


def write_stl(path, points, triangles):
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(x for v in t for x in points[v]), 0))


def corners(box):
    return [tuple(box[k >> axis & 1][axis] for axis in range(3)) for k in range(8)]


# Of a box, by the numbers of its corners: x first, then y, then z.
SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def gmsh_script(box):
    """Two volumes, around surface.stl and in it: HXT keeps the triangles that came in."""
    lines = ['Merge "surface.stl";', "Mesh.Algorithm3D = 10;", "Mesh.MshFileVersion = 4.1;", "Mesh.Binary = 1;", "Mesh.SaveAll = 1;",
             f"Mesh.MeshSizeMax = {max(b - a for a, b in zip(*box)) / 12};"]
    lines += [f"Point({k + 1000}) = {{{x}, {y}, {z}}};" for k, (x, y, z) in enumerate(corners(box))]
    number, edges = 1000, {}
    for side, corner in enumerate(SIDES):
        loop = []
        for a, b in zip(corner, corner[1:] + corner[:1]):
            if (b, a) in edges:
                loop.append(-edges[b, a])
            else:
                number += 1
                edges[a, b] = number
                lines.append(f"Line({number}) = {{{a + 1000}, {b + 1000}}};")
                loop.append(number)
        lines += [f"Curve Loop({side + 2000}) = {{{', '.join(map(str, loop))}}};", f"Plane Surface({side + 3000}) = {{{side + 2000}}};"]
    lines += ["Surface Loop(1) = {1};", "Surface Loop(2) = {%s};" % ", ".join(str(s + 3000) for s in range(6)),
              "Volume(1) = {1};", "Volume(2) = {2, 1};"]
    return "\n".join(lines) + "\n"


def tetgen_input(points, triangles, box):
    lines = [f"{len(points) + 8} 3 0 0", *(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate([*points, *corners(box)])),
             f"{len(triangles) + 6} 0", *(f"3 {a} {b} {c}" for a, b, c in triangles),
             *("4 " + " ".join(str(len(points) + k) for k in side) for side in SIDES), "0", "0"]
    return "\n".join(lines) + "\n"


class Comparison:
    def __init__(self, programs, folder, spacing):
        self.programs, self.folder, self.spacing, self.rows = programs.resolve(), folder, spacing, []

    def stat(self, name):
        """tetstat's answer. Meshes of others are not always valid, which is status 5."""
        done = subprocess.run([self.programs / "tetstat", "-q", "--json", self.folder / name], stdout=subprocess.PIPE, check=False)
        if done.returncode not in (0, 5):
            raise Failed(f"tetstat {name}: status {done.returncode}")
        return json.loads(done.stdout)

    def add(self, structure, chain, clock, mesh, surface=None):
        """surface: triangles; without, all that the mesh has."""
        m = self.stat(mesh)
        surface = surface or m["triangles"]
        angles = m["quality"]["dihedral"]
        rate = m["tets"] / clock.seconds
        self.rows.append((structure, chain, f"{surface:,}", f"{m['tets']:,}", f"{clock.seconds:.1f}", f"{rate:,.0f}",
                          f"{angles['min']:.1f}° to {angles['max']:.1f}°", f"{m['quality']['joe_liu_q']['min']:.3f}",
                          f"{clock.bytes / 1e6:,.0f} MB", "yes" if m["valid"] else "no"))
        print(*self.rows[-1], sep=" | ", flush=True)

    def ours(self, name, file, effort):
        """Surface (its report) and box of the mesh."""
        clock = Clock(self.folder)

        def tool(program, *options):
            clock.run(self.programs / program, "-q", "-t", "1", *options)

        tool("pdb2hier", file, "-o", "a.hier")
        tool("hier2density", "--spacing", self.spacing, "a.hier", "-o", "a.vdb")
        tool("density2tet", "--region", "both", "a.vdb", "-o", "a.tet.vtu")
        tool("tetsmooth", "--effort", effort, "--density", "a.vdb", "a.tet.vtu", "-o", "a.vtu", "--report", "r.json")
        surface = json.loads((self.folder / "r.json").read_text())["counts"]["surface"]
        self.add(name, f"molmesh, `--effort {effort}`", clock, "a.vtu", surface["triangles"])
        box = self.stat("a.vtu")["box"]
        return surface, (box["low"], box["high"])

    def edtsurf(self, structure, triangles):
        """A surface of about so many triangles; the clock of the last run."""
        scale = 1 / self.spacing
        for _ in range(4):
            clock = Clock(self.folder)
            clock.run("EDTSurf", "-i", structure, "-s", "3", "-h", "2", "-f", f"{scale:.3f}", "-o", "edt")
            points, faces = read_ply(self.folder / "edt.ply")
            if abs(len(faces) / triangles - 1) < 0.05:
                break
            scale *= (triangles / len(faces)) ** 0.5
        return clock, points, faces

    def cgal(self, name, file, surface):
        """CGAL's Mesh_3 on our density, with edges that give as many triangles on the surface."""
        edge = (4 * surface["area"] / (3 ** 0.5 * surface["triangles"])) ** 0.5
        first = Clock(self.folder)
        first.run(self.programs / "pdb2hier", "-q", file, "-o", "a.hier")
        first.run(self.programs / "hier2density", "-q", "-t", "1", "--spacing", self.spacing, "a.hier", "-o", "a.vdb")
        for chain, how in (("CGAL Mesh_3 on our density, the molecule alone", []), ("the same, perturbed and exuded", ["optimized"])):
            self.go_on(name, chain, first, (self.programs / "cgal_peer", "a.vdb", "cgal.vtu", edge, *how), "cgal.vtu")

    def go_on(self, name, chain, before, command, mesh, surface=None):
        """A row for the programs on the clock before and one more, or for why that failed."""
        clock = Clock(self.folder, before)
        try:
            clock.run(*command)
            self.add(name, chain, clock, mesh, surface)
        except Failed as error:
            self.rows.append((name, chain, f"{surface:,}" if surface else "", str(error), *[""] * 6))
            print(*self.rows[-1], sep=" | ", flush=True)

    def peers(self, name, structure, triangles, box, here):
        if "EDTSurf" not in here:
            return
        first, points, faces = self.edtsurf(structure, triangles)
        write_stl(self.folder / "surface.stl", points, faces)
        (self.folder / "hxt.geo").write_text(gmsh_script(box))
        (self.folder / "tg.smesh").write_text(tetgen_input(points, faces, box))
        for peer, chain, mesh, command in (("gmsh", "EDTSurf + Gmsh HXT", "hxt.msh", ("gmsh", "-3", "-nt", "1", "hxt.geo", "-o", "hxt.msh")),
                                           ("tetgen", "EDTSurf + TetGen", "tg.1.vtk", ("tetgen", "-pq1.6YkQ", "tg.smesh"))):
            if peer in here:
                self.go_on(name, chain, first, command, mesh, len(faces))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("files", type=pathlib.Path, nargs="+", help="structures as .pdb or .pdb.gz, which EDTSurf reads too")
    parser.add_argument("--spacing", type=float, default=0.5)
    parser.add_argument("--install", action="store_true")
    parser.add_argument("-o", dest="output", type=pathlib.Path)
    o = parser.parse_args()
    if o.install:
        subprocess.run(["apt-get", "install", "-y", "-q", *PEERS.values()], check=True)
    here = [p for p in PEERS if shutil.which(p)]
    for missing in sorted(set(PEERS) - set(here)):
        print(f"{missing} is not here (Debian: {PEERS[missing]})", file=sys.stderr)
    has_cgal = (o.bin / "cgal_peer").exists()
    if not has_cgal:
        print("CGAL's Mesh_3 is left out: cmake --build build --target cgal_peer", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(o.bin, pathlib.Path(folder), o.spacing)
        for file in o.files:
            name = file.name.split(".")[0].upper()
            if file.suffix == ".gz":
                plain = pathlib.Path(folder) / file.stem
                plain.write_bytes(gzip.decompress(file.read_bytes()))
                file = plain
            size = [comparison.ours(name, file.resolve(), effort) for effort in EFFORTS]
            surface, box = size[EFFORTS.index("good")]
            comparison.peers(name, file.resolve(), surface["triangles"], box, here)
            if has_cgal:
                comparison.cgal(name, file.resolve(), surface)
    if o.output:
        head = ("structure", "chain", "surface triangles", "tetrahedra", "processor, s", "tetrahedra a second", "dihedral angles", "Q ≥", "memory", "valid")
        o.output.write_text("".join("| " + " | ".join(row) + " |\n" for row in (head, ["---"] * len(head), *comparison.rows)))


if __name__ == "__main__":
    main()
