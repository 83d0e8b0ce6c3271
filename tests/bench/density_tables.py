#!/usr/bin/env python3
"""Tables 1 and 2 of Liao et al. 2013 by hier2density, the paper's own seconds beside.

    density_tables.py BIN DATA [--threads N] [--all-up-to ATOMS]

BIN: folder of pdb2hier and hier2density. DATA: folder with paper/ (1bor.pqr, 1neq.pqr, ...). Table 2 runs at 0.25 Å,
margin 4 Å, P_R = 0.5, P_C = 1; T0 and NS sum every atom at every point, so they run only on small structures. Seconds
are those of phase `density`. The paper used 8 threads of a 4-core Xeon E5-1620."""
import argparse
import json
import pathlib
import subprocess
import tempfile

STRUCTURES = {  # file: paper's name, T0, NS, KD, BVH, NS+KD, GPU
    "1bor.pqr": ("1BOR", 3.89, 0.76, 1.81, 2.08, 0.65, 0.20),
    "1neq.pqr": ("1NEQ", 8.83, 1.08, 2.48, 2.73, 0.93, 0.25),
    "1a63.pqr.gz": ("1A63", 21.60, 2.56, 5.61, 6.57, 1.50, 0.33),
    "1a7m.pqr.gz": ("1A7M", 34.93, 3.37, 8.91, 9.87, 2.03, 0.51),
    "1beb.pdb.gz": ("1BEB (fewer atoms)", 107.38, 8.85, 18.77, 20.65, 2.99, 0.92),
    "1a8r_for_1gtp.cif.gz": ("1GTP (1A8R here)", 15496.44, 820.79, 2060.70, 501.83, 162.01, 11.33),
}
VARIANTS = {
    "T0": ("full", "all"),
    "NS": ("neighbor", "all"),
    "KD": ("full", "kdtree"),
    "BVH": ("full", "bvh"),
    "NS+KD": ("neighbor", "kdtree"),
    "default": ("neighbor", "bvh"),
}


def run(arguments, hier, options):
    with tempfile.NamedTemporaryFile() as report:
        subprocess.run([f"{arguments.bin}/hier2density", "-q", "-t", str(arguments.threads), *options, "--report",
                        report.name, "-o", "/dev/null", hier], check=True)
        text = json.load(open(report.name))
    seconds = {p["name"]: p["seconds"] for p in text["phases"]}
    return seconds["density"], text["counts"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--all-up-to", type=int, default=1000, help="most atoms for T0 and NS")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        print("Table 2: seconds for the density, ours / the paper's")
        print(f"{'':18} {'atoms':>7} {'grid':>15} " + " ".join(f"{v:>16}" for v in VARIANTS) + "        GPU")
        hiers = {}
        for file, (name, *paper) in STRUCTURES.items():
            hier = f"{folder}/{file}.hier"
            subprocess.run([f"{arguments.bin}/pdb2hier", "-q", "-r", "* P_R=0.5 P_C=1", "-o", hier,
                            arguments.data / "paper" / file], check=True)
            hiers[name] = hier
            atoms = sum(line.split()[:1] == ["atom"] for line in open(hier))
            cells = []
            for (variant, (search, how)), theirs in zip(VARIANTS.items(), [*paper[:5], None]):
                if how == "all" and atoms > arguments.all_up_to:
                    cells.append(f"- / {theirs:g}")
                    continue
                seconds, counts = run(arguments, hier, ["--spacing", "0.25", "--margin", "4", "--search", search,
                                                        "--atoms", how])
                cells.append(f"{seconds:.3f}" + (f" / {theirs:g}" if theirs else ""))
            grid = "×".join(str(n) for n in counts["grid_points"])
            print(f"{name:18} {atoms:7} {grid:>15} " + " ".join(f"{c:>16}" for c in cells) + f"  - / {paper[5]:g}")
        print("\nTable 1: analyzed points k_A on 513 points (blocks of 8³), active points, both as parts of the grid;")
        print("the paper's 2KFX (not here): 0.026, 0.048, 0.092, 0.12")
        for name, hier in ((n, h) for n, h in hiers.items() if n.startswith(("1A7M", "1GTP"))):
            for band in ("0.9,1.1", "0.6,1.4", "0.3,1.7", "0.1,2.0"):
                seconds, counts = run(arguments, hier, ["--grid", "513", "--band", band])
                n = counts["grid_points"]
                active = counts["active_points"] / (n[0] * n[1] * n[2])
                print(f"{name:18} band {band:8} k_A {counts['k_A']:.3f}  active {active:.3f}  {seconds:.3f} s")


main()
