#!/usr/bin/env bash
# pictures.sh BIN [FOLDER] — the pictures of the documents, from tests/data/1tii.pdb and the programs in BIN, into FOLDER (here).
# Needs VTK's Python module (Debian: python3-vtk9); without a display also xvfb-run (xvfb). pngquant, where it is, makes them smaller.
set -eu
docs=$(cd "$(dirname "$0")" && pwd)
PATH=$(realpath "$1"):$PATH
folder=$(realpath "${2:-$docs}")
structure=$docs/../tests/data/1tii.pdb
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# mesh NAME REGION [PDB2HIER OPTION…]: NAME.hier and NAME.vtu
mesh() {
  local name=$1 region=$2
  shift 2
  pdb2hier -q "$@" "$structure" -o "$name.hier"
  hier2density -q --spacing 1 "$name.hier" -o "$name.vdb"
  density2tet -q --region "$region" "$name.vdb" -o "$name.tet.vtu"
  tetsmooth -q --density "$name.vdb" "$name.tet.vtu" -o "$name.vtu"
}
draw() { # SCRIPT ARGUMENT…
  local script=$1
  shift
  if [ -n "${DISPLAY:-}" ]; then python3 "$docs/$script" "$@"; else xvfb-run -a python3 "$docs/$script" "$@"; fi
}

mesh 1tii both
draw render.py 1tii.vtu 1tii.png

site=()
for chain in D E F G H; do site+=(--boundary "active_site=//$chain/40-60"); done
tetlabel -q 1tii.vtu 1tii.hier "${site[@]}" -o labels.vtu
draw labels.py labels.vtu labels.png

mesh blurred interior -r '* P_R=0.05 P_C=0.5'
mesh detailed interior -r '* P_R=0.5 P_C=1'
mesh chain_d interior -r '* P_R=0.05 P_C=0.5' -r '//D P_R=0.5 P_C=1'
draw resolution.py chains.png chain D blurred.vtu blurred.hier detailed.vtu detailed.hier chain_d.vtu chain_d.hier

printf 'pentamer //D,E,F,G,H\nA //A,C\n' >domains.txt
domains=(--levels domain,chain,residue --domains domains.txt)
mesh joined interior "${domains[@]}" -r '* P_R=0.2 P_C=0.5 P_D=0.1'
mesh apart interior "${domains[@]}" -r '* P_R=0.2 P_C=0.5 P_D=1'
draw resolution.py domains.png domain pentamer joined.vtu joined.hier apart.vtu apart.hier

for picture in 1tii labels chains domains; do
  if command -v pngquant >/dev/null; then pngquant --nofs 200 --force --output "$folder/$picture.png" "$picture.png"
  else cp "$picture.png" "$folder/$picture.png"; fi
done
