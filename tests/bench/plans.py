#!/usr/bin/env python3
"""plans.py BIN DATA OUT.md: the plans of the programs beside what the runs took, one thread, as a table.

DATA holds typical/, paper/ and large/. --spacing H (1 by default), --region R, --most N: tetsmooth up to N elements.
"""
import argparse, glob, json, os, subprocess, tempfile


def run(command):
    """Processor seconds and peak memory in bytes; None where it fails."""
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    return (usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024) if status == 0 else None


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("bin"), p.add_argument("data"), p.add_argument("out")
    p.add_argument("--spacing", default="1"), p.add_argument("--region", default="both")
    p.add_argument("--most", type=float, default=3e6)
    o = p.parse_args()
    tool = lambda name: os.path.join(o.bin, name)
    work = tempfile.mkdtemp()
    at = lambda name: os.path.join(work, name)
    read = lambda name: json.load(open(at(name)))
    rows = []
    files = [f for folder in ("typical", "paper", "large") for f in glob.glob(os.path.join(o.data, folder, "*"))]
    seen = set()
    for file in sorted(files, key=os.path.getsize):
        name = os.path.basename(file).split(".")[0]
        if name in seen or run([tool("pdb2hier"), "-q", file, "-o", at("a.hier")]) is None:
            continue
        seen.add(name)
        grid = ["--spacing", o.spacing, at("a.hier")]
        planning = run([tool("hier2density"), "-t", "1", "--plan", "--json"] + grid + ["-o", at("p.json")])
        took = {"hier2density": run([tool("hier2density"), "-q", "-t", "1"] + grid + ["-o", at("a.vdb")])}
        run([tool("density2tet"), "-t", "1", "--plan", "--json", "--region", o.region, at("a.vdb"), "-o", at("m.json")])
        took["density2tet"] = run([tool("density2tet"), "-q", "-t", "1", "--region", o.region, at("a.vdb"), "-o",
                                   at("a.tet.vtu"), "--report", at("r.json")])
        if None in took.values() or planning is None:
            continue
        plan, mesh, elements = read("p.json"), read("m.json"), read("r.json")["counts"]["tetrahedra"]
        planned = {"hier2density": plan, "density2tet": mesh, "tetsmooth": mesh["tetsmooth"]}
        if elements <= o.most:
            took["tetsmooth"] = run([tool("tetsmooth"), "-q", "-t", "1", "--density", at("a.vdb"), at("a.tet.vtu"), "-o",
                                     at("a.vtu")])
        cells = [name, "{:,}".format(plan["atoms"]), "{:,}".format(elements),
                 "%.2f" % (plan["density2tet"][o.region]["elements"] / elements), "%.2f" % (mesh["elements"] / elements)]
        for k, unit in ((1, "memory_bytes"), (0, "seconds")):
            cells += ["%.2f" % (planned[t][unit] / took[t][k]) if took.get(t) else "–" for t in planned]
        rows.append(cells + ["%.1f" % planning[0]])
        print(rows[-1], flush=True)
    head = ["structure", "atoms", "elements", "planned from atoms", "from the grid", "memory: hier2density", "density2tet",
            "tetsmooth", "seconds: hier2density", "density2tet", "tetsmooth", "seconds to plan"]
    with open(o.out, "w") as out:
        for row in [head, ["---"] * len(head)] + rows:
            out.write("| " + " | ".join(row) + " |\n")


if __name__ == "__main__":
    main()
