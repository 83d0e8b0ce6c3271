"""poisson_boltzmann.py — solvation energy and surface potential by DOLFINx:

    poisson_boltzmann.py X.xdmf X.charges X.vtu [--eps REGION=ε …] [--salt mol/l] [--salt-regions REGION …]
                         [--equation linear|nonlinear]

X.xdmf has the molecule (region 1) and its surroundings, and X.charges the number of charges, then X Y Z CHARGE RADIUS of each: both
by `tetconvert --charges X.hier X.vtu -o X.xdmf`. --eps: the relative permittivity of a region, by default 2 in region 1 and 78.54 in all
others: a membrane that is a region of its own has its own. --salt-regions hold the salt, 1:1, at 298.15 K: without it
those with the permittivity of region 2. All charges must lie in
regions of one permittivity. X.vtu receives the potential on the molecular surface, in kT/e. Prints what poisson_boltzmann.edp prints.

Regularised: the potential is φ = c + u, c the Coulomb potential of the charges with the permittivity ε₁ that they lie in. c solves the equation
where ε = ε₁, so that the source of u lies elsewhere, where c is smooth: no charge needs a mesh point.

    -∇·(ε ∇u) + ε κ² kT sinh((c + u)/kT) = ∇·((ε - ε₁) ∇c), the second term where the salt is

On the box φ is that of the charges in the solvent, screened. The energy is Σ q u / 2, and nonlinear also what the ions take. Potentials are in
kJ/mol/e, lengths in Å. For version 0.5 of DOLFINx (Debian 12: python3-dolfinx-real, python3-meshio)."""
import argparse
import logging
import sys

import numpy as np

try:
    import meshio
    import ufl
    from dolfinx import fem, geometry, io, mesh
    from mpi4py import MPI
    from petsc4py.PETSc import ScalarType
except ImportError as missing:
    print(f"SKIPPED: {missing} (Debian: python3-dolfinx-real python3-meshio)")
    sys.exit(77)

COULOMB, KT = 1389.35458, 0.00831446262 * 298.15
SOLVER = {"ksp_type": "cg", "pc_type": "hypre", "pc_hypre_type": "boomeramg", "ksp_rtol": 1e-10, "ksp_error_if_not_converged": True}


def coulomb_sums(points, charges, kappa):
    """Σ q/r and Σ q exp(-κr)/r at each point."""
    plain, screened = np.zeros(len(points)), np.zeros(len(points))
    for x, y, z, q in charges:
        r = np.sqrt((points[:, 0] - x) ** 2 + (points[:, 1] - y) ** 2 + (points[:, 2] - z) ** 2)
        plain += q / r
        screened += q * np.exp(-kappa * r) / r
    return plain, screened


def values_at(u, domain, points):
    """u at points of the mesh."""
    points = np.ascontiguousarray(points)
    candidates = geometry.compute_collisions(geometry.BoundingBoxTree(domain, 3), points)
    found = geometry.compute_colliding_cells(domain, candidates, points)
    if not all(len(found.links(i)) for i in range(len(points))):
        sys.exit("a charge lies outside the mesh")
    return u.eval(points, [found.links(i)[0] for i in range(len(points))]).reshape(-1)


def write_surface(path, domain, facets, phi):
    """The triangles with phi, which is of first order, at their corners."""
    domain.topology.create_connectivity(2, 0)
    place = np.empty(domain.topology.index_map(0).size_local, dtype=np.int64)  # [vertex] its entry in geometry.x
    place[domain.topology.connectivity(3, 0).array] = domain.geometry.dofmap.array
    corners = place[domain.topology.connectivity(2, 0).array.reshape(-1, 3)[facets]]
    points, triangles = np.unique(corners, return_inverse=True)
    value = np.empty(len(domain.geometry.x))
    value[domain.geometry.dofmap.array] = phi.x.array[phi.function_space.dofmap.list.array]
    meshio.write_points_cells(path, domain.geometry.x[points], [("triangle", triangles.reshape(-1, 3))],
                              {"potential": value[points]})


def main():
    logging.disable(logging.INFO)  # of the compiler of forms
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("charges")
    parser.add_argument("potential")
    parser.add_argument("--eps", nargs="+", default=[], metavar="REGION=ε")
    parser.add_argument("--salt", type=float, default=0)
    parser.add_argument("--salt-regions", type=int, nargs="+", metavar="REGION")
    parser.add_argument("--equation", choices=["linear", "nonlinear"], default="linear")
    o = parser.parse_args()

    with io.XDMFFile(MPI.COMM_SELF, o.mesh, "r") as f:
        domain = f.read_mesh(name="mesh")
        regions = f.read_meshtags(domain, name="mesh")
        domain.topology.create_connectivity(2, 3)
        patches = f.read_meshtags(domain, name="facets")
    given = {int(region): float(eps) for region, eps in (text.split("=") for text in o.eps)}
    unknown = set(given) - set(regions.values.tolist())
    if unknown:
        sys.exit(f"--eps: found region {min(unknown)}, expected one of {sorted(set(regions.values.tolist()))}")
    permittivity = {region: given.get(region, 2 if region == 1 else 78.54) for region in set(regions.values.tolist()) | {1, 2}}
    eps_out = permittivity[2]
    kappa2 = 8 * np.pi * COULOMB / (eps_out * KT) * 6.02214076e-4 * o.salt  # Å⁻²
    with open(o.charges) as lines:
        charges = np.loadtxt(lines, max_rows=int(next(lines)), ndmin=2)[:, :4]
    charged = charges[charges[:, 3] != 0]
    if not len(charged):
        sys.exit(f"{o.charges}: found no charge, expected at least one")

    P0, P2 = fem.FunctionSpace(domain, ("DG", 0)), fem.FunctionSpace(domain, ("CG", 2))
    eps, salt = fem.Function(P0), fem.Function(P0)
    eps.x.array[regions.indices] = [permittivity[region] for region in regions.values]
    around = values_at(eps, domain, charged[:, :3])
    if np.ptp(around) > 0:
        sys.exit(f"{o.charges}: found charges in permittivities {around.min():g} and {around.max():g}, expected one")
    eps_in = around[0]
    salty = o.salt_regions if o.salt_regions is not None else [r for r in permittivity if permittivity[r] == eps_out]
    salt.x.array[regions.indices] = np.where(np.isin(regions.values, salty), eps_out * kappa2, 0)

    # c where its permittivity is not, and φ on the box.
    other = fem.locate_dofs_topological(P2, 3, np.flatnonzero(eps.x.array != eps_in).astype(np.int32))
    plain, screened = coulomb_sums(P2.tabulate_dof_coordinates()[other], charged, np.sqrt(kappa2))
    c, far, u = fem.Function(P2), fem.Function(P2), fem.Function(P2)
    c.x.array[other] = COULOMB / eps_in * plain
    far.x.array[other] = COULOMB / eps_out * screened - c.x.array[other]
    walls = fem.locate_dofs_topological(P2, 2, mesh.exterior_facet_indices(domain.topology))

    w, t, dx = ufl.TrialFunction(P2), ufl.TestFunction(P2), ufl.dx
    source = (eps_in - eps) * ufl.inner(ufl.grad(c), ufl.grad(t)) * dx
    u.x.array[:] = fem.petsc.LinearProblem(
        eps * ufl.inner(ufl.grad(w), ufl.grad(t)) * dx + salt * w * t * dx, source - salt * c * t * dx,
        bcs=[fem.dirichletbc(far, walls)], petsc_options=SOLVER).solve().x.array
    steps = 0
    if o.equation == "nonlinear":  # Newton's steps from the solution of the linearised equation
        phi = c + u
        residual = (source - eps * ufl.inner(ufl.grad(u), ufl.grad(t)) * dx - salt * KT * ufl.sinh(phi / KT) * t * dx)
        tangent = eps * ufl.inner(ufl.grad(w), ufl.grad(t)) * dx + salt * ufl.cosh(phi / KT) * w * t * dx
        step = fem.petsc.LinearProblem(tangent, residual, bcs=[fem.dirichletbc(ScalarType(0), walls, P2)], petsc_options=SOLVER)
        change = KT
        while change > 1e-4 * KT:
            v = step.solve()
            u.x.array[:] += v.x.array
            change = np.abs(v.x.array).max()
            steps += 1
            if steps > 60:
                sys.exit("the nonlinear equation did not converge")

    energy = np.dot(charged[:, 3], values_at(u, domain, charged[:, :3])) / 2
    if o.equation == "nonlinear":
        phi = (c + u) / KT
        ions = salt * KT**2 * (phi * ufl.sinh(phi) / 2 - ufl.cosh(phi) + 1) * dx
        energy += fem.assemble_scalar(fem.form(ions)) / (4 * np.pi * COULOMB)
    print(f"energy {energy:.8g} kJ/mol, {o.equation}, salt {o.salt:g} mol/l, {len(charges)} charges, sum {charges[:, 3].sum():.6g} e, "
          f"{P2.dofmap.index_map.size_global} unknowns, {steps} steps")

    P1 = fem.FunctionSpace(domain, ("CG", 1))
    surface = fem.Function(P1)
    surface.interpolate(fem.Expression((c + u) / KT, P1.element.interpolation_points()))
    write_surface(o.potential, domain, np.sort(patches.indices[(patches.values == 11) | (patches.values > 17)]), surface)


main()
