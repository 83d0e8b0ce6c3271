#!/usr/bin/env bash
# binding.sh BIN X.hier SPACING [BOX [SALT]] — electrostatic binding energy of the two outermost groups of X.hier, rigid, by DOLFINx. Status 77: skipped.
#
# One mesh serves all three states: each partner is a region of its own (density2tet --regions), and where a partner is away its region has the solvent's
# permittivity. So what the mesh errs by is the same in each state and drops out of
#   ΔG = E(both) - E(first) - E(second) + Coulomb's energy between the two in ε = 2.
# Salt does not enter the region of a partner that is away. Energies in kJ/mol.
set -eu
[ $# -ge 3 ] || { echo "usage: binding.sh BIN X.hier SPACING [BOX [SALT]]" >&2; exit 2; }
bin=$(realpath "$1") hier=$(realpath "$2") spacing=$3 box=${4:-2x} salt=${5:-0}
here=$(cd "$(dirname "$0")" && pwd)
python=$("$here/dolfinx.sh") || { status=$?; echo "$python"; exit $status; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# both.charges, 1.charges and 2.charges: X Y Z CHARGE RADIUS GROUP behind their number, as X.charges.
level=$(awk '$1 == "levels" { print $2; exit }' "$hier")
awk -v level="$level" '$1 == level { ++group }
  $1 == "atom" && NF == 8 && $8 != 0 { all[++n] = $4 " " $5 " " $6 " " $8 " " $7; of[n] = group; ++count[group] }
  END {
    if (group != 2) { print "found " group + 0 " groups of level " level ", expected 2" >"/dev/stderr"; exit 3 }
    print n >"both.charges"
    for (g = 1; g <= 2; ++g) print count[g] + 0 >(g ".charges")
    for (i = 1; i <= n; ++i) { print all[i] >"both.charges"; print all[i] >(of[i] ".charges") }
  }' "$hier"

"$bin"/hier2density -q --spacing "$spacing" "$hier" -o x.vdb
"$bin"/density2tet -q --region both --box "$box" --regions "$level" --hier "$hier" x.vdb -o x.tet.vtu
"$bin"/tetsmooth -q --density x.vdb --hier "$hier" x.tet.vtu -o x.vtu
"$bin"/tetconvert -q x.vtu -o x.xdmf

energy() { # energy CHARGES ε_4 ε_5
  "$python" "$here/poisson_boltzmann.py" x.xdmf "$1.charges" "$1.vtu" --eps 4="$2" 5="$3" --salt "$salt" --salt-regions 2 | awk '{ print $2 }'
}
both=$(energy both 2 2) first=$(energy 1 2 78.54) second=$(energy 2 78.54 2)
awk -v both="$both" -v first="$first" -v second="$second" '
  FNR == 1 { ++file; next }
  file == 1 { x[++n] = $1; y[n] = $2; z[n] = $3; q[n] = $4; next }
  { for (i = 1; i <= n; ++i) sum += q[i] * $4 / sqrt((x[i] - $1)^2 + (y[i] - $2)^2 + (z[i] - $3)^2) }
  END {
    coulomb = 1389.35458 / 2 * sum
    printf "binding %.6g kJ/mol: both %.8g, first %.8g, second %.8g, Coulomb %.8g\n", both - first - second + coulomb, both, first, second, coulomb
  }' 1.charges 2.charges
