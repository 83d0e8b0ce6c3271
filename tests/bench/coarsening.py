#!/usr/bin/env python3
"""coarsening.py BIN DATA [PAGE]: meshes with and without tetsmooth --coarsen: elements, quality, surface, and what a solver finds.

BIN: folder of the programs. DATA: folder of public structures (MOLMESH_TEST_DATA) with paper/ and pqr/. The section goes to
standard output, and to PAGE where it is given (tests/bench/coarsening_figures.md). Energies and rates need FreeFEM. One thread.
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

from chain import Chain

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NO_LEVELS = ("--levels", "none")
# Name, structure (in DATA, or of the repository), pdb2hier's options, spacing, density2tet's options, solver's script.
ROWS = (("Born's ion, 0.25 Å, both", "tests/data/ion.pqr", NO_LEVELS, 0.25, ("--region", "both", "--box", "10"), ("born", 1, 3)),
        ("1TII, 1 Å, both", "tests/data/1tii.pdb", (), 1, ("--region", "both"), None),
        ("1SU4, 1 Å, both", "paper/1su4.pdb.gz", (), 1, ("--region", "both"), None),
        ("mAChE, 1 Å, exterior", "pqr/misc__mache.pqr.gz", (), 1, ("--region", "exterior", "--box", "3", "--cavities", "fill"),
         ("diffusion", 11)))
HEAD = ("mesh", "", "elements", "of those", "angles", "Q ≥", "edge ratio ≤", "surface triangles", "points off", "centroids over 0.25 h",
        "turned over 45°", "volume missing", "processor, s", "solution")


# Measured once, by hand.
BESIDES = """
- *Rate.* mAChE's exterior by `--adapt 0.05`, 561,353 elements as they are, has the rate 1.51258e12: the mesh above is off that by -0.03 %, the smaller
  one by 0.02 %.
- *Energy.* 1CBN (PQR) at 0.7 Å, both, `make -f Makefile.pipeline SURFACE=gaussian X.energy`: -618.19 kJ/mol by 144,258 elements, -618.00 by 43,106.
- *Exteriors* at 1 Å: 1TII from 445,320 to 159,661, 1SU4 from 740,251 to 265,349, 25.12° to 139.87°. At 2 Å 1TII goes to 0.57 inside and 0.42 outside: its
  atoms are as small as the cells there.
- *Small ones.* 1CRN, 1L2Y, 1BNA, 1UBQ at 0.7 and 1.5 Å, each region: 0.18 to 0.50 of the elements, all valid, 25.1° to 140°.
- *Gradation.* Target sizes are 1.5 apart at most, but the mean edges at the ends of an edge are further apart for 18.5 % of the edges of the ion, 15.5 % of mAChE
  and 15.6 % of 1TII; in the meshes as they are, for 18.6, 17.7 and 15.8 %.
"""


def solution(chain, solver):
    if not solver:
        return ""
    script, *arguments = solver
    subprocess.run([chain.programs / "tetconvert", "-q", chain.path("out"), "-o", chain.path("solve.mesh")], check=True)
    done = subprocess.run([ROOT / "tests/solve/freefem.sh", script, chain.path("solve.mesh"), *map(str, arguments)], stdout=subprocess.PIPE, text=True)
    if done.returncode == 77:
        return "not solved"
    found = re.search(r"^energy (\S+) .*off by (\S+) %", done.stdout, re.M)
    if found:
        return f"{float(found[1]):.2f} kJ/mol, off by {float(found[2]):.2f} %"
    rate = re.search(r"^rate (\S+)", done.stdout, re.M)
    return f"{float(rate[1]):.5g} /(M min)"


def row(chain, name, improvement, before, solver):
    counts, mesh = improvement["counts"], chain.stat("out")
    surface, quality = counts["surface"], mesh["quality"]
    assert mesh["valid"], name
    return [f"{counts['elements']:,}", f"{counts['elements'] / before:.2f}" if before else "",
            f"{quality['dihedral']['min']:.2f}° to {quality['dihedral']['max']:.2f}°", f"{quality['joe_liu_q']['min']:.3f}",
            f"{quality['edge_ratio']['max']:.2f}", f"{surface['triangles']:,}", str(surface["points_off"]), str(surface["centroids_off"]),
            str(surface["turned_45"]), f"{100 * surface['volume_missing'] / mesh['surface']['volume']:.2f} %",
            f"{improvement['processor']:.1f}", solution(chain, solver)]


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("bin", type=pathlib.Path), p.add_argument("data", type=pathlib.Path), p.add_argument("page", nargs="?", type=pathlib.Path)
    o = p.parse_args()
    lines = ["| " + " | ".join(HEAD) + " |", "|---" * len(HEAD) + "|"]
    for name, structure, hier, spacing, mesh, solver in ROWS:
        path = ROOT / structure if structure.startswith("tests/") else o.data / structure
        with tempfile.TemporaryDirectory() as folder:
            chain = Chain(o.bin, folder, 1)
            chain.hierarchy(path, *hier)
            chain.density("--spacing", spacing)
            chain.mesh(*mesh)
            before = 0
            for title, options in (("as it is", ()), ("`--coarsen`", ("--coarsen",))):
                improvement = chain.improve(*options)
                lines.append("| " + " | ".join([name, title, *row(chain, name, improvement, before, solver)]) + " |")
                print(lines[-1], flush=True)
                name, before = "", improvement["counts"]["elements"]
    text = "\n".join(("## Smaller meshes: tetsmooth --coarsen\n",
                      "*`tests/bench/coarsening_figures.md` holds this section; `tests/bench/coarsening.py` makes it.* Volume: what the isosurface",
                      "encloses beyond the mesh. Points off are over 0.02 h from the isosurface, or over 0.0625 h where `--coarsen` puts them further out. Solutions by",
                      "FreeFEM with quadratic elements: Born's energy beside the exact one, and the rate of diffusion to the whole surface.\n",
                      *lines)) + "\n" + BESIDES
    if o.page:
        o.page.write_text(text)


if __name__ == "__main__":
    main()
