#!/usr/bin/env python3
"""sizes.py BIN DATA [PAGE] [--most N]: the first table of docs/guide.md: spacing beside elements, volume, area, seconds and memory.

BIN: folder of the programs. DATA: folder of public structures (MOLMESH_TEST_DATA) with typical/ and large/. The table goes
to standard output; where PAGE is given (docs/guide.md) it replaces the table there that begins with the same line. Seconds
are those of one processor, for the four programs; memory is the largest of theirs. Where hier2density plans more than N
elements on both sides (12 million by default), the row is that plan, marked ≈.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from chain import Chain

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STRUCTURES = ("typical/1ubq.pdb", "1UBQ"), ("tests/data/1tii.pdb", "1TII"), ("large/1aon.pdb.gz", "1AON")
REGIONS = "interior", "both"
SPACINGS = 3, 2, 1, 0.5
HEAD = ["structure", "spacing", "interior", "both sides", "surface triangles", "volume, Å³", "area, Å²",
        "seconds: interior", "both sides", "memory, MB", "file, MB"]


def seconds(x):
    return f"{x:.1f}" if x < 9.95 else f"{x:,.0f}"


def planned(plan, name, spacing):
    return [name, f"{spacing} Å, planned", *(f"≈ {round(plan['tetsmooth'][r]['elements'], -5):,}" for r in REGIONS), "", "", "", "", "",
            f"≈ {plan['tetsmooth']['both']['memory_bytes'] / 1e6:,.0f}", ""]


def row(chain, name, spacing, atoms, most):
    plan = json.loads(subprocess.run([chain.programs / "hier2density", "--plan", "--json", "--max-mem", "none", "--spacing", str(spacing),
                                      chain.path("hier")], check=True, stdout=subprocess.PIPE).stdout)
    if plan["tetsmooth"]["both"]["elements"] > most:
        return planned(plan, name, spacing)
    density = chain.density("--spacing", spacing)
    elements, took, peak = [], [], density["peak_rss_bytes"]
    for region in REGIONS:
        mesh = chain.mesh("--region", region)
        improvement = chain.improve()
        elements.append(improvement["counts"]["elements"])
        took.append(atoms["processor"] + density["processor"] + mesh["processor"] + improvement["processor"])
        peak = max(peak, mesh["peak_rss_bytes"], improvement["peak_rss_bytes"])
        surface = chain.stat("out")["surface"] if region == "interior" else surface
    return [name, f"{spacing} Å", *(f"{n:,}" for n in elements), f"{surface['triangles']:,}", f"{surface['volume']:,.0f}",
            f"{surface['area']:,.0f}", *map(seconds, took), f"{peak / 1e6:,.0f}",
            f"{chain.path('out').stat().st_size / 1e6:,.0f}"]


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("bin", type=pathlib.Path), p.add_argument("data", type=pathlib.Path), p.add_argument("page", nargs="?")
    p.add_argument("--most", type=float, default=1.2e7)
    o = p.parse_args()
    lines = ["| " + " | ".join(HEAD) + " |", "|---" * len(HEAD) + "|"]
    with tempfile.TemporaryDirectory() as folder:
        chain = Chain(o.bin, folder, 1)
        for file, name in STRUCTURES:
            atoms = chain.hierarchy(ROOT / file if file.startswith("tests/") else o.data / file)
            for spacing in SPACINGS:
                lines.append("| " + " | ".join(row(chain, f"{name}, {atoms['counts']['atoms']:,} atoms", spacing, atoms, o.most)) + " |")
                print(lines[-1], file=sys.stderr, flush=True)
    print(*lines, sep="\n")
    if o.page:
        page = pathlib.Path(o.page)
        text, found = re.subn(re.escape(lines[0]) + r"\n(\|.*\n)+", "\n".join(lines) + "\n", page.read_text())
        if found != 1:
            sys.exit(f"{page}: found {found} tables that begin '{lines[0]}', expected one")
        page.write_text(text)


if __name__ == "__main__":
    main()
