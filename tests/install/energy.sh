#!/usr/bin/env bash
# energy.sh BUILD SOURCE — installs the programs of a build; a PQR file becomes an energy there, in a folder that may only be read. Status 77: skipped.
set -eu
build=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cmake --install "$build" --component programs --prefix "$work/prefix" >"$work/log" || { cat "$work/log"; exit 1; }
chmod -R a-w "$work/prefix"
rules="$work/prefix/share/molmesh/Makefile.pipeline"
mkdir "$work/here" && cd "$work/here"
export OMP_NUM_THREADS=2
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEFILES
fail() { echo "FAILED: $1"; exit 1; }

cp "$work/prefix/share/molmesh/tests/data/1l2y.pqr" .
make -f "$rules" help | grep -q 'X.energy' || fail "make help: tells nothing of X.energy"
make -s -f "$rules" demo 2>said && fail "make demo: works without sources"
grep -q 'found an installation, expected a clone of the sources' said || { cat said; fail "make demo: does not say why"; }
make -s -f "$rules" HIER2DENSITY_FLAGS='-q --spacing 1' PDB2HIER_FLAGS=-q DENSITY2TET_FLAGS=-q TETSMOOTH_FLAGS=-q 1l2y.mesh
[ "$(head -n 1 1l2y.charges)" = 304 ] || fail "1l2y.charges: has other than 304 charges"
"$source/tests/solve/freefem.sh" || exit $?
make -s -f "$rules" 1l2y.energy
grep -q 'Name="potential"' 1l2y.potential.vtu
# At this spacing the charges are near few elements; the test `solve: energy` looks at the figure.
awk '/^energy/ { e = $2 } END { exit !(e < -500 && e > -900) }' 1l2y.energy || fail "the energy is far from APBS's, -604 kJ/mol"
