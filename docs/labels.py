#!/usr/bin/env python3
"""labels.py LABELLED.vtu IMAGE.png: the molecular surface by chain, by residue, and with a named boundary.

(a) Each chain a colour, paler where its share of the density is small. (b) Each residue a shade of its chain's colour. (c) Patch 8 is red.
Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/labels.py …` without one).
"""
import sys
import numpy as np
import panels


def main(path, image):
    mesh = panels.Mesh(path)
    of = mesh.of_triangles
    chain = panels.palette(len(mesh.names("chain")))[of("chain")]
    share = of("chain_share")[:, None]
    shade = np.random.default_rng(7).uniform(0.55, 1.35, of("residue").max() + 1)
    captions = ("by chain", "by residue", "by named boundary")
    colours = (chain * share + 255 * (1 - share), chain * shade[of("residue")][:, None],
               np.where((of("patch") == 8)[:, None], (205, 60, 50), panels.GREY))
    shown = []
    for colour, caption in zip(colours, captions):
        shown.append(panels.Panel(panels.actors(panels.surface(mesh, colour)), caption, (-90, 65), 20,
                                  like=shown[0] if shown else None))
    panels.draw(shown, image, size=(400, 390))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
