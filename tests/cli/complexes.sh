#!/usr/bin/env bash
# complexes.sh BIN SOURCE — what the recipes of complexes/ do, on tests/data alone: a membrane that the box cuts, and a lattice by both routes.
set -eu
bin=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export PATH="$bin:$PATH" LC_ALL=C.UTF-8
failed() { echo "FAILED: $*"; exit 1; }
# near NAME FOUND EXPECTED SHARE
near() {
  echo "$1: found $2, expected $3"
  awk -v f="$2" -v e="$3" -v s="$4" 'BEGIN { exit !(f >= e * (1 - s) && f <= e * (1 + s)) }' || failed "not within $4"
}

# A recipe without its structures says so, and is no failure.
for recipe in "$source"/complexes/*.sh; do
  name=$(basename "$recipe" .sh)
  [ "$name" = common ] || "$recipe" nowhere skipped | grep "^$name: skipped.*nowhere/.* is not there$"
done

cat >small.sh <<'END'
. "$SOURCE/complexes/common.sh"
needs 1tii.pdb
pdb2hier -q --select '//D' "$data/1tii.pdb" -o protein.hier

cat >membrane.join <<'E'
join 1
piece protein.hier domain=protein translate=-55,3,-26
body leaflets slab center=0,0,0 normal=0,0,1 thickness=16 width=140 domain=membrane P_R=0.5
E
hierjoin -q membrane.join -o membrane.hier
density membrane --spacing 2.5
for region in exterior both; do
  mesh membrane membrane.$region --region $region --cavities fill --box -40,-40,-45,40,40,45
done
improve='--hier membrane.hier' mesh membrane membrane.regions --region both --regions domain --hier membrane.hier --cavities fill --box -40,-40,-45,40,40,45

cat >rod.join <<'E'
join 1
body rod cylinder from=0,0,-80 to=0,0,100 radius=14 P_R=0.5 P_C=0.7
E
hierjoin -q rod.join -o rod.hier
for part in protein rod; do density $part --spacing 2.5; done
cat >lattice.join <<'E'
join 1
piece protein.hier domain=filaments helix=2,55,0 translate=-55,3,-26
piece rod.hier domain=rod_1 prefix=1_ translate=45,0,0
piece rod.hier domain=rod_2 prefix=2_ translate=-45,0,0
E
cat >assembled.join <<'E'
join 1
piece protein.vdb helix=2,55,0 translate=-55,3,-26
piece rod.vdb lattice=2,1,1,90,0,0 translate=-45,0,0
E
hierjoin -q lattice.join -o lattice.hier
density lattice --spacing 2.5
densityjoin --combine max assembled.join -o assembled.vdb
cp lattice.hier assembled.hier
mesh lattice lattice --region both --box -65,-30,-10,65,30,60
labels=--other-structure mesh assembled assembled --region both --box -65,-30,-10,65,30,60
END
SOURCE=$source THREADS=1 bash small.sh "$source/tests/data" out
cd out

# planes MESH X0 Y0 Z0 X1 Y1 Z1: every point of a wall (12 to 17 in Gmsh's numbers) is in its plane, and each wall has triangles.
planes() {
  local mesh=$1
  shift
  tetconvert -q "$mesh.vtu" -o "$mesh.mesh"
  awk -v planes="$*" 'BEGIN { split(planes, b, " "); w[12] = b[1]; w[13] = b[4]; w[14] = b[2]; w[15] = b[5]; w[16] = b[3]; w[17] = b[6] }
    /^Vertices/ { getline n; for (i = 1; i <= n; ++i) { getline; for (k = 0; k < 3; ++k) x[i, k] = $(k + 1) } }
    /^Triangles/ { getline n; for (i = 1; i <= n; ++i) { getline; if ($4 in w) { ++on[$4]
      for (k = 1; k < 4; ++k) if (x[$k, int(($4 - 12) / 2)] != w[$4]) { print "a point off wall", $4; exit 1 } } } }
    END { for (k = 12; k < 18; ++k) if (!on[k]) { print "no wall", k; exit 1 } }' "$mesh.mesh" || failed "$mesh: walls"
}
for mesh in membrane.exterior membrane.both membrane.regions lattice assembled; do
  grep -qx valid "$mesh.txt" || failed "$mesh is not valid"
done
planes membrane.both -40 -40 -45 40 40 45
planes lattice -65 -30 -10 65 30 60
[ "$(awk '$2 == "outside" { print $6 }' membrane.exterior.txt)" = 2 ] || failed "the membrane does not divide the exterior into two"

grep -q '^ *4 *protein ' membrane.regions.txt && grep -q '^ *5 *membrane ' membrane.regions.txt || failed "no regions of protein and membrane"

# Labels: the membrane's triangles are on its faces, those of a cylinder around its axis.
tetlabel -q membrane.both.vtu membrane.hier --boundary membrane=//leaflets -o named.vtu
tetlabel -q lattice.vtu lattice.hier --boundary first=//1_rod --boundary second=//2_rod -o rods.vtu
tetconvert -q named.vtu -o named.mesh
tetconvert -q rods.vtu -o rods.mesh
centers() { # MESH NUMBER: centroids of its triangles
  awk -v number="$2" '/^Vertices/ { getline n; for (i = 1; i <= n; ++i) { getline; for (k = 0; k < 3; ++k) x[i, k] = $(k + 1) } }
    /^Triangles/ { getline n; for (i = 1; i <= n; ++i) { getline; if ($4 == number)
      print (x[$1, 0] + x[$2, 0] + x[$3, 0]) / 3, (x[$1, 1] + x[$2, 1] + x[$3, 1]) / 3, (x[$1, 2] + x[$2, 2] + x[$3, 2]) / 3 } }' "$1.mesh"
}
centers named 18 | awk '{ ++n; off += $1 * $1 + $2 * $2 > 900 && ($3 * $3 < 49 || $3 * $3 > 81) } END { print n, off; exit !(n > 300 && off == 0) }' ||
  failed "triangles of the membrane that are not on it"
centers rods 18 | awk '{ ++n; r = sqrt(($1 - 45) ^ 2 + $2 ^ 2); off += r < 13 || r > 15 } END { print n, off; exit !(n > 500 && off == 0) }' ||
  failed "triangles of a cylinder that are not on it"

# Both routes give the same lattice, on grids whose points lie elsewhere in the proteins.
volume() { awk '$2 == "molecule" { gsub(",", "", $4); print $4 }' "$1.txt"; }
near "volume of the assembled lattice" "$(volume assembled)" "$(volume lattice)" 0.005
