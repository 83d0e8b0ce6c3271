#!/usr/bin/env bash
# gpu.sh — the cuda mode on a real GPU: parity of all stages, memory errors, times. Needs an NVIDIA GPU and the CUDA
# toolkit, nothing else; or, with -d, a driver built before (`tests/gpu.sh -c DIR` builds it there and stops).
#   tests/gpu.sh [-c DIR] [-d DRIVER] [-b BIN] [-s SPACING] [-n REPEATS] [FILE.hier…]
# BIN: a folder with pdb2hier, hier2density, density2tet and tetsmooth; then FILEs may be structures and the table of
# the three modes of the whole programs is printed too. Exit status: 0 all held, 1 something did not, 6 no GPU.
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
compile='' driver='' bin='' spacing=1 repeats=5
while getopts c:d:b:s:n: o; do
  case $o in
  c) compile=$OPTARG ;;
  d) driver=$OPTARG ;;
  b) bin=$OPTARG ;;
  s) spacing=$OPTARG ;;
  n) repeats=$OPTARG ;;
  *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
PATH=$PATH:/usr/local/cuda/bin

build() { # build DRIVER ARCHITECTURE: cuda/ and libcommon/ with nvcc and the standard library alone
  local out=$1 objects work jobs=0 f name failed=0
  work=$(dirname "$out")/objects
  mkdir -p "$work"
  # What needs Highway, nanoflann, METIS or CLI11 is not used here.
  objects=$(cd "$root" && ls cuda/*/*.cu cuda/*/*.cpp libcommon/{par,molecule,density,contour,contour/detail,improve,mesh}/*.cpp \
    formats/hier/{hier_reader,text}.cpp tests/gpu/*.cpp tests/gpu/*.cu 2>/dev/null |
    grep -vE 'block_kernel.cpp|cluster_tree.cpp|partition.cpp|carry.cpp')
  for f in $objects; do
    name=$work/${f//\//_}.o
    if [ "$name" -nt "$root/$f" ] && [ -z "$(find "$root"/{cuda,libcommon,formats/hier,tests/gpu} -name '*.h*' -newer "$name" -print -quit)" ]; then
      continue
    fi
    flags='-Xcompiler=-ffp-contract=off,-fopenmp,-ffunction-sections'
    case $f in cuda/improve/*.cu | cuda/contour/*.cu) flags="$flags --fmad=false" ;; esac
    (cd "$root" && nvcc -std=c++20 -O3 --expt-relaxed-constexpr $flags $2 -I. -Ilibcommon -Itests -c "$f" -o "$name") || echo "$f" >>"$work/failed" &
    jobs=$((jobs + 1))
    [ $((jobs % $(nproc))) -ne 0 ] || wait
  done
  wait
  [ ! -e "$work/failed" ] || failed=1
  rm -f "$work/failed"
  # Unused parts of the host's density, which ask for Highway, go with their sections.
  [ $failed = 0 ] && nvcc -O3 "$work"/*.o -o "$out" -Xcompiler=-fopenmp -Xlinker=--gc-sections
}

if [ -n "$compile" ]; then
  command -v nvcc >/dev/null || { echo "gpu.sh: no nvcc here"; exit 1; }
  mkdir -p "$compile"
  build "$compile/molmesh_gpu" "${ARCH:--gencode arch=compute_75,code=sm_75 -gencode arch=compute_90,code=[sm_90,compute_90]}" &&
    echo "gpu.sh: built $compile/molmesh_gpu"
  exit
fi
if ! nvidia-smi -L 2>/dev/null | grep -q GPU; then
  echo "gpu.sh: no NVIDIA GPU here: nothing was run, nothing is known"
  exit 6
fi
nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ -z "$driver" ]; then
  command -v nvcc >/dev/null || { echo "gpu.sh: no nvcc here and no -d DRIVER"; exit 1; }
  driver=$work/molmesh_gpu
  build "$driver" -arch=native || { echo "gpu.sh: the driver was not built"; exit 1; }
fi
status=0
held() { "$@" || { status=1; echo "gpu.sh: FAILED: $*"; }; }

echo "== parity, random small cases"
held "$driver" small
echo "== compute-sanitizer, random small cases"
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck initcheck synccheck; do
    if timeout 1800 compute-sanitizer --tool "$tool" --error-exitcode 1 --print-limit 5 "$driver" small >"$work/$tool" 2>&1; then
      echo "ok     $tool"
    else
      status=1
      echo "FAILED $tool"
      tail -n 40 "$work/$tool"
    fi
  done
else
  echo "not installed: not run"
fi

for file in "$@"; do
  hier=$file
  case $file in
  *.hier) ;;
  *)
    [ -n "$bin" ] || { echo "gpu.sh: $file: structures need -b BIN"; status=1; continue; }
    hier=$work/$(basename "$file").hier
    "$bin/pdb2hier" -q -r '* P_R=0.5 P_C=1' "$file" -o "$hier" || { status=1; continue; }
    ;;
  esac
  echo "== $(basename "$file"), $spacing Å: parity"
  held "$driver" parity "$hier" "$spacing"
  echo "== $(basename "$file"), $spacing Å: times, medians of $repeats"
  held "$driver" time "$hier" "$spacing" "$repeats"
  [ -n "$bin" ] || continue
  echo "== $(basename "$file"), $spacing Å: whole programs, medians of $repeats; seconds by phase"
  for mode in seq omp cuda; do
    for ((i = 0; i < repeats; ++i)); do
      "$bin/hier2density" -q --mode $mode --spacing "$spacing" "$hier" -o "$work/g.vdb" --report "$work/1.$mode.$i" &&
        "$bin/density2tet" -q --mode $mode --region both --adapt 0 "$work/g.vdb" -o "$work/m.vtu" --report "$work/2.$mode.$i" &&
        "$bin/tetsmooth" -q --mode $mode --density "$work/g.vdb" "$work/m.vtu" -o "$work/s.vtu" --report "$work/3.$mode.$i" ||
        { [ $? = 5 ] || { status=1; echo "gpu.sh: FAILED: the chain in mode $mode"; break; }; }
    done
    python3 - "$work" "$mode" "$repeats" <<'PY' || echo "(no python3: no table)"
import json, statistics, sys
work, mode, repeats = sys.argv[1], sys.argv[2], int(sys.argv[3])
for stage in "123":
    runs = []
    for i in range(repeats):
        try:
            runs.append(json.load(open(f"{work}/{stage}.{mode}.{i}")))
        except OSError:
            pass
    if runs:
        names = [p["name"] for p in runs[0]["phases"]]
        line = ", ".join(f'{n} {statistics.median(sum(p["seconds"] for p in r["phases"] if p["name"] == n) for r in runs):.3f}' for n in dict.fromkeys(names))
        print(f'{runs[0]["tool"]:14} {mode:5} {line}')
PY
  done
done
exit $status
