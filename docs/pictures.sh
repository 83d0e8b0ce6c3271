#!/usr/bin/env bash
# pictures.sh BIN [FOLDER [NAME…]] — the pictures of the documents, by the programs in BIN, into FOLDER (here); or these alone.
#
# Those of 1TII come from tests/data/1tii.pdb, the potential from tests/data/1l2y.pqr (and FreeFEM). The paper's figures (figure1 to figure11) need public structures: MOLMESH_TEST_DATA names
# their folder, and without it they are left as they are; COMPLEXES may name one where complexes/*.sh put their meshes.
# Needs VTK's Python module (Debian: python3-vtk9); without a display also xvfb-run (xvfb, xauth). pngquant, where it is, makes them smaller.
set -eu
docs=$(cd "$(dirname "$0")" && pwd)
bin=$(realpath "$1") PATH=$(realpath "$1"):$PATH
folder=$(realpath "${2:-$docs}")
shift $(($# < 2 ? $# : 2))
asked=" $* "
data=${MOLMESH_TEST_DATA:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# density NAME STRUCTURE SPACING [PDB2HIER OPTION…]: NAME.hier and NAME.vdb
density() {
  local name=$1 structure=$2 spacing=$3
  shift 3
  pdb2hier -q "$@" "$structure" -o "$name.hier"
  hier2density -q --spacing "$spacing" "$name.hier" -o "$name.vdb"
}
# mesh NAME REGION: NAME.tet.vtu, and NAME.vtu with better elements
mesh() {
  density2tet -q --region "$2" "$1.vdb" -o "$1.tet.vtu"
  tetsmooth -q --density "$1.vdb" "$1.tet.vtu" -o "$1.vtu"
}
# surface NAME STRUCTURE SPACING [PDB2HIER OPTION…]: NAME.vtu with labels, whose surface alone is of use
surface() {
  density "$@"
  density2tet -q "$1.vdb" | tetlabel -q - "$1.hier" -o "$1.vtu"
}
counted() { # MESH.vtu: its tetrahedra in words
  tetstat "$1" >"$1.txt"
  sed -n 's/.* points, \(.* tetrahedra\),.*/\1/p' "$1.txt"
}
draw() { # SCRIPT ARGUMENT…
  local script=$1
  shift
  if [ -n "${DISPLAY:-}" ]; then python3 "$docs/$script" "$@"; else xvfb-run -a python3 "$docs/$script" "$@"; fi
}
# picture NAME COLOURS: is it asked for? then it is made by the function of its name, put in place, and what it left is removed
picture() {
  [ "$asked" = "  " ] || [ "${asked#* "$1" }" != "$asked" ] || return 0
  echo "$1"
  "$1"
  if command -v pngquant >/dev/null; then pngquant --nofs "$2" --force --output "$folder/$1.png" "$1.png"
  else cp "$1.png" "$folder/$1.png"; fi
  rm -rf "${work:?}"/*
}

# recipe NAME MESH…: MESH.labels.vtu of complexes/NAME.sh, on GRID points or its own grid; COMPLEXES names a folder that may have them already
recipe() {
  local name=$1 mesh
  shift
  for mesh; do
    [ -e "${COMPLEXES:-}/$mesh.labels.vtu" ] || { MESHES=$* bash "$docs/../complexes/$name.sh" "$data" . >/dev/null 2>&1; return; }
  done
  for mesh; do ln -s "$(realpath "$COMPLEXES")/$mesh.labels.vtu" .; done
}

tii=$docs/../tests/data/1tii.pdb
red=CD3C32 green=82AF8C

1tii() {
  density 1tii "$tii" 1 && mesh 1tii both
  draw figures.py 1tii.png 1tii.vtu angles '' --view=-72,18,0 --size 1100,800
}
smoothing() {
  density 1tii "$tii" 2 && mesh 1tii interior
  draw figures.py smoothing.png 1tii.tet.vtu angles 'density2tet' 1tii.vtu angles 'tetsmooth' --same --lowest 13 --view=-72,18,0 --size 560,470
}
spacings() {
  local panels=() h
  for h in 4 2 1 0.5; do
    density "at$h" "$tii" "$h" && mesh "at$h" interior
    tetlabel -q "at$h.vtu" "at$h.hier" -o "labelled$h.vtu"
    panels+=("labelled$h.vtu" section "$h Å: $(counted "at$h.vtu")")
  done
  draw figures.py spacings.png "${panels[@]}" --same --columns 2 --view=-72,18,0 --size 480,400
}
labels() {
  local site=() chain
  density 1tii "$tii" 1 && mesh 1tii interior
  for chain in D E F G H; do site+=(--boundary "active_site=//$chain/40-60"); done
  tetlabel -q 1tii.vtu 1tii.hier "${site[@]}" -o labels.vtu
  draw labels.py labels.vtu labels.png
}
chains() {
  surface blurred "$tii" 1 -r '* P_R=0.05 P_C=0.5'
  surface detailed "$tii" 1 -r '* P_R=0.5 P_C=1'
  surface chain_d "$tii" 1 -r '* P_R=0.05 P_C=0.5' -r '//D P_R=0.5 P_C=1'
  draw figures.py chains.png blurred.vtu surface 'P_R 0.05, P_C 0.5' detailed.vtu surface 'P_R 0.5, P_C 1' \
    chain_d.vtu surface 'P_R 0.5, P_C 1 in chain D alone' --same --view=-90,65,20 --size 400,390 \
    --colour chain:D=$red --rest $green --legend "chain D=$red" --legend "the rest=$green"
}
domains() {
  printf 'pentamer //D,E,F,G,H\nA //A,C\n' >domains.txt
  local levels=(--levels domain,chain,residue --domains domains.txt)
  surface joined "$tii" 1 "${levels[@]}" -r '* P_R=0.2 P_C=0.5 P_D=0.1'
  surface apart "$tii" 1 "${levels[@]}" -r '* P_R=0.2 P_C=0.5 P_D=1'
  draw figures.py domains.png joined.vtu surface 'P_D 0.1' apart.vtu surface 'P_D 1' --same --view=-90,65,20 --size 400,390 \
    --colour domain:pentamer=$red --rest $green --legend "pentamer=$red" --legend "A=$green"
}
potential() { # by FreeFEM
  cp "$docs/../tests/data/1l2y.pqr" .
  make -s -f "$docs/../Makefile.pipeline" BIN="$bin" HIER2DENSITY_FLAGS='--spacing 0.35' COARSEN=no 1l2y.energy
  draw potential.py 1l2y.potential.vtu potential.png
}

# The paper's figures: docs/figures.md says what stands for what.

filament=(--columns 1 --size 1150,250 --view=-80,12,90 --clip y)
figure1() {
  recipe filament filament.exterior
  draw figures.py figure1.png filament.exterior.labels.vtu surface 'surface' filament.exterior.labels.vtu exterior 'exterior' \
    filament.exterior.labels.vtu embedded 'exterior, and the filament in it' "${filament[@]}" \
    --colour domain:actin=4CC8D8 --colour domain:tropomyosin=F2A8B8 --colour domain:troponin=F08C28 --colour chain:K=D040B8 \
    --legend actin=4CC8D8 --legend 'chain K=D040B8' --legend troponin=F08C28 --legend tropomyosin=F2A8B8
}
figure4() {
  GRID=257 recipe filament filament_blurred filament_kept
  draw figures.py figure4.png filament_blurred.labels.vtu surface 'P_D 0.25' \
    filament_kept.labels.vtu surface 'P_D 0.8 for actin and tropomyosin' \
    "${filament[@]}" --same --colour domain:actin=$green --colour domain:tropomyosin=$red \
    --legend actin=$green --legend tropomyosin=$red --legend troponin=BAC0C6
}
figure3() {
  local structure=$data/paper/4v5a_30s_for_1j5e.pdb.gz
  surface blurred "$structure" 1 -r '* P_R=0.05 P_C=0.5'
  surface detailed "$structure" 1 -r '* P_R=0.5 P_C=1'
  surface chain_b "$structure" 1 -r '* P_R=0.05 P_C=0.5' -r '//B P_R=0.5 P_C=1'
  draw figures.py figure3.png blurred.vtu surface 'P_R 0.05, P_C 0.5' detailed.vtu surface 'P_R 0.5, P_C 1' \
    chain_b.vtu surface 'P_R 0.5, P_C 1 in chain B alone' --same --view=65,-76,0 --size 400,390 \
    --colour chain:B=$red --rest $green --legend "chain B=$red" --legend "the rest=$green"
}
figure6() {
  pdb2hier -q -r '* P_R=0.5 P_C=1' "$data/paper/1a7m.pqr.gz" -o a.hier
  hier2density -q --grid 513 --band 0.9,1.1 a.hier | density2map -q -o narrow.mrc
  hier2density -q --grid 513 --band 0.1,2 a.hier | density2map -q -o wide.mrc
  draw figures.py figure6.png narrow.mrc inside 'inside' narrow.mrc band 'd_l 0.9, d_u 1.1' wide.mrc band 'd_l 0.1, d_u 2.0' --size 380,420
}
figure8() {
  local panels=() name file spacing caption options
  while IFS='|' read -r name file spacing caption options; do
    surface "$name" "$data/$file" "$spacing" $options -r '* P_R=0.5 P_C=1'
    panels+=("$name.vtu" surface "$caption")
  done <<'END'
1bor|paper/1bor.pqr|0.5|1BOR
1neq|paper/1neq.pqr|0.5|1NEQ
1a63|paper/1a63.pqr.gz|0.5|1A63
1a7m|paper/1a7m.pqr.gz|0.5|1A7M
1beb|paper/1beb.pdb.gz|0.5|1BEB, chain A
1yi5|typical/1yi5.pdb.gz|1|1YI5 for 1VNG
1a8r|paper/1a8r_for_1gtp.cif.gz|1|1A8R for 1GTP|--assembly 1
1gya|typical/1gya.pdb.gz|0.7|1GYA, all models, for 2KXH|--model all
END
  draw figures.py figure8.png "${panels[@]}" --columns 4 --size 290,300 --colour 'chain:*' --view=-60,25,0 --view=-60,25,0 \
    --view=-60,25,0 --view=-60,25,0 --view=-60,25,0 --view=-60,25,0 --view=-60,85,0 --view=-60,25,0
}
figure10() {
  local blue=4664D8 pink=F2A8B8 i heads=()
  recipe membrane membrane.exterior membrane.both
  recipe lattice lattice.exterior
  for i in 0 1 2 3 4 5; do heads+=(--colour "chain:${i}_head=$blue"); done
  draw figures.py figure10.png membrane.both.labels.vtu body 'pump in its membrane' membrane.exterior.labels.vtu exterior 'exterior' \
    membrane.both.labels.vtu both 'exterior, pump and membrane in it' lattice.exterior.labels.vtu surface 'lattice' \
    lattice.exterior.labels.vtu exterior 'exterior' lattice.exterior.labels.vtu embedded 'exterior, and the filaments in it' \
    --columns 3 --size 400,420 --view=-75,18,0 --clip y "${heads[@]}" --colour domain:pump=$blue --rest $pink \
    --legend "pump, heads=$blue" --legend "membrane, filaments=$pink"
}
figure11() {
  GRID=129 recipe machines ribosome synthetase
  GRID=65 recipe machines capsid
  draw figures.py figure11.png ribosome.labels.vtu section:B2 '4V6X for 2W4A' ribosome.labels.vtu parts 'eight parts' \
    synthetase.labels.vtu section:A,B,C '1HTQ' synthetase.labels.vtu parts 'eight parts' \
    capsid.labels.vtu section '2BTV for 2KU2' capsid.labels.vtu parts 'eight parts' \
    --columns 2 --size 400,360 --view=-70,20,0 --rest A8C8A8 \
    --legend 'in detail=4664D8' --legend 'the rest=A8C8A8' --legend 'cut=EEAAB4'
}

picture 1tii 160
picture smoothing 96
picture spacings 32
picture labels 128
picture chains 64
picture domains 64
picture potential 128
if [ -n "$data" ]; then
  picture figure1 96
  picture figure3 64
  picture figure4 64
  picture figure6 16
  picture figure8 96
  picture figure10 40
  picture figure11 48
else
  echo "MOLMESH_TEST_DATA names no folder: the paper's figures stay as they are"
fi
