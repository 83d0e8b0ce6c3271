#!/usr/bin/env python3
"""page_test.py BIN SOURCE: tetreport's page in a headless Chromium.

The page renders, its cut shows whole tetrahedra, a click on the worst element goes there, nothing is asked of the network, and the console
stays empty. Pictures are compared by how much of them has which colour. Skipped (77) where there is no Chromium.
"""
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import browser  # noqa: E402

STAGE = "(r => [r.left, r.top, r.right, r.bottom].map(Math.round))(document.getElementById('stage').getBoundingClientRect())"
SETTLED = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(r, 60))))"
failures = 0


def check(what, holds, found=None):
    global failures
    if not holds:
        failures += 1
        print("FAILED: " + what + ("" if found is None else f": found {found}"))


class Picture:
    """The stage of the page, sampled at every third pixel."""

    def __init__(self, chromium):
        chromium.run(SETTLED)
        left, top, right, bottom = chromium.run(STAGE)
        _, _, rows, size = chromium.screenshot()
        self.points = [(x, y, *rows[y][x * size:x * size + 3]) for y in range(top + 4, min(bottom, len(rows)) - 4, 3)
                       for x in range(left + 4, right - 4, 3)]

    def share(self, colour):
        return sum(1 for p in self.points if colour(*p[2:])) / len(self.points)

    def middle(self, colour):
        found = [p for p in self.points if colour(*p[2:])]
        return (sum(p[0] for p in found) / len(found), sum(p[1] for p in found) / len(found)) if found else None


def ink(r, g, b):
    return min(r, g, b) < 235


def blue(r, g, b):
    return b > 1.25 * r and b > 60


def red(r, g, b):
    return r > 1.5 * b and r > 1.5 * g and r > 60


def bad(r, g, b):  # the dark end of the scale at the cut
    return r > 1.3 * max(g, b) and 50 < r < 160


def pale(r, g, b):  # the other end; the surface is yellower
    return b > 0.96 * r and r > 120 and ink(r, g, b)


def mark(r, g, b):  # around the element that was asked for
    return r > 180 and g < 60 and 70 < b < 140


def main(bin_folder, source):
    program = browser.find()
    if not program:
        print("SKIPPED: no Chromium here (Debian: chromium)")
        return 77

    def run(tool, *arguments):
        subprocess.run([os.path.join(bin_folder, tool), "-q", *arguments], check=True, stdin=subprocess.DEVNULL)

    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        run("pdb2hier", os.path.join(source, "tests/data/1tii.pdb"), "-o", "a.hier")
        run("hier2density", "--spacing", "3", "a.hier", "-o", "a.vdb")
        run("density2tet", "--region", "both", "a.vdb", "-o", "a.tet.vtu")
        run("tetlabel", "a.tet.vtu", "a.hier", "--boundary", "site=//D/45-60", "-o", "a.vtu")
        run("tetreport", "a.vtu", "--check", "-o", "one.html")
        run("tetreport", "a.vtu", "a.tet.vtu", "a.vtu", "-o", "all.html")
        with open("one.html", encoding="utf-8") as f:
            if 'id="three"' not in f.read():
                print("SKIPPED: tetreport was built without three.js (Debian: libjs-three)")
                return 77
        chromium = browser.Browser(program)
        try:
            one(chromium)
            gallery(chromium)
            check("no error of a script, and nothing asked of the network", not chromium.errors, chromium.errors)
            check("nothing on the console", not [c for c in chromium.console if "GPU stall" not in c], chromium.console)
        finally:
            chromium.close()
    return 1 if failures else 0


def one(chromium):
    chromium.open("one.html")
    report = chromium.run("molmesh.report.meshes[0]")
    mesh = chromium.run("(m => ({tets: m.tets, points: m.points, triangles: m.triangles, corners: Math.max(...m.corner.slice(0, 4000))}))(molmesh.view.mesh)")
    check("the page unpacks every tetrahedron", mesh["tets"] == report["tets"], mesh)
    check("and every point and triangle", mesh["points"] == report["points"] and mesh["triangles"] == report["triangles"], mesh)

    # Volumes of what was unpacked, against the exact ones of the report: decoder, orientation and bodies at once.
    volumes = chromium.run("""(() => { const m = molmesh.view.mesh, v = new Array(molmesh.report.meshes[0].bodies.length).fill(0), p = m.position;
      const at = i => [p[3 * i], p[3 * i + 1], p[3 * i + 2]], sub = (a, b) => a.map((x, k) => x - b[k]);
      for (let t = 0; t < m.tets; t++) { const [a, b, c, d] = [0, 1, 2, 3].map(i => at(m.corner[4 * t + i])), u = sub(b, a), w = sub(c, a), z = sub(d, a);
        v[m.body[t]] += ((u[1] * w[2] - u[2] * w[1]) * z[0] + (u[2] * w[0] - u[0] * w[2]) * z[1] + (u[0] * w[1] - u[1] * w[0]) * z[2]) / 6; }
      return v; })()""")
    for body, volume in zip(report["bodies"], volumes):
        # Points move by half a diagonal of the grid that coordinates are rounded to.
        limit = body["area"] * report["code"]["quantum"] * 0.87 + 1e-4 * body["volume"]
        check("the volume of a body", abs(volume - body["volume"]) < limit, (volume, body["volume"], limit))
    worst = report["worst"][0]
    shape = chromium.run(f"(c => shapeOf(molmesh.view.mesh.position, ...c))(Array.from(molmesh.view.mesh.corner.slice({4 * worst['place']}, {4 * worst['place'] + 4})))")
    check("the worst element's angles", abs(shape[0] - worst["min"]) < 0.5 and abs(shape[1] - worst["max"]) < 0.5, (shape, worst))

    whole = Picture(chromium)
    check("the molecule is drawn", 0.15 < whole.share(ink) < 0.7, whole.share(ink))
    x, y = whole.middle(ink)
    left, top, right, bottom = chromium.run(STAGE)
    check("in the middle", abs(x - (left + right) / 2) < 0.08 * (right - left) and abs(y - (top + bottom) / 2) < 0.08 * (bottom - top), (x, y))

    chromium.run("document.getElementById('colour').value = 'plain', document.getElementById('colour').dispatchEvent(new Event('change'))")
    plain = Picture(chromium)
    check("without labels the surface has one colour", plain.share(blue) < 0.005 and plain.share(red) < 0.005, (plain.share(blue), plain.share(red)))
    chromium.run("document.getElementById('cut-y').click()")
    cut = Picture(chromium)
    check("the cut shows tetrahedra in the colours of their angles", cut.share(pale) > plain.share(pale) + 0.02 and cut.share(bad) > plain.share(bad) + 0.002, (cut.share(pale), cut.share(bad), plain.share(pale), plain.share(bad)))
    at_cut = chromium.run("""(() => { const v = molmesh.view, m = v.mesh, n = v.plane.normal, o = v.plane.offset, whole = new Set();
      for (let t = 0; t < m.tets; t++) { if (!v.shown[m.body[t]]) continue; let beyond = 0;
        for (let i = 0; i < 4; i++) { const p = 3 * m.corner[4 * t + i]; beyond += n[0] * m.position[p] + n[1] * m.position[p + 1] + n[2] * m.position[p + 2] > o; }
        if (beyond > 0 && beyond < 4) whole.add(t); }
      return [whole.size, v.atCut.length, v.atCut.every(t => whole.has(t)), v.cap.geometry.attributes.position.count]; })()""")
    check("they are those that the plane passes through, each with its four faces", at_cut[0] == at_cut[1] > 100 and at_cut[2] and at_cut[3] == 12 * at_cut[0], at_cut)
    chromium.run("document.getElementById('cut-at').value = 0, document.getElementById('cut-at').dispatchEvent(new Event('input'))")
    gone = Picture(chromium)
    check("at one end nothing is left", gone.share(ink) < 0.1 * whole.share(ink) + 0.03, gone.share(ink))
    chromium.run("document.getElementById('cut-at').value = 1, document.getElementById('cut-at').dispatchEvent(new Event('input'))")
    back = Picture(chromium)
    check("at the other all is back", abs(back.share(ink) - plain.share(ink)) < 0.04, (back.share(ink), plain.share(ink)))

    chromium.run("document.getElementById('cut-none').click()")
    chromium.run("document.getElementById('show-region-2').click()")
    box = Picture(chromium)
    check("what is around the molecule can be switched on", box.share(ink) > whole.share(ink), box.share(ink))
    chromium.run("document.getElementById('show-region-2').click(), document.getElementById('show-region-1').click()")
    without = Picture(chromium)
    check("and the molecule off", without.share(ink) < 0.1 * whole.share(ink) + 0.03, without.share(ink))
    chromium.run("document.getElementById('show-region-1').click()")

    chromium.run("document.querySelector('.columns tr.go').click()")
    near = Picture(chromium)
    check("a click on the worst element marks it", near.share(mark) > 0.0003, near.share(mark))
    where = near.middle(mark)
    if where:
        left, top, right, bottom = chromium.run(STAGE)
        check("in the middle", abs(where[0] - (left + right) / 2) < 60 and abs(where[1] - (top + bottom) / 2) < 60, where)
    check("it is among those at the cut", chromium.run(f"molmesh.view.atCut.includes({worst['place']})"))

    chromium.run("document.getElementById('home').click(), document.getElementById('cut-none').click()")
    chromium.run(SETTLED)
    left, top, right, bottom = chromium.run(STAGE)
    for kind in ("mousePressed", "mouseReleased"):
        chromium.call("Input.dispatchMouseEvent", type=kind, x=(left + right) // 2, y=(top + bottom) // 2, button="left", clickCount=1)
    text = chromium.run("document.querySelector('.picked').textContent")
    check("a click on the surface tells what is there", "residue" in text and "chain" in text and "angles" in text, text)


def gallery(chromium):
    chromium.open("all.html")
    check("a gallery has a picture of each mesh", chromium.run("document.querySelectorAll('.gallery figure img').length") == 3)
    check("that can be shown", chromium.run("Promise.all([...document.images].map(i => i.decode().then(() => i.naturalWidth))).then(w => w.every(x => x === 400))"))
    chromium.run("document.getElementById('as-table').click()")
    check("and a table", chromium.run("document.querySelectorAll('tbody tr').length") == 3)
    chromium.run("document.querySelectorAll('th.sort')[1].click()")
    numbers = [int(t.replace(",", "")) for t in chromium.run("[...document.querySelectorAll('tbody tr')].map(r => r.children[1].textContent)")]
    check("that can be sorted", numbers == sorted(numbers, reverse=True), numbers)
    for k in (1, 2):
        chromium.run(f"location.hash = '{k}'")
        chromium.run(SETTLED)
        chromium.run("molmesh.ready")
        check("each mesh opens", chromium.run("document.querySelector('h1').textContent") == ["a.vtu", "a.tet.vtu", "a.vtu"][k])
        picture = Picture(chromium)
        check("and is drawn", picture.share(ink) > 0.15, picture.share(ink))
    chromium.run("location.hash = ''")
    chromium.run(SETTLED)
    check("and the gallery comes back", chromium.run("document.querySelectorAll('tbody tr').length") == 3)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*map(os.path.abspath, sys.argv[1:])))
