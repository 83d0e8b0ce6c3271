# common.sh — what the recipes share: arguments, inputs, and the way from a plan to meshes that are checked and labelled.
#
# A recipe is called as NAME.sh DATA OUT. DATA holds the structures, under the names that the recipe asks for, OUT takes
# what it makes. GRID is the number of grid points along the longest edge (513 in the paper) and DECAY the decay rate of the kernels, which
# the paper does not give: with those of the recipes its mesh is about as large as the paper's. MESHES, a list, makes these meshes
# alone. MODE and THREADS are --mode and -t of the programs, which have to be in PATH. Each stage leaves its run report: X.vdb.json beside
# X.vdb.
set -euo pipefail
recipe=$(basename "$0" .sh)
[ $# = 2 ] || { echo "usage: $0 DATA OUT" >&2; exit 2; }
data=$(realpath -m "$1")
mkdir -p "$2" && cd "$2"
common=(--mode "${MODE:-omp}" -t "${THREADS:-0}")

# needs FILE…: of DATA; a recipe without its structures says so, and is no failure.
needs() {
  local file
  for file; do
    [ -e "$data/$file" ] || { echo "$recipe: skipped, $data/$file is not there"; exit 0; }
  done
}

# points N: of the grid along its longest edge, where GRID does not say; decay: of the kernels
points() { export points=${GRID:-$1} decay=${DECAY:-0.15}; }

# asked MESH: is it one of MESHES?
asked() { [[ -z ${MESHES:-} || " $MESHES " == *" $1 "* ]]; }

# density NAME OPTION…: NAME.vdb of NAME.hier
density() {
  local name=$1
  shift
  hier2density "${common[@]}" "$@" "$name.hier" -o "$name.vdb" --report "$name.vdb.json"
}

# mesh NAME MESH OPTION…: MESH.tet.vtu of NAME.vdb with these options of density2tet; MESH.vtu, improved; MESH.labels.vtu, which
# names the structures of NAME.hier; MESH.txt, what tetstat says of MESH.vtu. `improve` and `labels`: more for tetsmooth and tetlabel.
mesh() {
  local name=$1 mesh=$2
  shift 2
  asked "$mesh" || return 0
  density2tet "${common[@]}" "$@" "$name.vdb" -o "$mesh.tet.vtu" --report "$mesh.tet.vtu.json"
  tetsmooth "${common[@]}" --density "$name.vdb" ${improve:-} "$mesh.tet.vtu" -o "$mesh.vtu" --report "$mesh.vtu.json"
  tetlabel -q ${labels:-} "$mesh.vtu" "$name.hier" -o "$mesh.labels.vtu"
  check "$mesh"
}

# check MESH: valid, without triangles that cross, angles within 25° and 140°? A mesh that is not makes the recipe end with status 5.
below=0
trap '[ $? != 0 ] || exit $below' EXIT
check() {
  tetstat --crossings --min-dihedral 25 --max-dihedral 140 "$1.vtu" -o "$1.txt" || below=5
  echo "$1.vtu: $(sed -n 2p "$1.txt"), $(sed -n 's/ tetrahedra,.*/ tetrahedra/p' "$1.txt")"
  sed -n '/^region/,/^$/p' "$1.txt"
}

# spacing Å: of that many points along an edge of that length
spacing() { awk -v l="$1" -v n="$points" 'BEGIN { printf "%.6g", l / (n - 1) }'; }

# strand: strand.hier, which stands for a piece of tropomyosin: two copies of a helix of PDB 1SU4 side by side, along z, their middle in the origin.
strand() {
  pdb2hier -q --select '//A/740-778' "$data/paper/1su4.pdb.gz" -o helix.hier
  cat >strand.join <<'END'
join 1
piece helix.hier chains=A:Tm matrix=-0.98448,0,-0.17551,54.693,0.09038,0.8572,-0.50699,-7.174,0.15044,-0.51498,-0.8439,15.333 lattice=1,2,1,0,-9.8,0
END
  hierjoin -q strand.join -o strand.hier
}
