#!/usr/bin/env bash
# solve.sh BIN SOURCE ion|harmonic|diffusion|kirkwood|energy|dolfinx|binding — structure to solution: the whole chain, judged by FreeFEM. Status 77: skipped.
set -eu
bin=$(realpath "$1") SOURCE=$(realpath "$2") what=$3
export PATH="$bin:$PATH" OMP_NUM_THREADS=2

solve() { "$SOURCE/tests/solve/freefem.sh" "$@"; }
status=0
"$SOURCE/tests/solve/freefem.sh" || status=$?
[ $status = 0 ] || exit $status

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# mesh NAME REGION SPACING [DENSITY2TET [TETSMOOTH]]: NAME.hier to NAME.vtu
mesh() {
  hier2density -q --spacing "$3" "$1.hier" -o "$1.vdb"
  density2tet -q --region "$2" ${4:-} "$1.vdb" -o "$1.tet.vtu"
  tetsmooth -q --density "$1.vdb" ${5:-} "$1.tet.vtu" -o "$1.vtu"
}

case $what in
ion) # Born's energy within 1 %
  pdb2hier -q --levels none "$SOURCE/tests/data/ion.pqr" -o ion.hier
  mesh ion both 0.25 "--box 10"
  tetconvert -q ion.vtu -o ion.mesh
  solve born ion.mesh 1 3
  ;;
harmonic) # a harmonic polynomial to 1e-10; with one tetrahedron missing it must not be found
  pdb2hier -q "$SOURCE/tests/data/1tii.pdb" -o 1tii.hier
  printf 'pentamer //D,E,F,G,H\nA //A,C\n' >domains.txt
  for region in interior exterior both sphere domains; do
    inner=0
    case $region in
    both | sphere) inner=1 ;;
    domains) inner=3 ;; # across their interface, too
    esac
    if [ $region = domains ]; then
      pdb2hier -q --levels domain,chain,residue --domains domains.txt "$SOURCE/tests/data/1tii.pdb" -o 1tii.hier
      mesh 1tii both 5 "--regions domain --hier 1tii.hier" "--hier 1tii.hier"
    elif [ $region = sphere ]; then
      mesh 1tii both 4 "--box sphere:1.5x"
    else
      mesh 1tii $region 5
    fi
    tetconvert -q 1tii.vtu -o 1tii.mesh
    echo "$region:"
    solve harmonic 1tii.mesh $inner 0 1e-10
    case $region in interior | domains) ;; *) continue ;; esac # twice is enough
    if solve harmonic 1tii.mesh $inner 1 1e-6 >missing 2>&1; then
      echo "a missing tetrahedron was not noticed: $(cat missing)"
      exit 1
    fi
    echo "with one missing: $(head -n 1 missing)"
    grep -q '^error' missing || { cat missing; exit 1; } # not for another reason
  done
  ;;
energy) # the bundled protein from its PQR file to the solvation energy, by the guide's command, within 1 % of APBS's
  # APBS 3.4.1 (Debian), the same PQR file, the molecular surface by dielectric maps (tests/bench/molecular_surface.py, whose field is its own; lpbe, bcfl mdh,
  # chgm spl2, pdie 2, sdie 78.54, 298.15 K, no ions): -604.82, -599.38, -596.55 and -595.34 kJ/mol on grids of 0.7, 0.5, 0.35 and 0.25 Å. With
  # `srfm mol` APBS does not come so near at these: -617.6 at 0.417, -610.0 at 0.25, -603.7 at 0.179 Å.
  apbs=-595.34
  cp "$SOURCE/tests/data/1l2y.pqr" .
  env -u MAKEFLAGS -u MAKELEVEL make -s -f "$SOURCE/Makefile.pipeline" BIN="$bin" HIER2DENSITY_FLAGS=-q PDB2HIER_FLAGS=-q DENSITY2TET_FLAGS=-q \
    TETSMOOTH_FLAGS=-q 1l2y.energy
  [ "$(head -n 1 1l2y.charges)" = 304 ]
  grep -q 'Name="potential"' 1l2y.potential.vtu
  awk -v apbs=$apbs '/^energy/ { off = $2 / apbs - 1; printf "APBS %g, off by %.2f %%\n", apbs, 100 * off } END { exit !(off != "" && off < 0.01 && off > -0.01) }' 1l2y.energy
  ;;
dolfinx) # DOLFINx finds what FreeFEM finds, and nothing where the permittivity is the same everywhere
  python=$("$SOURCE/tests/solve/dolfinx.sh") || { status=$?; echo "$python"; exit $status; }
  pdb2hier -q --levels none "$SOURCE/tests/data/ion.pqr" -o ion.hier
  mesh ion both 0.7 "--box 3x" --coarsen
  tetconvert -q ion.vtu -o ion.mesh
  tetconvert -q ion.vtu -o ion.xdmf
  printf '2\n0 1.5 0 1 3\n0 0 -1 -0.5 3\n' >ion.charges
  solve poisson_boltzmann ion.mesh ion.charges freefem.vtu 2 0.5 nonlinear | tee energies
  "$python" "$SOURCE/tests/solve/poisson_boltzmann.py" ion.xdmf ion.charges dolfinx.vtu --salt 0.5 --equation nonlinear | tee -a energies
  "$python" "$SOURCE/tests/solve/poisson_boltzmann.py" ion.xdmf ion.charges same.vtu --eps 2=2 | tee -a energies
  awk '/^energy/ { e[n++] = $2 } END { d = e[0] - e[1]; exit !(n == 3 && e[0] < -50 && d * d < 1e-6 && e[2] * e[2] < 1e-12) }' energies
  "$python" - <<'PY'
import meshio, numpy
a, b = meshio.read("freefem.vtu"), meshio.read("dolfinx.vtu")
order = [numpy.lexsort(numpy.round(m.points, 6).T) for m in (a, b)]
apart = [numpy.abs(x[order[0]] - y[order[1]]).max() for x, y in ((a.points, b.points), (a.point_data["potential"], b.point_data["potential"]))]
print(f"{len(a.points)} points of the surface, apart by {apart[0]:.1g} Å and {apart[1]:.1g} kT/e")
assert apart[0] < 1e-6 and apart[1] < 1e-3
PY
  ;;
binding) # two ions 12 Å apart: the charges in water, and what each polarizes in the other's sphere (n = 1)
  printf '%s\n' 'hier 1' 'levels domain' 'domain one 1' 'atom NA Na 0 0 0 2 1' 'domain other 1' 'atom CL Cl 12 0 0 2 -1' >ions.hier
  status=0
  "$SOURCE/tests/solve/binding.sh" "$bin" ions.hier 0.7 3x >energies || status=$?
  cat energies
  [ $status = 0 ] || exit $status
  awk '/^binding/ { exact = -1389.35458 / 78.54 * (1 / 12 - 76.54 / (2 * 78.54 + 2) * 2^3 / 12^4)
      printf "exact to n = 1: %.4f\n", exact; off = $2 / exact - 1 } END { exit !(exact < 0 && off < 0.01 && off > -0.01) }' energies
  ;;
diffusion) # a rate that converges with the mesh, coarsened meshes of a third of the elements
  structure=${MOLMESH_TEST_DATA:-}/pqr/misc__mache.pqr.gz
  [ -f "$structure" ] || { echo "SKIPPED: no $structure (-DMOLMESH_TEST_DATA=DIR)"; exit 77; }
  pdb2hier -q "$structure" -o ache.hier
  site=()
  for residue in 72 74 124 286 341; do site+=(--boundary "active_site=//*/$residue"); done # the gorge's mouth
  for spacing in 4 2.83 2; do
    mesh ache exterior $spacing "--box 3 --cavities fill" --coarsen
    tetconvert -q ache.vtu -o ache.mesh
    echo -n "$spacing Å, the whole surface: "
    solve diffusion ache.mesh 11 | tee -a whole
    tetlabel -q ache.vtu ache.hier "${site[@]}" -o labels.vtu
    tetconvert -q labels.vtu -o ache.mesh
    echo -n "$spacing Å, the site: "
    solve diffusion ache.mesh 18 | tee -a site
  done
  # Spacings fall by the square root of 2. To the whole surface, rates that converge differ by less from step to step,
  # here by under 5 % at once. The site is a few dozen triangles by nearest residue: its edge moves by a triangle when a
  # last digit of the density does, and the rate by 2 %.
  awk 'function apart(a, b) { return a > b ? a / b - 1 : b / a - 1 }
    /^rate/ { r[FILENAME, ++n[FILENAME]] = $2 }
    END { exit !(n["whole"] == 3 && n["site"] == 3 &&
      apart(r["whole", 2], r["whole", 1]) < 0.05 && apart(r["whole", 3], r["whole", 2]) < apart(r["whole", 2], r["whole", 1]) &&
      apart(r["site", 1], r["site", 3]) < 0.1 && apart(r["site", 2], r["site", 3]) < 0.06) }' whole site
  ;;
kirkwood) # a charge at the centre of a sphere (Born) within 0.3 %; on a coarsened mesh too, off the centre within 1 %, and screened by salt
  pdb2hier -q --levels none "$SOURCE/tests/data/ion.pqr" -o ion.hier
  for place in whole 0 1.5 2; do
    [ $place != whole ] || mesh ion both 0.25 "--box 10"
    [ $place != 0 ] || mesh ion both 0.25 "--box 10" --coarsen
    tetconvert -q ion.vtu -o ion.mesh
    printf '1\n0 %s 0 1 3\n' ${place/whole/0} >ion.charges
    solve poisson_boltzmann ion.mesh ion.charges ion.potential.vtu 2 0 linear | tee -a energies
  done
  printf '1\n0 0 0 1 3\n' >ion.charges
  for equation in linear nonlinear; do
    solve poisson_boltzmann ion.mesh ion.charges ion.potential.vtu 2 0.5 $equation | tee -a energies
  done
  awk '/^energy/ { e[n++] = $2 }
    # Kirkwood 1934: -C q²/(2 a ε_in) Σ (n+1)(ε_out - ε_in)/((n+1) ε_out + n ε_in) (b/a)^2n
    function kirkwood(b,   s, n) {
      for (n = 0; n < 200; ++n)
        s += (n + 1) * 76.54 / ((n + 1) * 78.54 + n * 2) * (b / 3) ^ (2 * n)
      return -1389.35458 / 12 * s
    }
    function off(found, exact) { printf "%.3f, exact %.3f, off by %.2f %%\n", found, exact, 100 * (found / exact - 1); return found > exact ? 1 - found / exact : found / exact - 1 }
    END {
      if (n != 6) exit 1
      bad = off(e[0], kirkwood(0)) > 0.003
      bad += off(e[1], kirkwood(0)) > 0.003
      bad += off(e[2], kirkwood(1.5)) > 0.01
      bad += off(e[3], kirkwood(2)) > 0.01
      # Debye and Hückel: the ions add -C q² κ / (2 ε_out (1 + κ a)), and hardly another amount where their potential is below kT/e
      kappa = sqrt(8 * 3.14159265 * 1389.35458 / (78.54 * 0.00831446262 * 298.15) * 6.02214076e-4 * 0.5)
      ions = -1389.35458 * kappa / (2 * 78.54 * (1 + 3 * kappa))
      bad += off(e[4] - e[1], ions) > 0.01
      bad += off(e[5] - e[1], ions) > 0.05
      exit bad != 0
    }' energies
  ;;
esac
