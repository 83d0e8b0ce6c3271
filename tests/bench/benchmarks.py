#!/usr/bin/env python3
"""docs/benchmarks.md from one run on one machine: target beside result, the paper's figures and peers beside both.

    benchmarks.py BIN DATA [--quick] [--threads N | --shared] [--only density,mesh,improvement,chain,complexes,surface]
                           [--update] [--note TEXT] [-o docs/benchmarks.md]

BIN: folder of the programs; where field_errors, surface_distances and bench_contour are built there too (targets of that
name) their tables are made as well. DATA: folder of public structures (MOLMESH_TEST_DATA) with paper/, typical/, pqr/ and
large/; what is not there is skipped, with a line on standard error and one in the page. --quick: small structures alone,
one run each, a few minutes; else every structure, and medians of three runs where one takes less than ten seconds: about an hour. --shared: other work goes on
beside this one: everything on one thread, and seconds are those of the clock times the share of a processor that the
program had. --note: a sentence about the machine for the page. Tables that this machine cannot make (a GPU, other programs) come from the .md files beside this
script. --update: the sections that were measured (--only) take their places in the page that there is, and so do those of the
.md files; the others stay. Such a section says on which machine it was measured."""
import argparse
import functools
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import traceback

from chain import NO_DEVICE, Chain, ToolError

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DETAILED = ["-r", "* P_R=0.5 P_C=1"]  # of the paper's table 2
LONG = 10  # seconds; the noise of such a run is small beside its differences
LARGE = 20000  # atoms; at 0.5 Å more take minutes a mesh
SERCA = ["-r", "* P_R=0.2 P_C=0.8"]  # of the paper's figure 10

# Table 2 of the paper: name, atoms there, seconds of T0, NS, KD, BVH, NS+KD on 8 threads and of the GPU.
TABLE_2 = {
    "paper/1bor.pqr": ("1BOR", 832, 3.89, 0.76, 1.81, 2.08, 0.65, 0.20),
    "paper/1neq.pqr": ("1NEQ", 1187, 8.83, 1.08, 2.48, 2.73, 0.93, 0.25),
    "paper/1a63.pqr.gz": ("1A63", 2065, 21.60, 2.56, 5.61, 6.57, 1.50, 0.33),
    "paper/1a7m.pqr.gz": ("1A7M", 2809, 34.93, 3.37, 8.91, 9.87, 2.03, 0.51),
    "paper/1beb.pdb.gz": ("1BEB (here without hydrogens)", 4972, 107.38, 8.85, 18.77, 20.65, 2.99, 0.92),
    "paper/1a8r_for_1gtp.cif.gz": ("1GTP (here its kin 1A8R)", 69980, 15496.44, 820.79, 2060.70, 501.83, 162.01, 11.33),
}
VARIANTS = {"T0": ("full", "all"), "NS": ("neighbor", "all"), "KD": ("full", "kdtree"), "BVH": ("full", "bvh"),
            "NS+KD": ("neighbor", "kdtree"), "default": ("neighbor", "bvh")}
# Table 1 of the paper, 2KFX: band, analyzed points as a part of the grid.
TABLE_1 = {"0.9,1.1": 0.026, "0.6,1.4": 0.048, "0.3,1.7": 0.092, "0.1,2.0": 0.12}
# Table 3 of the paper, by the meshes of the recipes that stand for its structures: the recipe, the mesh, its density; the paper's name and
# atoms; its density, mesh, quality in seconds, sequential, on 8 threads, on a GPU; its V#, E#, edge ratio, Q, dihedral angles.
TABLE_3 = {
    "thin filament": (("filament", "filament.exterior", "filament"), "TFC", "69,222",
                      (188.6, 13.2, 157.8), (37.8, 6.6, 35.8), (4.8, 2.4, 6.3), (212120, 1094424, 10.24, 0.12, 15.00, 165.25)),
    "SERCA in POPC": (("membrane", "membrane.exterior", "membrane"), "SERCA", "80,157",
                      (165.1, 12.8, 163.5), (38.4, 6.3, 37.7), (11.7, 2.3, 7.2), (190356, 946273, 10.23, 0.14, 15.01, 167.25)),
    "myofibril lattice": (("lattice", "lattice.exterior", "lattice"), "ML", "95,853",
                          (377.5, 13.1, 189.5), (75.6, 6.7, 36.7), (7.3, 2.4, 5.8), (271523, 1327336, 10.31, 0.18, 15.03, 164.20)),
    "4V6X": (("machines", "ribosome", "ribosome"), "2W4A", "0.19 M",
             (687.4, 12.9, 213.7), (143.5, 6.7, 53.2), (10.2, 2.4, 6.5), (276458, 1334008, 10.98, 0.11, 15.10, 166.23)),
    "1HTQ, 24 chains": (("machines", "synthetase", "synthetase"), "1HTQ", "0.98 M",
                        (6494.7, 13.1, 250.6), (1589.4, 6.7, 68.3), (88.4, 2.7, 12.5), (399994, 1989245, 9.56, 0.10, 15.03, 167.46)),
    "2BTV's capsid": (("machines", "capsid", "capsid"), "2KU2", "1.23 M",
                      (3050.2, 12.9, 178.0), (645.5, 6.5, 44.2), (63.2, 2.4, 6.7), (243463, 1201048, 10.60, 0.15, 14.86, 167.42)),
}


def count(n):
    return f"{n:,.0f}"


def seconds(s):
    return f"{s:.3f}" if s < 0.1 else f"{s:.2f}" if s < 10 else f"{s:.1f}"


def megabytes(b):
    return f"{b / 1e6:,.0f} MB"


def angles(a):
    return f"{a[0]:.2f}° to {a[1]:.2f}°"


def percent(p):
    return f"{p if abs(p) >= 0.005 else 0:.2f} %"


def points_off(rows):
    """How many of how many, and in which meshes."""
    where = ", ".join(f"{r['file']} {r['region']}" for r in rows if r["off"] > 0)
    return f"{sum(r['off'] for r in rows)} of {count(sum(r['surface_points'] for r in rows))}" + (where and f" ({where})")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows])


class Page:
    """One run: what it measures, and what it writes."""

    def __init__(self, arguments, folder):
        self.arguments, self.data, self.quick = arguments, arguments.data, arguments.quick
        self.threads = 1 if arguments.shared else arguments.threads or os.cpu_count()
        self.chain = Chain(arguments.bin, folder, self.threads, arguments.shared)
        self.text, self.skipped, self.promises = [], [], []

    # --- small things

    def write(self, *paragraphs):
        self.text += [*paragraphs]

    def say(self, line):
        print(line, file=sys.stderr, flush=True)

    def file(self, name):
        """Of DATA, or None, and it is noted."""
        path = ROOT / name if name.startswith("tests/") else self.data / name
        if path.exists():
            self.say(f"  {name}")
            return path
        self.skipped.append(name)
        self.say(f"skipped {name}: not in {self.data}")
        return None

    def program(self, name):
        path = self.arguments.bin / name
        if path.exists():
            return path
        self.skipped.append(f"the table of `{name}`, which is not built")
        self.say(f"skipped {name}: not in {self.arguments.bin}")
        return None

    def repeated(self, run):
        """The run whose `work` is the median of three; one that takes long is made once."""
        runs = [run()]
        if not self.quick and runs[0]["work"] < LONG:
            runs = sorted([*runs, run(), run()], key=lambda r: r["work"])
        return runs[len(runs) // 2]

    def on_threads(self, run):
        """On one thread, and on all; None where that is one."""
        one = self.repeated(lambda: run(1))
        return one, None if self.threads == 1 else self.repeated(lambda: run(self.threads))

    @functools.cached_property
    def device(self):
        """The GPU that --mode cuda runs on, as the programs name it; None where there is none. Another hierarchy takes the place of the
        chain's when it is first asked for."""
        self.chain.hierarchy(ROOT / "tests/data/1tii.pdb")
        try:
            return self.chain.density("--spacing", "2", mode="cuda")["counts"]["device"]["name"]
        except ToolError as problem:
            if problem.status != NO_DEVICE:
                raise
            self.skipped.append("`--mode cuda`: there is no GPU")
            self.say(f"skipped: {problem}")
            return None

    def device_sentence(self):
        return f"*cuda* is {self.device}." if self.device else "The machine has no GPU: `--mode cuda` is not measured."

    def promise(self, what, target, result, kept):
        self.promises.append((what, target, result, "yes" if kept else "**no**"))

    # --- density

    def density(self):
        self.write("## Density: hier2density")
        self.density_speed()
        self.density_errors()
        self.table_2()
        self.table_1()

    def density_speed(self):
        rows = []
        for name, options, arguments, target in (
                ("tests/data/1tii.pdb", [], ["--spacing", "0.5"], None),
                ("paper/1su4.pdb.gz", [], ["--grid", "513"], None),
                ("paper/1htq_24chains_model1_derived.pdb.gz", DETAILED, ["--grid", "513"], 0.08),
                ("large/4v6x.cif.gz", DETAILED, ["--grid", "513"], 0.09),
                ("large/4v6x.cif.gz", DETAILED, ["--spacing", "0.25"], 0.7)):
            structure = self.file(name)
            if not structure:
                continue
            self.chain.hierarchy(structure, *options)
            one, all_ = self.on_threads(lambda t: self.chain.density(*arguments, threads=t))
            counts = one["counts"]
            grid = "×".join(str(n) for n in counts["grid_points"])
            rows.append((structure.name.split(".")[0].split("_")[0].upper(), " ".join(arguments), count(counts["atoms"]), grid,
                         count(counts["active_points"]), seconds(one["seconds"]["density"]),
                         seconds(all_["seconds"]["density"]) if all_ else "–", target or "",
                         seconds((all_ or one)["wall"]), megabytes((all_ or one)["peak_rss_bytes"])))
        self.write("### Speed", "Phase `density` on one thread and on all; *process* is the whole program with reading and "
                   "writing, on all threads. Exponents: P_R 0.5, P_C 1 where there is a target, else the defaults.",
                   table(("structure", "grid asked for", "atoms", "grid", "active points", "1 thread, s",
                          "all threads, s", "target, 2 threads", "process, s", "memory"), rows))

    def density_errors(self):
        program = self.program("field_errors")
        if not program:
            return
        cases = [("tests/data/1tii.pdb", "0.7", "1e-4"), ("tests/data/1tii.pdb", "0.7", "1e-6")]
        if not self.quick:
            cases += [("typical/1bna.pdb", "0.7", "1e-4"), ("typical/1bna.pdb", "0.7", "1e-6"),
                      ("paper/1su4.pdb.gz", "0.7", "1e-4"), ("large/4v6x.cif.gz", "1.5", "1e-4")]
        head, columns = ["P_R, P_C"], []
        for name, spacing, tolerance in cases:
            structure = self.file(name)
            if not structure:
                continue
            self.chain.hierarchy(structure)
            text = subprocess.run([program, self.chain.path("hier"), spacing, tolerance, "300" if self.quick else "2000"],
                                  check=True, stdout=subprocess.PIPE, text=True).stdout
            columns.append(re.findall(r"P_R (\S+), P_C (\S+): (\S+)", text))
            head.append(f"{structure.name.split('.')[0].upper()}, {spacing} Å, ε = {tolerance}")
        rows = [(f"{a}, {b}", *(column[i][2] for column in columns)) for i, (a, b, _) in enumerate(columns[0])]
        worst = max(float(c[2]) for column in columns for c in column)
        self.promise("I1: error of a value, parts of ε·max(1, G)", "≤ 1", f"{worst:.2f}", worst <= 1)
        self.write("### Errors", "The worst of random active points against the sum over all atoms in double precision, as a "
                   "part of ε·max(1, G): 1 is what I1 promises. Up to 0.2 of it are digits of a value that ε does not "
                   "need, rounded off; up to 0.55 are half of what dropping atoms may have lost.", table(head, rows))

    def table_2(self):
        rows, modes = [], ["omp", *(["cuda"] if self.device else [])]
        for name, (title, atoms, *paper) in TABLE_2.items():
            if self.quick and atoms > 3000:
                continue
            structure = self.file(name)
            if not structure:
                continue
            self.chain.hierarchy(structure, *DETAILED)
            row = None
            for (variant, (search, atoms_by)), theirs in zip(VARIANTS.items(), [*paper[:5], None]):
                if row is None:
                    row = [title, ""]
                if atoms_by == "all" and atoms > (1500 if self.quick else 3000):
                    row.append(f"– / {theirs:,g}")
                    continue
                run = self.repeated(lambda: self.chain.density("--spacing", "0.25", "--margin", "4", "--search", search,
                                                               "--atoms", atoms_by, threads=1, output="/dev/null"))
                row[1] = count(run["counts"]["atoms"])
                row.append(seconds(run["seconds"]["density"]) + (f" / {theirs:,g}" if theirs else ""))
            for mode in modes:
                run = self.repeated(lambda: self.chain.density("--spacing", "0.25", "--margin", "4", mode=mode, output="/dev/null"))
                row.append(seconds(run["seconds"]["density"]))
            rows.append((*row, f"{paper[5]:g}"))
        self.write("### The paper's table 2", "Seconds, **ours on one thread / the paper's with 8 threads** (Xeon E5-1620). T0: "
                   "every atom at every point; NS: every atom, points near the surface alone; KD, BVH: atoms by tree at "
                   "every point; NS+KD: both. 0.25 Å, margin 4 Å, P_R = 0.5, P_C = 1. –: not run, since it takes more than ten minutes. "
                   f"*omp*: the default on all threads. {self.device_sentence()}",
                   table(("", "atoms here", *VARIANTS, *modes, "the paper's GPU"), rows))

    def table_1(self):
        structure = self.file("paper/1a7m.pqr.gz")
        if not structure:
            return
        self.chain.hierarchy(structure, *DETAILED)
        rows = []
        for band, paper in TABLE_1.items():
            counts = self.chain.density("--grid", "513", "--band", band)["counts"]
            n = counts["grid_points"]
            rows.append((band, f"{counts['k_A']:.3f}", f"{counts['active_points'] / (n[0] * n[1] * n[2]):.3f}", paper))
        self.write("### The paper's table 1", "Analyzed points k_A as a part of the grid. Ours counts whole blocks of 8³ "
                   "points; the active points are beside it. 513 points; 1A7M here, 2KFX there "
                   "([figure 6](figures.md#figure-6-points-near-the-surface)).",
                   table(("band", "k_A", "active points", "the paper's k_A, 2KFX"), rows))

    # --- mesh

    def mesh(self):
        self.write("## Mesh: density2tet")
        self.mesh_tolerance()
        self.mesh_speed()
        self.mesh_distance()
        self.mesh_peers()

    def mesh_tolerance(self):
        self.chain.hierarchy(self.file("tests/data/1tii.pdb"))
        self.chain.density("--spacing", "1" if self.quick else "0.5")
        rows = []
        for adapt in ("0", "0.05", "0.1", "0.2", "0.3", "auto"):
            run = self.repeated(lambda: self.chain.mesh("--adapt", adapt))
            found = self.chain.stat("tet")
            rows.append((adapt, count(found["tets"]), count(found["surface"]["triangles"]), seconds(run["work"]),
                         f"{found['surface']['volume']:,.0f}", angles((found["quality"]["dihedral"]["min"],
                                                                     found["quality"]["dihedral"]["max"])),
                         "yes" if found["valid"] else "**no**"))
        self.write(f"### Elements for a tolerance", f"1TII at {'1' if self.quick else '0.5'} Å, interior.",
                   table(("`--adapt`", "tetrahedra", "surface triangles", "seconds", "volume, Å³", "angles", "valid"), rows))

    def mesh_speed(self):
        rows = []
        for title, name, rules, grid, options, target in (
                ("1TII, 0.5 Å, uniform", "tests/data/1tii.pdb", [], ["--spacing", "0.5"], ["--adapt", "0"],
                 "4 M elements/s and core"),
                ("1TII, 0.5 Å", "tests/data/1tii.pdb", [], ["--spacing", "0.5"], [], ""),
                ("1SU4, 513 points, P_R 0.2, P_C 0.8", "paper/1su4.pdb.gz", SERCA, ["--grid", "513"], [],
                 "0.7 s on 2 threads"),
                ("1SU4, 513 points, defaults", "paper/1su4.pdb.gz", [], ["--grid", "513"], [], "0.7 s on 2 threads")):
            structure = self.file(name)
            if not structure:
                continue
            self.chain.hierarchy(structure, *rules)
            self.chain.density(*grid)
            one, all_ = self.on_threads(lambda t: self.chain.mesh(*options, threads=t))
            n = one["counts"]["tetrahedra"]
            rows.append((title, count(n), seconds(one["work"]), seconds(all_["work"]) if all_ else "–",
                         f"{n / one['work'] / 1e6:.2f} M", target, megabytes((all_ or one)["peak_rss_bytes"])))
        self.write("### Speed", "Interior; all phases but reading and writing. The paper's mesh generation takes 6.3 to 6.7 s "
                   "with 8 threads, 12.8 to 13.2 s on one, for meshes of 1 to 2 million.",
                   table(("", "tetrahedra", "1 thread, s", "all threads, s", "elements/s on 1", "target", "memory"), rows))

    def mesh_distance(self):
        program = self.program("surface_distances")
        if not program:
            return
        rows = []
        for title, name, grid, adapts in (("1UBQ, 0.5 Å", "typical/1ubq.pdb", ["--spacing", "0.5"], ["0", "0.1", "0.2", "auto"]),
                                          ("1TII, 0.5 Å", "tests/data/1tii.pdb", ["--spacing", "0.5"], ["0.2", "auto"]),
                                          ("1SU4, 513 points", "paper/1su4.pdb.gz", ["--grid", "513"], ["0.2", "0.41", "auto"])):
            if self.quick and not name.startswith("typical"):
                continue
            structure = self.file(name)
            if not structure:
                continue
            self.chain.hierarchy(structure)
            self.chain.density(*grid)
            text = subprocess.run([program, self.chain.path("vdb"), *adapts], check=True, stdout=subprocess.PIPE, text=True)
            for adapt, line in zip(adapts, text.stdout.splitlines()[1:]):
                word = line.split()
                rows.append((title, f"{word[0]} (default)" if adapt == "auto" else adapt, count(int(word[1])),
                             count(int(word[2])), *word[3:7], f"{word[7]} ({word[8].replace('%', ' %')})", word[9]))
        self.write("### The surface beside the isosurface", "Before improvement; interior. Distance of the triangles' centroids "
                   "from the nearest place of the isosurface, in h; triangles beyond 0.5 h (target: none); turned by over "
                   "45° from the field's normal, in 1,000.",
                   table(("", "`--adapt`", "tetrahedra", "triangles", "median", "99 %", "99.9 %", "most", "beyond 0.5 h",
                          "turned"), rows))

    def mesh_peers(self):
        program = self.program("bench_contour")
        if not program or self.quick:
            return
        rows = []
        for name, spacing in (("typical/1ubq.pdb", "0.5"), ("tests/data/1tii.pdb", "1"), ("tests/data/1tii.pdb", "0.5")):
            structure = self.file(name)
            if not structure:
                continue
            text = subprocess.run([program, structure, spacing], check=True, stdout=subprocess.PIPE, text=True).stdout
            for line in text.splitlines()[2:]:
                by, numbers = re.match(r"(.*?)\s{2,}(\d.*)", line).groups()
                word = numbers.split()
                rows.append((f"{structure.name.split('.')[0].upper()}, {spacing} Å", by, count(int(word[0])),
                             word[1], count(float(word[2])), f"{word[3]}° to {word[4]}°", word[5], " ".join(word[8:])))
        self.write("### Beside CGAL and TetGen", "The same density, interior, one thread, processor time.",
                   table(("", "by", "tetrahedra", "seconds", "elements/s", "angles", "Q ≥", ""), rows))

    # --- improvement

    def improvement(self):
        self.write("## Elements: tetsmooth --density")
        if self.quick:
            sets = [("0.5 Å", ["--spacing", "0.5"], ["typical/1crn.pdb", "typical/1ubq.pdb", "typical/1bna.pdb",
                                                     "typical/1l2y.pdb.gz", "pqr/born__ion.pqr"]),
                    ("1 Å", ["--spacing", "1"], ["tests/data/1tii.pdb"])]
        else:
            def all_of(*folders):
                return [f"{folder}/{p.name}" for folder in folders for p in sorted((self.data / folder).glob("*"))
                        if p.suffix != ".md"]
            sets = [("0.5 Å", ["--spacing", "0.5"], ["tests/data/1tii.pdb", *all_of("typical", "pqr")]),
                    ("0.5 Å, what readers stumble over", ["--spacing", "0.5"], all_of("odd")),
                    ("513 points", ["--grid", "513"], [n for n in all_of("paper") if "1htq" not in n])]
        rows, every = [], []
        for title, grid, names in sets:
            of_set = []
            for name in names:
                structure = self.file(name)
                if not structure:
                    continue
                try:
                    atoms = self.chain.hierarchy(structure)["counts"]["atoms"]
                    if atoms > LARGE and "513" not in grid:
                        self.skipped.append(f"{name}, {count(atoms)} atoms, at 0.5 Å")
                        continue
                    self.chain.density(*grid)
                    for region in ("both", "interior", "exterior"):
                        row = {"name": structure.name.split(".")[0], "file": structure.name, **self.chain.row(region)}
                        of_set.append(row)
                        if row["off"] > 0:
                            self.say(f"  points off: {points_off([row])}")
                except ToolError as error:  # a file without atoms is refused, and is no mesh
                    self.say(f"  {name}: {error}")
            every += [(title, r) for r in of_set]
            rows += [self.improvement_row(f"{title}: {len(of_set)} meshes, worst of all", of_set)] if of_set else []
            if len(of_set) <= 18:
                rows += [self.improvement_row(f"{r['name']}, {r['region']}", [r]) for r in of_set]
        self.write("Before: the mesh as density2tet leaves it. Points off: surface points over 0.02 h from the isosurface (I8: "
                   "none). Centroids: surface triangles over 0.25 h from it (I8: 10 ‰). Turned: by over 45° from the field's "
                   "normal (target: 1 ‰). Volume: what the isosurface encloses beyond the mesh (I8: 0.5 %). Rate: elements "
                   "that come in a second, on all threads (target: 100,000 a core).",
                   table(("", "tetrahedra", "before", "after", "Q ≥", "edge ratio ≤", "points off", "centroids", "turned",
                          "volume", "mesh, s", "improvement, s", "rate", "valid"), rows))
        self.keep_promises([r for _, r in every])

    def improvement_row(self, title, rows):
        pick = lambda key, worst=max: worst(r[key] for r in rows)  # noqa: E731
        total = sum(r["improve_seconds"] for r in rows)
        return (title, count(sum(r["elements"] for r in rows)),
                angles((min(r["before"][0] for r in rows), max(r["before"][1] for r in rows))),
                angles((min(r["after"][0] for r in rows), max(r["after"][1] for r in rows))), f"{pick('q', min):.3f}",
                f"{pick('ratio'):.2f}", points_off(rows),
                f"{pick('far'):.2f} ‰", f"{pick('turned'):.2f} ‰",
                percent(max((r["missing"] for r in rows), key=abs)), seconds(sum(r["mesh_seconds"] for r in rows)),
                seconds(total), count(sum(r["elements_before"] for r in rows) / total),
                "yes" if all(r["valid"] for r in rows) else "**no**")

    def keep_promises(self, rows):
        if not rows:
            return
        n = f"{len(rows)} meshes"
        bad = sum(not r["valid"] for r in rows)
        self.promise("I6, I8: valid before and after, no crossing triangles, components and Euler number kept", n,
                     f"{len(rows) - bad}", bad == 0)
        low, high = min(r["before"][0] for r in rows), max(r["before"][1] for r in rows)
        self.promise("angles before improvement", "10° to 160°", angles((low, high)), low >= 10 and high <= 160)
        low, high = min(r["after"][0] for r in rows), max(r["after"][1] for r in rows)
        self.promise("angles after improvement", "25° to 140°", angles((low, high)), low >= 25 and high <= 140)
        self.promise("Joe-Liu's Q", "≥ 0.30", f"{min(r['q'] for r in rows):.3f}", min(r["q"] for r in rows) >= 0.3)
        self.promise("edge ratio", "≤ 6", f"{max(r['ratio'] for r in rows):.2f}", max(r["ratio"] for r in rows) <= 6)
        self.promise("I8: surface points off the isosurface", "0", points_off(rows), not any(r["off"] for r in rows))
        self.promise("I8: centroids beyond 0.25 h", "≤ 10 ‰", f"{max(r['far'] for r in rows):.2f} ‰",
                     max(r["far"] for r in rows) <= 10)
        self.promise("surface triangles turned by over 45°", "≤ 1 ‰", f"{max(r['turned'] for r in rows):.2f} ‰",
                     max(r["turned"] for r in rows) <= 1)
        missing = max((r["missing"] for r in rows), key=abs)
        self.promise("I8: volume beside the isosurface's", "within 0.5 %", percent(missing), abs(missing) <= 0.5)

    # --- the whole chain

    def whole_chain(self):
        names = [("1SU4", "paper/1su4.pdb.gz")]
        if not self.quick:
            names += [("1HTQ, 24 chains", "paper/1htq_24chains_model1_derived.pdb.gz"), ("4V6X", "large/4v6x.cif.gz")]
        rows = []
        for title, name in names:
            structure = self.file(name)
            if not structure:
                continue
            atoms = self.chain.hierarchy(structure)["counts"]["atoms"]
            for threads in sorted({1, self.threads}):
                density = self.chain.density("--grid", "513", threads=threads)
                mesh = self.chain.mesh("--region", "both", threads=threads)
                improvement = self.chain.improve(threads=threads)
                quality, counts = self.chain.stat("out")["quality"], improvement["counts"]
                parts = [density["seconds"]["density"], mesh["work"],
                         sum(improvement["seconds"].get(n, 0) for n in ("adjacency", "target", "improve", "result"))]
                rows.append((f"{title}, {count(atoms)} atoms", f"{threads} thread{'s' if threads > 1 else ''}",
                             *(seconds(p) for p in parts), seconds(sum(parts)), count(counts["points"]),
                             count(counts["elements"]), f"{quality['edge_ratio']['max']:.2f}",
                             f"{quality['joe_liu_q']['min']:.2f}",
                             angles((quality["dihedral"]["min"], quality["dihedral"]["max"])),
                             megabytes(max(r["peak_rss_bytes"] for r in (density, mesh, improvement)))))
        self.write("## The whole chain", "Seconds of density, mesh generation and quality improvement; 513 points on the longest axis, "
                   "both regions, defaults. Our default field draws atoms more sharply than the paper's and meshes both sides, so that "
                   "meshes are larger than [those of its complexes](#complexes-the-papers-table-3).",
                   table(("", "", "density", "mesh", "quality", "total", "V#", "E#", "edge ratio ≤", "Q ≥", "dihedral angles",
                          "memory"), rows))

    # --- complexes

    def recipe(self, name, mesh):
        """What complexes/NAME.sh runs for a mesh: by the file that is made, the grid's points and the options. Its folder, where the hierarchies
        are made, and the densities of pieces that the recipe measures; nothing else is."""
        script, folder, stubs = ROOT / "complexes" / f"{name}.sh", self.chain.path(f"recipe_{name}"), self.chain.path("stubs")
        commands = self.chain.path("commands")
        commands.write_text("")
        stubs.mkdir(exist_ok=True)
        for program in ("hier2density", "densityjoin", "density2tet", "tetsmooth", "tetlabel", "tetstat"):  # each makes an empty file
            stub = stubs / program
            stub.write_text("#!/bin/sh\n"
                            f'[ {program} = hier2density ] && case "$*" in *lattice_*) exec "{self.arguments.bin.resolve()}/{program}" "$@";; esac\n'
                            f'(printf "%s\\t" "$points" "$@"; echo) >>"{commands}"\n'
                            'while [ $# -gt 1 ]; do [ "$1" = -o ] && : >"$2"; shift; done\n')
            stub.chmod(0o755)
        path = f"{stubs}:{self.arguments.bin.resolve()}:{os.environ['PATH']}"
        subprocess.run(["bash", script, self.data, folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env={**os.environ, "PATH": path, "MESHES": mesh, "GRID": "", "THREADS": "1"})
        found = {}
        for line in commands.read_text().splitlines():
            points, *words = line.split("\t")[:-1]
            made, options, k = None, [], 0
            while k < len(words):
                if words[k] in ("--mode", "-t", "--report", "-o", "--density"):
                    made = words[k + 1] if words[k] == "-o" else made
                    k += 2
                    continue
                options.append(words[k])
                k += 1
            found.setdefault(made, (int(points), options[:-1]))  # without the input
        return found, folder

    def complex(self, recipe, mesh, density):
        """Its hierarchy in place; the grid's points, options of the density of 513 points, of that which is meshed, and of the mesh; or None."""
        found, folder = self.recipe(recipe, mesh)
        if f"{density}.vdb" not in found:
            return None
        (points, options), (_, of_mesh) = found[f"{density}.vdb"], found[f"{mesh}.tet.vtu"]
        os.replace(folder / f"{density}.hier", self.chain.path("hier"))
        fine = list(options)
        if "--grid" in fine:
            fine[fine.index("--grid") + 1] = "513"
        else:
            at = fine.index("--spacing") + 1
            fine[at] = f"{float(fine[at]) * (points - 1) / 512:.6g}"
        return points, fine, options, of_mesh

    def complexes(self):
        several = max(2, self.arguments.threads or os.cpu_count())
        modes = [("seq", 1, "good"), ("omp", several, "good"), ("omp", several, "fast")] + ([("cuda", several, "good")] if self.device else [])
        def processor(runs):
            return sum(r["processor"] * r["work"] / max(r["wall"], 1e-9) for r in runs)
        rows, below, good, measured, missing = [], 0, 0, 0, []
        for title, (source, theirs, their_atoms, sequential, cores, gpu, paper) in TABLE_3.items():
            made_of = self.complex(*source)
            if not made_of:
                missing.append(title)
                self.skipped.append(f"{title} of the paper's table 3")
                self.say(f"skipped {title}")
                continue
            points, of_fine, of_density, of_mesh = made_of
            found, totals, made = None, {}, {}
            for mode, threads, effort in modes:
                at = {"threads": threads, "mode": mode}
                if mode not in made:  # for both efforts
                    made = {mode: [self.chain.density(*of_fine, **at, output=self.chain.path("fine")),
                                   self.chain.density(*of_density, **at), self.chain.mesh(*of_mesh, **at)]}
                runs = [*made[mode], self.chain.improve("--effort", effort, **at, good=(0, 5))]
                if not found or effort != found["effort"] or mode == "cuda":  # the host's modes give the same bytes
                    found = {**self.chain.stat("out"), "effort": effort}
                parts = [runs[0]["work"] + runs[1]["work"], runs[2]["work"], runs[3]["work"]]
                total, quality = sum(parts), found["quality"]
                if found["valid"]:
                    totals[effort] = min(total, totals.get(effort, total))
                rows.append((f"**{title}**, {points} points", count(runs[0]["counts"]["atoms"]),
                             (f"{mode}, {threads} thread{'s' if threads > 1 else ''}" if mode != "cuda" else mode)
                             + (f", {effort}" if effort != "good" else ""),
                             *map(seconds, parts), seconds(total), seconds(processor(runs)), count(found["points"]), count(found["tets"]),
                             f"{quality['edge_ratio']['max']:.2f}", f"{quality['joe_liu_q']['min']:.2f}",
                             angles((quality["dihedral"]["min"], quality["dihedral"]["max"])),
                             "yes" if found["valid"] else "**no**"))
                self.say(f"  {title}, {mode} {effort}: {' '.join(map(seconds, parts))}, processor {seconds(processor(runs))}, {found['tets']} elements")
            v, e, ratio, q, low, high = paper
            for mode, parts in (("sequential", sequential), ("8 threads", cores), ("GPU", gpu)):
                rows.append((f"*the paper's {theirs}*", their_atoms, mode, *(f"{s:,g}" for s in parts), f"{sum(parts):,.1f}", "", count(v),
                             count(e), f"{ratio:.2f}", f"{q:.2f}", angles((low, high)), ""))
            measured += 1
            below += any(total < sum(gpu) for total in totals.values())
            good += totals.get("good", sum(gpu)) < sum(gpu)
        if not rows:
            return
        self.promise("table 3: complexes whose total is below that of the paper's GPU", f"{len(TABLE_3)}",
                     f"{below} of {measured} measured, {several} threads, " + ("all with 25° to 140°" if good == below else f"{good} with 25° to 140°, the rest by `--effort fast`"), below == len(TABLE_3))
        self.write("## Complexes: the paper's table 3", "Seconds of density, mesh generation and quality improvement without reading and "
                   "writing; the paper's exponents, the meshes of the recipes in `complexes/`, whose structures stand for the paper's "
                   "([complexes.md](complexes.md)). As in the paper the first three are "
                   "meshes of the surroundings up to a box, the others of the molecule. *Density* is that of 513 points along the longest edge, as "
                   "the paper has it, and besides that of the grid that is meshed, whose points the first column says (twice where these are 513): with these and a decay rate of 0.15 a mesh is "
                   "about as large as the paper's. `fast` is `tetsmooth --effort fast`, whose aim, 15° to 155°, is what the paper's meshes have; a mesh that is not valid does not count. "
                   "*Processor* is the seconds of all threads together. The paper's are from a Xeon E5-1620 (4 cores, 8 "
                   f"threads) and a GTX 680. {self.device_sentence()}" + (f" Not measured in this run: {', '.join(missing)}." if missing else ""),
                   table(("", "atoms", "mode", "density", "mesh", "quality", "total", "processor", "V#", "E#", "edge ratio ≤", "Q ≥",
                          "dihedral angles", "valid"), rows))

    # --- the body

    def surface(self):
        names = ["typical/1crn.pdb", "typical/1ubq.pdb", "typical/1l2y.pdb.gz"] if self.quick else [
            f"typical/{p.name}" for p in sorted((self.data / "typical").glob("*.pdb*")) if p.name[:4] not in ("1bna", "2koc", "1j59")]
        files = [f for f in map(self.file, names) if f]
        if not files:
            return
        done = subprocess.run(["python3", HERE / "surface_volume.py", self.arguments.bin, *files], stdout=subprocess.PIPE,
                              text=True)
        if done.returncode != 0:
            self.skipped.append("the default surface beside the solvent-excluded one (needs numpy and scipy)")
            return
        lines = done.stdout.splitlines()
        rows = [line for line in lines if line.startswith("|")]
        medians = [f"- {line.removeprefix('default, ')}" for line in lines if not line.startswith("|")]
        self.write("## The default surface beside the solvent-excluded one", "0.5 Å. In brackets: the volume beside the "
                   "solvent-excluded one by the file's radii, and by radii that make room for the hydrogens where the file has "
                   "none. A surface of n components without tunnels has Euler number 2n; each tunnel takes 2 away.",
                   "\n".join(rows), "\n".join(medians))

    # --- the page

    def machine(self):
        info = pathlib.Path("/proc/cpuinfo").read_text() if pathlib.Path("/proc/cpuinfo").exists() else ""
        model = re.search(r"model name\s*:\s*(.*)", info)
        flags = re.search(r"flags\s*:\s*(.*)", info)
        flags = flags.group(1).split() if flags else []
        simd = next((name for flag, name in (("avx512f", "AVX-512"), ("avx2", "AVX2"), ("sse4_1", "SSE4")) if flag in flags), "")
        memory = re.search(r"MemTotal:\s*(\d+)", pathlib.Path("/proc/meminfo").read_text())
        version = subprocess.run([self.arguments.bin / "hier2density", "--version"], stdout=subprocess.PIPE, text=True).stdout
        return (f"{model.group(1) if model else 'unknown processor'}, {os.cpu_count()} cores in use, {simd}, "
                f"{int(memory.group(1)) / 2**20:.0f} GiB{', a virtual machine' if 'hypervisor' in flags else ''}; "
                f"molmesh {version.split()[-1]}; all threads: {self.threads}. {self.arguments.note}").strip()

    def updated(self, body):
        """The page that there is, with the sections of `body` and of the .md files in place of its own."""
        sections = re.split(r"(?m)^(?=## )", self.arguments.output.read_text())
        fresh = re.split(r"(?m)^(?=## )", "\n\n".join(body) + "\n\n")[1:]
        kind = ("of one run beside other work: of one thread, seconds of the clock times the share of a processor that it had; of several, "
                "seconds of the clock without those in which the first thread waited for a processor" if self.arguments.shared else "of one run")
        fresh = [s.rstrip() + f"\n\nMeasured on: {self.machine()} Times are {kind}.\n\n" for s in fresh]
        fresh += [path.read_text().strip() + "\n\n" for path in sorted(HERE.glob("*.md"))
                  if any(s.startswith(path.read_text().split("\n")[0] + "\n") for s in sections)]
        for section in fresh:
            head = section.split("\n")[0]
            at = [i for i, old in enumerate(sections) if old.startswith(head)]
            if at:
                sections[at[0]] = section
            else:  # before the parts that other scripts measure
                place = [i for i, old in enumerate(sections) if old.startswith("## The default surface beside")]
                sections.insert(place[0] if place else len(sections), section)
        for row in self.promises:
            for i, section in enumerate(sections):
                if section.startswith("## Targets and results"):
                    line, lines = "| " + " | ".join(row) + " |", section.rstrip().split("\n")
                    at = next((n for n, there in enumerate(lines) if there.startswith(f"| {row[0]} |")), len(lines))
                    lines[at:at + 1] = [line]
                    sections[i] = "\n".join(lines) + "\n\n"
        return "".join(sections).rstrip() + "\n"

    def include(self, name):
        path = HERE / name
        if path.exists():
            self.write(path.read_text().strip())

    def page(self):
        wanted = self.arguments.only.split(",") if self.arguments.only else None
        for name, section in (("density", self.density), ("mesh", self.mesh), ("improvement", self.improvement),
                              ("chain", self.whole_chain), ("complexes", self.complexes),
                              ("surface", self.surface)):
            if not wanted or name in wanted:
                self.say(name)
                before = len(self.text)
                try:
                    section()
                except Exception as problem:  # an hour's other sections are kept
                    traceback.print_exc()
                    del self.text[before:]
                    self.skipped.append(f"the section of {name}: {problem}")
        body, self.text = self.text, []
        if self.arguments.update:
            return self.updated(body)
        self.write("# Benchmarks", "Made by `tests/bench/benchmarks.py" + (" --quick" if self.quick else "")
                   + "`: do not edit. Target beside result, the paper's figures and other programs beside both. What the "
                   "contracts I1 to I12 are, units and measures: [conventions.md](conventions.md).",
                   f"**Machine.** {self.machine()}", "Times are " + ("of one run" if self.quick else f"medians of three runs, those over {LONG} s of one")
                   + (", on a shared machine: one thread, and seconds of the clock times the share of a processor "
                      "that the program had. A quiet machine is faster" if self.arguments.shared else "")
                   + "; ratios of times say more than times. Any number of threads gives the same bytes.",
                   "## Targets and results", table(("", "target", "result", "met"), self.promises))
        self.text += body
        self.include("other_surfaces.md")
        if self.quick:
            self.include("set_figures.md")
        self.include("peer_figures.md")
        self.include("gpu_figures.md")
        self.include("coarsening_figures.md")
        self.include("plan_figures.md")
        self.include("limits.md")
        if self.skipped:
            self.write("## Not measured in this run", "\n".join(f"- {s}" for s in sorted(set(self.skipped))))
        return "\n\n".join(self.text) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--shared", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--note", default="")
    parser.add_argument("-o", dest="output", type=pathlib.Path, default=ROOT / "docs" / "benchmarks.md")
    arguments = parser.parse_args()
    if not arguments.data.is_dir():
        print(f"{arguments.data}: no such folder: only tests/data is measured", file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        text = Page(arguments, folder).page()
    arguments.output.write_text(text)
    print(f"{arguments.output}: {len(text.splitlines())} lines", file=sys.stderr)


if __name__ == "__main__":
    main()
