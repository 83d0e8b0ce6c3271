#!/usr/bin/env python3
"""figures.py IMAGE.png MESH WHAT CAPTION [MESH WHAT CAPTION …]: labelled meshes in panels.

MESH: a .vtu as tetlabel writes it (or a map of density2map). CAPTION: lines are separated by \\n. WHAT is one of
  surface   the molecular surface
  body      the molecule's tetrahedra from outside, those at the walls of the box, too
  exterior  the surroundings cut open, with the molecule's place left out
  embedded  the surroundings cut open, and the molecule whole
  both      molecule and surroundings cut open, in the molecule's colours
  section   the molecule cut open; section:A,B shows chains A and B in blue
  parts     the molecule's tetrahedra in the colours of their parts
  angles    the quarter of the molecule that faces the viewer taken away, tetrahedra coloured by their smallest dihedral angle, behind
            it the surroundings where the mesh has them
  inside, band  a slice of a map (CCP4): the points inside, or those that were computed, in green

--colour LEVEL:NAME=RRGGBB: of a group, later ones win; a copy NAME_1 is meant by NAME, too; *: all groups of the level in distinct
colours. --rest RRGGBB. --legend WORDS=RRGGBB (several). --view AZIMUTH,ELEVATION,ROLL, one for all or one a panel. --clip x|y|z: what is
cut. --columns N. --size WIDTH,HEIGHT of a panel. --same: all panels share the first one's camera.
--lowest °: where the colour bar of angles begins.
Needs VTK's Python module (Debian: python3-vtk9) and a display (`xvfb-run -a docs/figures.py …` without one).
"""
import argparse
import numpy as np
import panels
import vtk
from vtk.util.numpy_support import numpy_to_vtk

BLUE, SOLVENT, SECTION, GREEN, PAPER, HIDDEN = (70, 100, 216), (214, 222, 230), (238, 170, 180), (74, 156, 84), (238, 240, 242), (208, 214, 220)


def rgb(text):
    return tuple(int(text[i : i + 2], 16) for i in (0, 2, 4))


def colours(mesh, of_what, rules, rest):
    """One a triangle or tetrahedron: the rest's, and over it what the rules say."""
    result = np.tile(np.array(rest, float), (len(of_what("region")), 1))
    for level, name, colour in rules:
        groups = mesh.names(level)
        if name == "*":
            lookup = np.vstack([panels.palette(len(groups)), rest])
            result = lookup[of_what(level)]
            continue
        hit = [n == name or n.rsplit("_", 1)[0] == name for n in groups] + [False]
        result[np.array(hit)[of_what(level)]] = colour
    return result


def smallest_dihedral(points, tets):
    """Degrees, one a tetrahedron."""
    p = points[tets]
    normals = []
    for i in range(4):
        a, b, c = (p[:, j] for j in range(4) if j != i)
        n = np.cross(b - a, c - a)
        n *= np.sign(np.einsum("ij,ij->i", n, a - p[:, i]))[:, None]  # outwards
        normals.append(n / np.linalg.norm(n, axis=1)[:, None])
    cosines = [-np.einsum("ij,ij->i", normals[i], normals[j]) for i in range(4) for j in range(i)]
    return np.degrees(np.arccos(np.clip(cosines, -1, 1))).min(axis=0)


def angle_shades(lowest):
    steps = np.array([0, 0.25, 0.5, 1]) * (60 - lowest) + lowest
    rgb_at = np.array([(190, 38, 25), (242, 153, 64), (242, 235, 153), (51, 128, 153)], float)
    return lambda angles: np.stack([np.interp(angles, steps, rgb_at[:, i]) for i in range(3)], axis=1)


def away(view):
    azimuth, elevation = np.radians(view[:2])
    return np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])


def angles_panel(mesh, view, lowest):
    """Of what is before the middle, the right half is open."""
    region = mesh.of_tets("region")
    centre = mesh.points[np.unique(mesh.tets[region == 1])].mean(axis=0)
    size = np.ptp(mesh.points[np.unique(mesh.tets[region == 1])], axis=0).max()
    offset = mesh.middles - centre
    turn = np.radians(round(view[0] / 90) * 90)
    depth = offset @ [np.cos(turn), np.sin(turn), 0]
    aside = offset @ [-np.sin(turn), np.cos(turn), 0]
    closed = (depth < 0) | (aside < 0)
    shades = angle_shades(lowest)(smallest_dihedral(mesh.points, mesh.tets))
    shown = panels.actors(panels.opened(mesh, closed & (region == 1), shades), edges=0.4)
    near = (depth < 0) & (depth > -0.1 * size) & (np.abs(aside) < 0.68 * size) & (np.abs(offset[:, 2]) < 0.56 * size)
    for label, colour, keep in ((2, SOLVENT, near), (3, (140, 76, 166), closed)):
        if (keep & (region == label)).any():
            shown += panels.actors(panels.opened(mesh, keep & (region == label), np.tile(np.array(colour, float), (mesh.count, 1))),
                                   edges=0.3, ambient=0.3)
    return shown


def mesh_panel(path, what, rules, rest, view, clip, lowest):
    mesh = panels.Mesh(path)
    if what == "angles":
        return angles_panel(mesh, view, lowest)
    what, _, chains = what.partition(":")
    shades = colours(mesh, mesh.of_triangles, rules + [("chain", name, BLUE) for name in chains.split(",") if name], rest)
    if what == "surface":
        return panels.actors(panels.surface(mesh, shades))
    region = mesh.of_tets("region")
    on_surface = mesh.points[mesh.triangles[mesh.molecule()]].reshape(-1, 3)
    centre = (on_surface.min(axis=0) + on_surface.max(axis=0)) / 2
    axis = "xyz".index(clip)
    behind = (mesh.middles[:, axis] - centre[axis]) * away(view)[axis] < 0
    plain = np.tile(np.array(SOLVENT, float), (mesh.count, 1))
    if what == "exterior":
        return panels.actors(panels.opened(mesh, behind & (region != 1), plain, shades), edges=0.35, ambient=0.35)
    if what == "embedded":
        return (panels.actors(panels.opened(mesh, behind & (region != 1), plain, shades), edges=0.35, ambient=0.35)
                + panels.actors(panels.polygons(mesh.points, mesh.triangles[mesh.molecule()], shades[mesh.molecule()]), edges=0.2))
    of_tets = np.where((region == 1)[:, None], colours(mesh, mesh.of_tets, rules, rest), SOLVENT)
    if what == "body":
        return panels.actors(panels.opened(mesh, region == 1, of_tets, shades), edges=0.15)
    if what == "both":
        return panels.actors(panels.opened(mesh, behind, of_tets, shades), edges=0.35, ambient=0.35)
    if what == "section":
        cut = np.tile(np.array(SECTION, float), (mesh.count, 1))
        return panels.actors(panels.opened(mesh, behind & (region == 1), cut, shades), edges=0.3)
    if what == "parts":
        part = mesh.of_tets("part")
        return panels.actors(panels.opened(mesh, region == 1, panels.palette(part.max() + 1)[part]), edges=0.2)
    raise SystemExit(f"{what}: no kind of panel")


def map_panel(path, what):
    """The slice of a map in its middle along z, one pixel a point."""
    header = np.fromfile(path, "<i4", 256)
    nx, ny, nz = (int(n) for n in header[:3])
    spacing = float(header.view("<f4")[10]) / nx
    values = np.array(np.memmap(path, "<f4", "r", 1024 + int(header[23]), (nz, ny, nx))[nz // 2])
    inside = values >= 1
    # Points that were not computed have one value outside, 0, and one inside.
    kinds, times = np.unique(values[inside], return_counts=True)
    computed = (values != 0) & (values != kinds[times.argmax()])
    pixels = np.where((inside if what == "inside" else computed)[..., None], GREEN, PAPER)
    if what == "band":
        pixels[inside & ~computed] = HIDDEN
    image = vtk.vtkImageData()
    image.SetDimensions(nx, ny, 1)
    image.SetSpacing(spacing, spacing, spacing)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3).astype(np.uint8), deep=True))
    shown = vtk.vtkImageActor()
    shown.GetMapper().SetInputData(image)
    shown.InterpolateOff()
    return [shown]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("image")
    parser.add_argument("panels", nargs="+")
    parser.add_argument("--colour", action="append", default=[])
    parser.add_argument("--rest", default="BAC0C6")
    parser.add_argument("--legend", action="append", default=[])
    parser.add_argument("--view", action="append", default=[])
    parser.add_argument("--clip", default="y")
    parser.add_argument("--columns", type=int, default=0)
    parser.add_argument("--size", default="420,380")
    parser.add_argument("--same", action="store_true")
    parser.add_argument("--lowest", type=float, default=25)
    o = parser.parse_args()
    if len(o.panels) % 3 != 0:
        parser.error("each panel has a mesh, what to show, and a caption")
    rules = []
    for rule in o.colour:
        group, _, colour = rule.partition("=")
        level, _, name = group.partition(":")
        rules.append((level, name, rgb(colour) if colour else None))
    legend = [(words, rgb(colour)) for words, _, colour in (entry.rpartition("=") for entry in o.legend)]
    views = [tuple(float(x) for x in view.split(",")) for view in o.view] or [(-60, 25, 0)]
    shown = []
    for k, (path, what, caption) in enumerate(zip(o.panels[0::3], o.panels[1::3], o.panels[2::3])):
        flat = what in ("inside", "band")
        view = (-90, 90, 0) if flat else views[min(k, len(views) - 1)]
        actors = map_panel(path, what) if flat else mesh_panel(path, what, rules, rgb(o.rest), view, o.clip,
                                                                                   o.lowest)
        shown.append(panels.Panel(actors, caption, view[:2], view[2], like=shown[0] if o.same and shown else None,
                                  legend=() if shown else legend))
    bar = ("smallest dihedral angle of a tetrahedron", o.lowest, 60, angle_shades(o.lowest)) if "angles" in o.panels[1::3] else None
    panels.draw(shown, o.image, o.columns, tuple(int(n) for n in o.size.split(",")), bar)


main()
