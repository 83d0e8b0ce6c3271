#!/usr/bin/env python3
"""Table 3 of Liao et al. 2013: density, mesh and quality in seconds, and what the mesh is like, the paper's beside.

    mesh_tables.py BIN DATA [--threads N] [--modes seq,omp] [--grid 513] [--only 1SU4]

BIN: folder of the tools. DATA: folder with paper/1su4.pdb.gz, paper/1htq_24chains_model1_derived.pdb.gz and
large/4v6x.cif.gz. Seconds are those of phase `density`, of all phases of density2tet but reading and writing, and of
tetsmooth's phases `adjacency`, `target`, `improve` and `result`. Processor: seconds of user and system of the three
whole programs, reading and writing included, for machines that are busy with other work. The region is both; everything
else as by default.
Turned: surface triangles in 1,000 whose normal is more than 45 degrees from the field's. Off: surface points in 1,000
further than a fiftieth of a spacing from the isosurface.
The paper: Xeon E5-1620; its SERCA pump is 1SU4 in a membrane (80,157 atoms), its 1HTQ has ten models summed."""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile

STRUCTURES = {  # ours: file, paper's name, sequential DM, MG, QI, 8-core DM, MG, QI, V#, E#, ratio, Joe-Liu, dihedral
    "1SU4": ("paper/1su4.pdb.gz", "SERCA", (165.1, 12.8, 163.5), (38.4, 6.3, 37.7), 190356, 946273, 10.23, 0.14,
             (15.01, 167.25)),
    "1HTQ": ("paper/1htq_24chains_model1_derived.pdb.gz", "1HTQ", (6494.7, 13.1, 250.6), (1589.4, 6.7, 68.3), 399994,
             1989245, 9.56, 0.10, (15.03, 167.46)),
    "4V6X": ("large/4v6x.cif.gz", None, None, None, None, None, None, None, None),
}


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--modes", default="seq,omp")
    parser.add_argument("--grid", default="513")
    parser.add_argument("--only", choices=STRUCTURES)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        def tool(name, mode, *options):
            report = f"{folder}/{name}.json"
            threads = [] if mode == "seq" else ["-t", str(arguments.threads)]
            subprocess.run([arguments.bin / name, "-q", "--mode", mode, *threads, "--report", report, *options],
                           check=True)
            text = json.load(open(report))
            return {p["name"]: p["seconds"] for p in text["phases"]}, text["counts"]

        print(f"{'':6} {'':5} {'density':>9} {'mesh':>8} {'quality':>8} {'total':>8} {'processor':>9} "
              f"{'V#':>9} {'E#':>10} {'ratio':>6} {'Joe-Liu':>7} {'dihedral':>16} {'<25 or >140':>11} {'turned':>6} {'off':>6}")
        for name, (file, theirs, sequential, eight, points, elements, ratio, joe_liu, angle) in STRUCTURES.items():
            if arguments.only not in (None, name):
                continue
            subprocess.run([arguments.bin / "pdb2hier", "-q", "-o", f"{folder}/hier", arguments.data / file], check=True)
            for mode in arguments.modes.split(","):
                used = processor_seconds()
                density, _ = tool("hier2density", mode, "--grid", arguments.grid, f"{folder}/hier", "-o", f"{folder}/vdb")
                mesh, _ = tool("density2tet", mode, "--region", "both", f"{folder}/vdb", "-o", f"{folder}/tet")
                smooth, counts = tool("tetsmooth", mode, "--density", f"{folder}/vdb", f"{folder}/tet", "-o",
                                      f"{folder}/out")
                used = processor_seconds() - used
                text = subprocess.run([arguments.bin / "tetstat", "-q", "--json", f"{folder}/out"],
                                      stdout=subprocess.PIPE).stdout
                quality = json.loads(text)["quality"]
                quality = quality.get("all", quality)
                seconds = [density["density"], sum(s for n, s in mesh.items() if n not in ("read", "write")),
                           sum(smooth.get(n, 0) for n in ("adjacency", "target", "improve", "result"))]
                after, on = counts["quality_after"], counts["surface"]
                print(f"{name:6} {mode:5} {seconds[0]:9.2f} {seconds[1]:8.2f} {seconds[2]:8.2f} {sum(seconds):8.2f} "
                      f"{used:9.2f} {counts['points']:9} {counts['elements']:10} {quality['edge_ratio']['max']:6.2f} "
                      f"{quality['joe_liu_q']['min']:7.3f} {after['min_dihedral']:7.2f} {after['max_dihedral']:8.2f} "
                      f"{after['below_25'] + after['above_140']:11} {1e3 * on['turned_45'] / on['triangles']:6.2f} "
                      f"{1e3 * on['points_off'] / on['points']:6.2f}", flush=True)
            for mode, them in (("CS", sequential), ("C-8", eight)):
                if them:
                    print(f"{theirs:>6} {mode:5} {them[0]:9.1f} {them[1]:8.1f} {them[2]:8.1f} {sum(them):8.1f} {'':9} "
                          f"{points:9} {elements:10} {ratio:6.2f} {joe_liu:7.2f} {angle[0]:7.2f} {angle[1]:8.2f}")


if __name__ == "__main__":
    main()
