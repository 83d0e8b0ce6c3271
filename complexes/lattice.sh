#!/usr/bin/env bash
# lattice.sh — a piece of muscle's lattice, six thin filaments and four thick ones, in a box that cuts all (figure 10 d to f of the paper):
# lattice.sh DATA OUT.
#
# Stand-ins: a thin filament is F-actin (34 copies of a subunit of the 28-mer, without hydrogens), tropomyosin as in filament.sh, and six
# copies of PDB 1SU4 in place of myosin heads. Thick filaments are cylinders without atoms, as in the paper. Exponents are the paper's:
# P_R 0.5 and P_C 0.3; heads have 0.7 and 0.4. The filaments lie on the trigonal points between the cylinders, 256 Å away.
#
# Makes the lattice by both routes. Exactly: lattice.hier, of all atoms, lattice.vdb, lattice.exterior.vtu, lattice.both.vtu. Assembled from the
# densities of one filament and one cylinder: lattice_assembled.vdb, lattice_assembled.both.vtu. Beside each .vtu: .labels.vtu (the
# domain names the filament or cylinder), .txt, .json.
. "$(dirname "$0")/common.sh"
needs paper/actin_filament_28mer_for_2w4u_derived.pdb.gz paper/1su4.pdb.gz
points 97

pdb2hier -q --hydrogens drop --select '//A' "$data/paper/actin_filament_28mer_for_2w4u_derived.pdb.gz" -o actin_1.hier
pdb2hier -q "$data/paper/1su4.pdb.gz" -o head.hier
strand

cat >lattice_filament.join <<'END'
join 1
piece actin_1.hier P_R=0.5 P_C=0.3 chains=A:actin translate=0,0,-55 rotate=0,0,1,-27.2 helix=34,27.5,-166.4
piece strand.hier  P_R=0.5 P_C=0.3 rotate=1,0,0,-19 translate=40,0,-27.5 rotate=0,0,1,70.8 helix=17,55,27.2 helix=2,27.5,-166.4
piece head.hier    P_R=0.7 P_C=0.4 chains=A:head matrix=0.92989,0,0.36784,-65.613,0.11395,0.95081,-0.28806,-29.342,-0.34975,0.30978,0.88415,-16.161 rotate=0,1,0,50 translate=92,0,68 rotate=0,0,1,30 helix=6,136.5,60
END
spacing=$(spacing 819.2)
# cylinder X Y Z: a thick filament, moved by so much
cylinder() {
  awk -v x="$1" -v y="$2" -v z="$3" 'BEGIN {
    printf "join 1\nbody cylinder cylinder from=%.9f,%.9f,%.9f to=%.9f,%.9f,%.9f radius=80 P_R=0.5 P_C=0.3\n", x, y, z - 80, x, y, z + 900
  }' >lattice_cylinder.join
  hierjoin -q lattice_cylinder.join -o lattice_cylinder.hier
  density lattice_cylinder --decay "$decay" --spacing "$spacing"
}
# origin NAME: the first point of its grid, a coordinate a line
origin() { awk '/"origin"/ { on = 1; next } on && /\]/ { exit } on { gsub(/[ ,]/, ""); print }' "$1.vdb.json"; }
hierjoin -q lattice_filament.join -o lattice_filament.hier
density lattice_filament --decay "$decay" --spacing "$spacing"
# Each grid begins where its atoms do. Cylinders go half a spacing at most, so that their points are the filament's, some whole spacings
# away; and places are whole spacings apart (on 513 points as they are, on coarser grids up to half a spacing beside): all pieces are
# copied bit for bit.
cylinder 0 0 0
cylinder $(paste <(origin lattice_filament) <(origin lattice_cylinder) |
  awk -v h="$spacing" '{ d = ($1 - $2) / h; printf "%.9f ", h * (d - sprintf("%.0f", d)) }')

# whole X,Y…: the nearest places that are whole spacings away; those of 513 points are
whole() { printf '%s\n' "$@" | awk -F, -v h="$spacing" '{ printf "%.9f,%.9f\n", h * sprintf("%.0f", $1 / h), h * sprintf("%.0f", $2 / h) }'; }
filaments=($(whole 224,-128 672,128 224,128 448,256 0,256 448,512))
cylinders=($(whole 0,0 448,0 224,384 672,384))
# plan ENDING: a plan of the pieces lattice_filament.ENDING and lattice_cylinder.ENDING; names for what has atoms
plan() {
  local i names
  echo 'join 1'
  for i in "${!filaments[@]}"; do
    [ "$1" = hier ] && names="domain=filament_$((i + 1)) prefix=${i}_" || names=
    echo "piece lattice_filament.$1 translate=${filaments[i]},0 $names"
  done
  for i in "${!cylinders[@]}"; do
    [ "$1" = hier ] && names="domain=cylinder_$((i + 1)) prefix=${i}_" || names=
    echo "piece lattice_cylinder.$1 translate=${cylinders[i]},0 $names"
  done
}
plan hier >lattice.join
plan vdb >lattice_assembled.join
box=-60,-190,0,732,574,819.2

hierjoin lattice.join -o lattice.hier
density lattice --decay "$decay" --spacing "$spacing"
mesh lattice lattice.exterior --adapt 0.4 --region exterior --box $box
mesh lattice lattice.both --adapt 0.4 --region both --box $box

# The parts are over 20 Å apart, where the union is the sum.
densityjoin "${common[@]}" --combine max lattice_assembled.join -o lattice_assembled.vdb --report lattice_assembled.vdb.json
ln -sf lattice.hier lattice_assembled.hier
labels=--other-structure mesh lattice_assembled lattice_assembled.both --adapt 0.4 --region both --box $box
