"""chain.py: the programs run one after the other, and what is measured of them. A module of the scripts beside it."""
import json
import pathlib
import random
import resource
import subprocess
import time


NO_DEVICE = 6  # what --mode cuda ends with where there is no GPU


class ToolError(Exception):
    """A program ended with another status than 0: its name and what it wrote to standard error."""

    def __init__(self, text, status):
        super().__init__(text)
        self.status = status


class Chain:
    """The programs in one folder, their files in another. threads: of those that have a choice. shared: other work goes on
    beside this one; one thread unless more are asked for, and every second of one thread counts as the share of a processor that the run
    had, of several as the share in which the first did not wait for a processor."""

    def __init__(self, programs, folder, threads, shared=False):
        self.programs, self.folder, self.shared = pathlib.Path(programs), pathlib.Path(folder), shared
        self.threads = "1" if shared else str(threads)

    def path(self, name):
        return self.folder / name

    def run(self, program, *options, threads=None, mode="omp", good=(0,)):
        """The run report, where the status is a good one; `seconds` of each phase, `wall` of all, `work` without reading and writing, `processor`: user and
        system."""
        report, threads = self.path(f"{program}.json"), int(threads or self.threads)
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.Popen([self.programs / program, "-q", "--mode", mode, "-t", str(threads), "--report", report,
                                 *map(str, options)], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        waited = self.waiting(done) if self.shared and threads > 1 else 0
        _, said = done.communicate()
        after, elapsed = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - start
        if done.returncode not in good:
            raise ToolError(f"{program}: status {done.returncode}: {said.strip()}", done.returncode)
        text = json.loads(report.read_text())
        text["processor"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        share = 1 - waited / elapsed if threads > 1 or not self.shared else min(1, text["processor"] / elapsed)
        text["seconds"] = {p["name"]: p["seconds"] * share for p in text["phases"]}
        text["wall"] = sum(text["seconds"].values())
        text["work"] = sum(s for name, s in text["seconds"].items() if name not in ("read", "write"))
        return text

    @staticmethod
    def waiting(process):
        """Until it ends: the seconds in which its first thread could have run, but had no processor."""
        seconds = 0
        while True:
            try:
                seconds = int(pathlib.Path(f"/proc/{process.pid}/schedstat").read_text().split()[1]) / 1e9
                process.wait(0.02)
                return seconds
            except subprocess.TimeoutExpired:
                pass

    def hierarchy(self, structure, *options):
        return self.run("pdb2hier", *options, structure, "-o", self.path("hier"))

    def density(self, *options, threads=None, mode="omp", output=None):
        return self.run("hier2density", *options, self.path("hier"), "-o", output or self.path("vdb"), threads=threads, mode=mode)

    def mesh(self, *options, threads=None, mode="omp", output=None):
        return self.run("density2tet", *options, self.path("vdb"), "-o", output or self.path("tet"), threads=threads, mode=mode)

    def improve(self, *options, threads=None, mode="omp", good=(0,)):
        return self.run("tetsmooth", "--density", self.path("vdb"), *options, self.path("tet"), "-o", self.path("out"),
                        threads=threads, mode=mode, good=good)

    def stat(self, name):
        """tetstat's answer; a mesh that is not valid has status 5 and an answer too."""
        done = subprocess.run([self.programs / "tetstat", "-q", "--json", "--crossings", self.path(name)],
                              stdout=subprocess.PIPE)
        return json.loads(done.stdout)

    def cuts(self, count):
        """Boxes of a fifth to the whole of the surface's extents, their middles in it; the same ones every time."""
        self.mesh("--region", "interior")
        box = self.stat("tet")["box"]
        numbers = random.Random(count)
        boxes = []
        for _ in range(count):
            ends = [[], []]
            for low, high in zip(box["low"], box["high"]):
                middle = numbers.uniform(low, high)
                half = numbers.uniform(0.1, 0.5) * (high - low)
                ends[0].append(f"{middle - half:.4f}")
                ends[1].append(f"{middle + half:.4f}")
            boxes.append(",".join(ends[0] + ends[1]))
        return boxes

    def row(self, region, adapt="auto", box="auto"):
        """Mesh and improvement of the density at hand, as one row; `kept`: every promise is."""
        mesh = self.mesh("--region", region, "--adapt", adapt, f"--box={box}")
        improvement = self.improve()
        before, after = self.stat("tet"), self.stat("out")
        counts, surface = improvement["counts"], improvement["counts"]["surface"]
        angles = {name: (m["quality"]["dihedral"]["min"], m["quality"]["dihedral"]["max"])
                  for name, m in (("before", before), ("after", after))}
        bins = before["quality"]["dihedral"]["histogram"]["counts"]  # of 5 degrees
        row = {"region": region, "elements": after["tets"], "elements_before": before["tets"], **angles,
               "points": after["points"],
               "outside_before": 1e4 * (sum(bins[:2]) + sum(bins[32:])) / before["tets"],
               "outside_after": counts["quality_after"]["below_25"] + counts["quality_after"]["above_140"],
               "q": after["quality"]["joe_liu_q"]["min"], "ratio": after["quality"]["edge_ratio"]["max"],
               "off": surface["points_off"], "off_cavity": surface["points_off_cavity"],
               "off_wall": surface.get("points_off_wall", 0), "surface_points": surface["points"],
               "far": 1e3 * surface["centroids_off"] / max(1, surface["triangles"]),
               "turned": 1e3 * surface["turned_45"] / max(1, surface["triangles"]),
               "missing": 100 * surface["volume_missing"] / surface["volume"] if surface["volume"] else 0,
               "mesh_seconds": mesh["work"], "improve_seconds": improvement["work"],
               "rate": before["tets"] / improvement["work"],
               "mesh_bytes": mesh["peak_rss_bytes"], "improve_bytes": improvement["peak_rss_bytes"],
               "faults": [before["faults"], after["faults"]]}
        same = all(before["surface"][k] == after["surface"][k] for k in ("components", "euler"))
        row["valid"] = before["valid"] and after["valid"] and same
        row["kept"] = (row["valid"] and row["outside_after"] == 0 and row["q"] >= 0.3 and row["ratio"] <= 6
                       and row["far"] <= 10 and row["turned"] <= 1 and abs(row["missing"]) <= 0.5)
        return row
