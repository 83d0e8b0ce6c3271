#!/usr/bin/env python3
"""The structures of molecular_surface.py, as PQR files with all their hydrogens, with polar ones and with none.

    molecular_set.py DATA OUT [--pdb2pqr PROGRAM]

DATA holds pqr/ and typical/. Files of pqr/ are taken as they are; pdb2pqr (Debian's package) makes the others, with the radii and charges of AMBER,
CHARMM or PARSE. From these come X-polar, without the hydrogens on carbons, and X-heavy, without any: the charge of a hydrogen goes to the
nearest heavy atom of its residue. One file name a line on standard output."""
import argparse
import gzip
import math
import pathlib
import subprocess
import tempfile

AS_THEY_ARE = ["bem__test_proteins__2erl", "bem__test_proteins__1cbn", "misc__fas2", "bem__test_proteins__1a2s", "pbsam-barn_bars__barstar",
               "pbsam-barn_bars__barnase", "FKBP__1d7h-dmso-complex", "helix__Membrane-helix-0", "born__ion", "ionize__proton", "tabipb_1a63"]
MADE = [("1l2y", "AMBER"), ("2koc", "AMBER"), ("1bna", "AMBER"), ("1bna", "CHARMM"), ("1ubq", "AMBER"), ("1crn", "AMBER"), ("1aki", "AMBER"), ("1l2y", "PARSE"),
        ("2koc", "PARSE"), ("1crn", "PARSE"), ("1blu", "PARSE"), ("1ubq", "PARSE")]
HEAVY = ["1l2y-AMBER", "2koc-AMBER", "1crn-AMBER", "misc__fas2", "1bna-AMBER", "1ubq-AMBER", "bem__test_proteins__1a2s", "1aki-AMBER"]
POLAR = ["1ubq-AMBER", "1l2y-AMBER"]


def opened(file):
    return (gzip.open if file.suffix == ".gz" else open)(file, "rt")


def is_hydrogen(words):
    return words[2].lstrip("0123456789")[:1] in ("H", "D") and float(words[-1]) < 1.65


def thinned(lines, of_carbons_alone):
    """Without hydrogens (on carbons), whose charges go to the nearest heavy atom of the residue."""
    atoms = [line.split() for line in lines if line.startswith(("ATOM", "HETATM"))]
    place = [tuple(map(float, w[-5:-2])) for w in atoms]
    charge, gone = [float(w[-2]) for w in atoms], [False] * len(atoms)
    residue = [tuple(w[3:-5]) for w in atoms]
    members = {}
    for i, r in enumerate(residue):
        members.setdefault(r, []).append(i)
    for i, w in enumerate(atoms):
        if not is_hydrogen(w):
            continue
        heavy = min((j for j in members[residue[i]] if not is_hydrogen(atoms[j])), key=lambda j: math.dist(place[i], place[j]))
        if of_carbons_alone and not atoms[heavy][2].startswith("C"):
            continue
        charge[heavy] += charge[i]
        gone[i] = True
    return [" ".join([*w[:-2], f"{q:.6f}", w[-1]]) + "\n" for w, q, g in zip(atoms, charge, gone) if not g]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--pdb2pqr", default="pdb2pqr30")
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    for name in AS_THEY_ARE:
        with opened(next((o.data / "pqr").glob(name + ".pqr*"))) as file:
            (o.out / f"{name}.pqr").write_text("".join(l for l in file if l.startswith(("ATOM", "HETATM"))))
    for name, field in MADE:
        with tempfile.TemporaryDirectory() as scratch:
            source = pathlib.Path(scratch) / "s.pdb"
            with opened(min((o.data / "typical").glob(name + ".pdb*"))) as file:
                source.write_text(file.read().split("ENDMDL")[0])
            subprocess.run([o.pdb2pqr, "--ff=" + field, "--whitespace", "--drop-water", source, o.out / f"{name}-{field}.pqr"], check=True,
                           capture_output=True)
    for names, kind, of_carbons_alone in ((POLAR, "polar", True), (HEAVY, "heavy", False)):
        for name in names:
            with open(o.out / f"{name}.pqr") as file:
                (o.out / f"{name}-{kind}.pqr").write_text("".join(thinned(file, of_carbons_alone)))
    barnase, barstar = ((o.out / f"pbsam-barn_bars__{x}.pqr").read_text() for x in ("barnase", "barstar"))
    (o.out / "barnase-barstar.pqr").write_text(barnase + barstar)
    print(*sorted(o.out.glob("*.pqr"), key=lambda f: len(f.read_text())), sep="\n")


if __name__ == "__main__":
    main()
