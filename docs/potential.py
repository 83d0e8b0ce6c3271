#!/usr/bin/env python3
"""potential.py POTENTIAL.vtu IMAGE.png: the potential on a molecular surface, from two sides.

POTENTIAL.vtu: as tests/solve/poisson_boltzmann.edp writes it, triangles with the potential in kT/e at their corners. Red is negative, blue positive; colours
end at the value that 99 of 100 corners stay below.
Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/potential.py …` without one).
"""
import sys
import numpy as np
import panels
from vtk.util.numpy_support import vtk_to_numpy

STOPS = np.array([(178, 34, 34), (232, 150, 130), (245, 245, 245), (135, 165, 215), (30, 70, 150)], float)


def main(path, image):
    mesh = panels.Mesh(path)
    potential = vtk_to_numpy(mesh.grid.GetPointData().GetArray("potential"))
    most = max(1, round(float(np.percentile(np.abs(potential), 99))))

    def shade(values):
        at = (np.clip(values / most, -1, 1) + 1) / 2
        return np.stack([np.interp(at, np.linspace(0, 1, len(STOPS)), STOPS[:, k]) for k in range(3)], axis=1)

    surface = panels.surface(mesh, shade(potential), np.ones(len(mesh.triangles), bool))
    shown = [panels.Panel(panels.actors(surface), caption, (azimuth, 15))
             for caption, azimuth in (("from the front", -60), ("from behind", 120))]
    panels.draw(shown, image, size=(430, 400), bar=("potential on the surface, kT/e", -most, most, shade, "", (0,)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
