#!/usr/bin/env python3
"""plans.py BIN DATA OUT.md: the plans of the programs beside what the runs took, one thread, as a table.

DATA holds typical/, paper/ and large/. Each program's plan is its own, of what it reads. --spacing H (1 by default),
--region R, --most N: meshes planned larger are left out; --improve N: tetsmooth up to N elements; --raw FILE: all figures, a line of JSON a structure.

Memory is that of the run reports. Seconds are those of the processor, beside a small run before and after each run, since
machines do not keep their speed: the median of three such ratios for runs up to 3 s, times the median of the small runs.
The plans are those of a processor of speed 1; what molmesh-array --measure-speed would measure with the structures of typical/
(those that all three programs are run on), the geometric mean of planned over true, is taken from the same runs and divides them.
"""
import argparse, glob, json, os, statistics, subprocess, tempfile


def once(command):
    """Processor seconds; None where it fails."""
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    return usage.ru_utime + usage.ru_stime if status == 0 else None


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("bin"), p.add_argument("data"), p.add_argument("out")
    p.add_argument("--spacing", default="1"), p.add_argument("--region", default="both")
    p.add_argument("--most", type=float, default=6e6), p.add_argument("--improve", type=float, default=1.5e6)
    p.add_argument("--raw", default=os.devnull)
    o = p.parse_args()
    tool = lambda name: [os.path.join(o.bin, name), "-q", "-t", "1"]
    work = tempfile.mkdtemp()
    at = lambda name: os.path.join(work, name)
    read = lambda name: json.load(open(at(name)))
    reference, small_runs = [], []

    def small():
        small_runs.append(once(reference))
        return small_runs[-1]

    def run(command, output):
        """(bytes, seconds over those of the small run), None where it fails."""
        command, runs = command + ["-o", at(output), "--report", at("r.json")], []
        while len(runs) < (3 if not runs or took < 3 else 1):
            before, took = small(), once(command)
            if took is None:
                return None
            runs.append((read("r.json")["peak_rss_bytes"], 2 * took / (before + small())))
        return [statistics.median(figures) for figures in zip(*runs)]

    rows, seen = [], set()
    files = [f for folder in ("typical", "paper", "large") for f in glob.glob(os.path.join(o.data, folder, "*"))]
    files.sort(key=os.path.getsize)
    made = [files[0]] + [at("ref" + ending) for ending in (".hier", ".vdb", ".vtu")]
    for name, before, after in zip(["pdb2hier", "hier2density", "density2tet"], made, made[1:]):
        once(tool(name) + [before, "-o", after])
    os.environ["MOLMESH_SPEED"] = "1"
    reference += tool("tetsmooth") + ["--effort", "fast", "--density", at("ref.vdb"), at("ref.vtu"), "-o", os.devnull]
    for file in files:
        name = os.path.basename(file).split(".")[0]
        if name in seen or once(tool("pdb2hier") + [file, "-o", at("a.hier")]) is None:
            continue
        seen.add(name)
        grid = ["--spacing", o.spacing, at("a.hier")]
        planning = once(tool("hier2density") + ["--plan", "--json"] + grid + ["-o", at("p.json")])
        if planning is None or read("p.json")["density2tet"][o.region]["elements"] > o.most:
            continue
        plan, took = read("p.json"), {}
        took["hier2density"] = run(tool("hier2density") + grid, "a.vdb")
        mesh_of = tool("density2tet") + ["--region", o.region, at("a.vdb")]
        once(mesh_of + ["--plan", "--json", "-o", at("m.json")])
        took["density2tet"] = run(mesh_of, "a.tet.vtu")
        if None in took.values():
            continue
        mesh, elements = read("m.json"), read("r.json")["counts"]["tetrahedra"]
        planned = {"hier2density": plan, "density2tet": mesh}
        for effort in ["good", "fast", "best"] if elements <= o.improve / 8 else ["good"] if elements <= o.improve else []:
            improve = tool("tetsmooth") + ["--effort", effort, "--density", at("a.vdb"), at("a.tet.vtu")]
            once(improve + ["--plan", "--json", "-o", at("s.json")])
            key = "tetsmooth" if effort == "good" else "--effort " + effort
            planned[key] = read("s.json")
            took[key] = run(improve, "a.vtu")
        rows.append({"name": name, "folder": os.path.basename(os.path.dirname(file)), "atoms": plan["atoms"], "elements": elements,
                     "planning": planning, "took": took,
                     "from_atoms": plan["density2tet"][o.region]["elements"], "from_grid": mesh["elements"],
                     "planned": {k: (v["memory_bytes"], v["seconds"]) for k, v in planned.items()}})
        print(json.dumps(rows[-1]), file=open(o.raw, "a"))
        print(name, elements, took, flush=True)

    programs = ["hier2density", "density2tet", "tetsmooth", "--effort fast", "--effort best"]
    second = statistics.median(small_runs)
    ratio = lambda r, key: r["planned"][key][1] / (r["took"][key][1] * second)
    calibrating = [r for r in rows if r["folder"] == "typical" and r["took"].get("tetsmooth")]
    speeds = [statistics.geometric_mean(ratio(r, key) for r in calibrating) for key in programs[:3]]
    speed_of = dict(zip(programs, speeds + 2 * speeds[2:]))
    print("MOLMESH_SPEED=" + ",".join("%.3g" % s for s in speeds))
    head = ["structure", "atoms", "elements", "elements, from atoms", "from the grid"]
    head += ["memory: " + programs[0]] + programs[1:] + ["seconds: " + programs[0]] + programs[1:] + ["seconds to plan"]
    with open(o.out, "w") as out:
        for row in [head, ["---"] * len(head)]:
            out.write("| " + " | ".join(row) + " |\n")
        for r in sorted(rows, key=lambda r: r["elements"]):
            cells = [r["name"], "{:,}".format(r["atoms"]), "{:,}".format(r["elements"])]
            cells += ["%.2f" % (r[k] / r["elements"]) for k in ("from_atoms", "from_grid")]
            of = lambda key, figure: "%.2f" % figure(key) if r["took"].get(key) else "–"
            cells += [of(k, lambda k: r["planned"][k][0] / r["took"][k][0]) for k in programs]
            cells += [of(k, lambda k: ratio(r, k) / speed_of[k]) for k in programs]
            out.write("| " + " | ".join(cells + ["%.1f" % r["planning"]]) + " |\n")


if __name__ == "__main__":
    main()
