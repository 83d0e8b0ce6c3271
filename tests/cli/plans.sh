#!/usr/bin/env bash
# plans.sh BIN SOURCE — plans beside what the runs then report, and a run that is refused beside the one that fits.
set -eu
bin=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export PATH="$bin:$PATH" LC_ALL=C.UTF-8 OMP_NUM_THREADS=1
unset SLURM_MEM_PER_NODE
# near NAME PLANNED TRUE LOWER UPPER: LOWER ≤ PLANNED/TRUE ≤ UPPER
near() {
  echo "$1: planned $2, true $3"
  awk -v p="$2" -v t="$3" -v l="$4" -v u="$5" 'BEGIN { exit !(p >= l * t && p <= u * t) }' || { echo "FAILED: expected $4 to $5 times"; exit 1; }
}
# field FILE NAME…: a number of a JSON file, by its path
field() { python3 -c 'import functools, json, sys; print(functools.reduce(lambda v, k: v[k], sys.argv[2:], json.load(open(sys.argv[1]))))' "$@"; }

pdb2hier -q "$source/tests/data/1tii.pdb" -o a.hier
for h in 1 0.5; do
  hier2density --plan --json --spacing $h a.hier -o plan.json
  hier2density -q --spacing $h a.hier -o a.vdb --report r.json
  near "$h Å, active points" "$(field plan.json active_points)" "$(field r.json counts active_points)" 0.95 1.05
  for region in interior both; do
    density2tet --plan --json --region $region a.vdb -o mesh.json
    density2tet -q --region $region a.vdb -o a.tet.vtu --report t.json
    true=$(field t.json counts tetrahedra)
    near "$h Å, $region, elements, from atoms" "$(field plan.json density2tet $region elements)" "$true" 0.85 1.15
    near "$h Å, $region, elements" "$(field mesh.json elements)" "$true" 0.85 1.15
    near "$h Å, $region, memory" "$(field mesh.json memory_bytes)" "$(field t.json peak_rss_bytes)" 0.9 1.3
  done
done
tetsmooth --plan --density a.vdb a.tet.vtu --json -o smooth.json
near "tetsmooth, elements before" "$(field smooth.json elements_before)" "$true" 1 1
tetsmooth --plan --density a.vdb a.tet.vtu | grep -q '^memory '
[ ! -e out.vtu ]

# Seconds follow the speed of each stage, of which molmesh-array measures three.
unset MOLMESH_SPEED
seconds=$(field plan.json seconds) low=$(field plan.json density2tet both seconds) last=$(field plan.json tetsmooth both seconds)
MOLMESH_SPEED=2,4,0.5 hier2density --plan --json --spacing 0.5 a.hier -o fast.json
near "hier2density, twice as fast" "$(field fast.json seconds)" "$seconds" 0.499 0.501
near "density2tet, four times as fast" "$(field fast.json density2tet both seconds)" "$low" 0.249 0.251
near "tetsmooth, half as fast" "$(field fast.json tetsmooth both seconds)" "$last" 1.99 2.01
MOLMESH_SPEED=2,4,0.5 hier2density --plan --json --speed 1 --spacing 0.5 a.hier -o plain.json
near "as given" "$(field plain.json seconds)" "$seconds" 1 1
line=$(molmesh-array --measure-speed --hier2density '--spacing 1' "$source/tests/data/1l2y.pqr")
echo "$line"
[[ $line =~ ^MOLMESH_SPEED=[0-9.]+,[0-9.]+,[0-9.]+$ ]]
env "$line" hier2density --plan a.hier >/dev/null
if molmesh-array --wrong 2>message; then echo "FAILED: --wrong is an option?"; exit 1; fi
[ "$(wc -l <message)" = 1 ]
grep -q "unrecognized arguments: --wrong" message

# Refused beforehand; the spacing that the message names fits.
if density2tet -q --region both --max-mem 100M a.vdb -o out.vtu 2>message; then echo "FAILED: 100M are enough?"; exit 1; fi
cat message
[ "$(wc -l <message)" = 1 ]
[ ! -e out.vtu ]
spacing=$(grep -oP -- '--spacing \K[0-9.]+' message)
hier2density -q --spacing "$spacing" a.hier -o b.vdb
density2tet -q --region both --max-mem 100M b.vdb -o b.tet.vtu --report t.json
near "memory at $spacing Å" "$(field t.json peak_rss_bytes)" 104857600 0.3 1
# The batch system's limit is the default, and can be put aside.
if SLURM_MEM_PER_NODE=100 density2tet -q --region both a.vdb -o out.vtu 2>message; then echo "FAILED: Slurm's limit"; exit 1; fi
grep -q "batch system" message
SLURM_MEM_PER_NODE=100 density2tet -q --region both --max-mem none a.vdb -o out.vtu
