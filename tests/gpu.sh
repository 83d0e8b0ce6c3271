#!/usr/bin/env bash
# gpu.sh — the cuda mode on a real GPU: parity of all stages, memory errors, times. Needs an NVIDIA GPU and the CUDA
# toolkit, nothing else; or a folder made before, elsewhere.
#   tests/gpu.sh [-d DIR] [-b BIN] [-s SPACING | -g POINTS] [-m MODEL] [-n REPEATS] [-l STAGE] [-t THREADS] [-T] [-P]
#     [-H] [FILE…]
#   tests/gpu.sh -c DIR [-b BIN] [-m MODEL] [FILE…]
#   tests/gpu.sh -L
# FILE: a .hier, a .pdb, or any structure (MODEL of it: first, all, a number) where there are programs. BIN: a folder with
# pdb2hier, hier2density, density2tet and tetsmooth: then the table of the three modes of the whole programs too.
# -c: what can be carried, and no more: the driver, the programs and the shared libraries that they need, the
# hierarchies of the FILEs. -d: nothing is built; without FILEs those of the folder. -l: the last stage: density, mesh
# or improve. -t: threads of the host that the device is compared with. -T: times only, no parity. -P: those of the
# whole programs only. -H: no GPU, the device's algorithms on the host's threads. -L: lists what is compiled. Exit
# status: 0 all held, 1 something did not, 6 no GPU.
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
compile='' dir='' bin='' spacing=1 points='' model=first repeats=5 host='' last=improve threads=$(nproc) parity=yes programs=''
while getopts c:d:b:s:g:m:n:l:t:TPHL o; do
  case $o in
  c) compile=$OPTARG ;;
  d) dir=$OPTARG ;;
  b) bin=$OPTARG ;;
  s) spacing=$OPTARG ;;
  g) points=$OPTARG ;;
  m) model=$OPTARG ;;
  n) repeats=$OPTARG ;;
  l) last=$OPTARG ;;
  t) threads=$OPTARG ;;
  T) parity='' ;;
  P) parity='' programs=only ;;
  H) host=host ;;
  L) list=yes ;;
  *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
PATH=$PATH:/usr/local/cuda/bin
status=0
case $last in density | mesh | improve) ;; *) echo "gpu.sh: -l: expected density, mesh or improve" >&2; exit 2 ;; esac
failed() { status=1; echo "gpu.sh: FAILED: $*"; }

sources() { # of the driver. What needs Highway, nanoflann or METIS is not used by it, or stands in alone/.
  (cd "$root" && ls cuda/*/*.cu cuda/*/*.cpp libcommon/*/*.cpp libcommon/*/*/*.cpp \
    formats/hier/{hier_reader,text}.cpp tests/gpu/*.cpp tests/gpu/alone/*.cpp tests/gpu/*.cu 2>/dev/null |
    grep -vE '_simd.cpp|kd_tree.cpp|partition.cpp|attribute_transfer.cpp|nearest_points.cpp|libcommon/label/')
}

build() { # build DRIVER FLAGS: cuda/ and libcommon/ with nvcc and the standard library alone
  local out=$1 work jobs=0 f name flags
  work=$(dirname "$out")/objects
  mkdir -p "$work"
  for f in $(sources); do
    name=$work/${f//\//_}.o
    if [ "$name" -nt "$root/$f" ] && [ -z "$(find "$root"/{cuda,libcommon,formats/hier,tests/gpu} -name '*.h*' -newer "$name" -print -quit)" ]; then
      continue
    fi
    flags='-Xcompiler=-ffp-contract=off,-fopenmp,-ffunction-sections'
    case $f in cuda/optimize/*.cu | cuda/contour/*.cu) flags="$flags --fmad=false" ;; esac
    (cd "$root" && nvcc -std=c++20 -O3 --expt-relaxed-constexpr $flags $2 -I. -Ilibcommon -Itests -c "$f" -o "$name") || echo "$f" >>"$work/failed" &
    jobs=$((jobs + 1))
    [ $((jobs % $(nproc))) -ne 0 ] || wait
  done
  wait
  if [ -e "$work/failed" ]; then
    rm -f "$work/failed"
    return 1
  fi
  # Unused parts of the host's density, which ask for Highway, go with their sections.
  nvcc -O3 "$work"/*.o -o "$out" -Xcompiler=-fopenmp,-static-libstdc++,-static-libgcc -Xlinker=--gc-sections
}

plain_hier() { # plain_hier FILE: a .hier of a plain PDB file's first model, as pdb2hier would make it, where there is none
  awk '/^ENDMDL/ { exit }
    /^(ATOM|HETATM)/ && substr($0, 18, 3) != "HOH" && substr($0, 17, 1) ~ /[ A]/ {
      chain = substr($0, 22, 1); residue = substr($0, 18, 3) ":" substr($0, 23, 5); gsub(/ /, "", residue)
      element = substr($0, 77, 2); gsub(/ /, "", element); name = substr($0, 13, 4); gsub(/ /, "", name)
      if (!n++) print "hier 1\nlevels chain residue"
      if (chain != open) { print "chain", chain, 1; inner = "" }
      if (residue != inner) print "residue", residue, 0.5
      open = chain; inner = residue
      radius = element == "H" ? 1.2 : element == "N" ? 1.55 : element == "O" ? 1.52 : element == "S" ? 1.8 : 1.7
      print "atom", name, (element == "" ? "X" : element), substr($0, 31, 8) + 0, substr($0, 39, 8) + 0, substr($0, 47, 8) + 0, radius
    }
    END { exit !n }' "$1"
}

hierarchy() { # hierarchy FILE FOLDER: prints the name of the .hier, made in FOLDER where FILE is a structure
  local hier
  hier=$2/$(basename "$1" .hier).hier
  case $1 in
  *.hier) [ -r "$1" ] && echo "$1" ;;
  *)
    if [ -n "$bin" ]; then
      "$bin/pdb2hier" -q --model "$model" -r '* P_R=0.5 P_C=1' "$1" -o "$hier" && echo "$hier"
    elif [[ $1 == *.pdb ]]; then
      plain_hier "$1" >"$hier" && echo "$hier"
    else
      echo "gpu.sh: $1: structures other than .pdb need -b BIN" >&2
      return 1
    fi
    ;;
  esac
}

carry() { # carry DIR FILE…: programs, libraries and hierarchies beside the driver
  local to=$1 file hier
  shift
  mkdir -p "$to/bin" "$to/lib"
  [ -z "$bin" ] || cp "$bin"/{pdb2hier,hier2density,density2tet,tetsmooth} "$to/bin/" || return 1
  # The C library and the driver's are the machine's own.
  for file in $(ldd "$to/molmesh_gpu" "$to"/bin/* 2>/dev/null | awk '$2 == "=>" && $3 ~ /^\// { print $3 }' | sort -u |
    grep -vE '/(libc|libm|libdl|librt|libpthread|libcuda)\.so'); do
    cp "$file" "$to/lib/" || return 1
  done
  for file in "$@"; do
    hier=$(hierarchy "$file" "$to") || return 1
    [ "$hier" -ef "$to/$(basename "$hier")" ] || cp "$hier" "$to/" || return 1
  done
}

if [ -n "${list:-}" ]; then
  sources
  exit
fi
if [ -n "$compile" ]; then
  command -v nvcc >/dev/null || { echo "gpu.sh: no nvcc here"; exit 1; }
  mkdir -p "$compile" && compile=$(cd "$compile" && pwd) || exit 1
  build "$compile/molmesh_gpu" "${ARCH:--gencode arch=compute_75,code=[sm_75,compute_75] -gencode arch=compute_90,code=[sm_90,compute_90]}" &&
    carry "$compile" "$@" && echo "gpu.sh: made $compile: $(cd "$compile" && ls -d molmesh_gpu bin/* *.hier 2>/dev/null | tr '\n' ' ')"
  exit
fi
if [ -z "$host" ]; then
  if command -v nvidia-smi >/dev/null; then
    nvidia-smi -L 2>/dev/null | grep -q GPU
  else
    [ -e /dev/nvidia0 ]
  fi || { echo "gpu.sh: no NVIDIA GPU here: nothing was run, nothing is known"; exit 6; }
  nvidia-smi --query-gpu=name,driver_version,memory.total --format=csv,noheader 2>/dev/null
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
driver=$work/molmesh_gpu
if [ -n "$dir" ]; then
  dir=$(cd "$dir" && pwd) || exit 1
  driver=$dir/molmesh_gpu
  [ -n "$bin" ] || [ ! -x "$dir/bin/pdb2hier" ] || bin=$dir/bin
  [ ! -d "$dir/lib" ] || export LD_LIBRARY_PATH=$dir/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  [ $# -gt 0 ] || ! ls "$dir"/*.hier >/dev/null 2>&1 || set -- "$dir"/*.hier
else
  command -v nvcc >/dev/null || { echo "gpu.sh: no nvcc here and no -d DIR"; exit 1; }
  build "$driver" "${ARCH:--arch=native}" || { echo "gpu.sh: the driver was not built"; exit 1; }
fi
export CUDA_MODULE_LOADING=EAGER # a kernel's first launch is no slower than the next
held() {
  "$@"
  case $? in
  0) ;;
  6) [ -n "$host" ] || exit 6 ;;&
  *) failed "$*" ;;
  esac
}

[ -z "$parity" ] || echo "== parity, random small cases"
[ -z "$parity" ] || held "$driver" $host small ${host:+6}

chain() { # chain MODE RUN HIER: the three programs, their reports in $work
  local grid=(--spacing "$spacing")
  local how=(-q --mode "$1")
  [ -z "$points" ] || grid=(--grid "$points")
  [ "$1" != omp ] || how+=(-t "$threads")
  "$bin/hier2density" "${how[@]}" "${grid[@]}" "$3" -o "$work/g.vdb" --report "$work/1.$1.$2" || return
  [ "$last" != density ] || return 0
  "$bin/density2tet" "${how[@]}" --region both "$work/g.vdb" -o "$work/m.vtu" --report "$work/2.$1.$2" || return
  [ "$last" != mesh ] || return 0
  "$bin/tetsmooth" "${how[@]}" --density "$work/g.vdb" "$work/m.vtu" -o "$work/s.vtu" --report "$work/3.$1.$2"
}

table() { # table MODES: medians of what chain left, a row a phase, a column a mode; then kernels and copies
  awk -v modes="$1" '
    function median(list,   v, n, i, j, t) {
      n = split(list, v, " ")
      for (i = 2; i <= n; ++i)
        for (j = i; j > 1 && v[j] + 0 < v[j - 1] + 0; --j) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
      return v[int((n + 1) / 2)]
    }
    function add(row, mode, seconds) {
      if (!(row in known)) { known[row] = 1; rows[++count] = row }
      run[row, mode, FILENAME] += seconds
    }
    FNR == 1 { split(FILENAME, part, "/"); split(part[length(part)], name, "."); mode = name[2]; in_phases = 0 }
    /"tool":/ { gsub(/[",]/, "", $2); tool = $2 }
    /"phases":/ { in_phases = 1 }
    /"kernels":/ { in_phases = 0 }
    /"name":/ { what = $0; sub(/^[^:]*: "/, "", what); sub(/",?$/, "", what) }
    /"seconds":/ {
      seconds = $2 + 0
      if (in_phases) { add(tool " " what, mode, seconds); sum[mode, name[3]] += seconds }
      else add(tool (what ~ /^copies/ ? ", copies" : ", kernels"), mode, seconds)
    }
    END {
      n = split(modes, m, " ")
      printf "%-40s", "seconds"
      for (k = 1; k <= n; ++k) printf "%12s", m[k]
      print ""
      for (key in run) { split(key, k3, SUBSEP); list[k3[1], k3[2]] = list[k3[1], k3[2]] " " run[key] }
      for (key in sum) { split(key, k2, SUBSEP); total[k2[1]] = total[k2[1]] " " sum[key] }
      for (i = 1; i <= count; ++i) {
        printf "%-40s", rows[i]
        for (k = 1; k <= n; ++k)
          if ((rows[i], m[k]) in list) printf "%12.4f", median(list[rows[i], m[k]]); else printf "%12s", ""
        print ""
      }
      printf "%-40s", "the whole chain"
      for (k = 1; k <= n; ++k) printf "%12.4f", median(total[m[k]])
      print ""
    }' "$work"/[123].*
}

grid=$spacing grid_name="$spacing Å" modes='seq omp cuda'
[ -z "$points" ] || grid=n$points grid_name="$points points"
[ -z "$host" ] || modes='seq omp'
for file in "$@"; do
  hier=$(hierarchy "$file" "$work") || { failed "$file"; continue; }
  at="$(basename "$file"), $grid_name"
  [ -z "$parity" ] || echo "== $at: parity"
  [ -z "$parity" ] || held "$driver" $host parity "$hier" "$grid" "$last"
  if [ -z "$programs" ]; then
    echo "== $at: times, medians of $repeats"
    held "$driver" $host time "$hier" "$grid" "$last" "$repeats" "$threads"
  fi
  [ -n "$bin" ] || continue
  echo "== $at: whole programs, medians of $repeats"
  rm -f "$work"/[123].*
  for mode in $modes; do
    for ((i = 0; i < repeats; ++i)); do
      chain "$mode" "$i" "$hier" || { failed "the chain in mode $mode"; break; }
    done
  done
  table "$modes"
  grep -H '"active_points"' "$work"/1.*.0 | sed 's,.*/1\.\([a-z]*\)\.0:,\1,' # the host's own search beside the device's
done
if [ -z "$host" ] && [ -n "$parity" ]; then # last: it takes longest, and may not be allowed
  echo "== compute-sanitizer, some of the small cases"
  command -v compute-sanitizer >/dev/null || echo "not installed: not run"
  for tool in $(! command -v compute-sanitizer >/dev/null || echo memcheck racecheck initcheck synccheck); do
    cases='small 6'
    [ "$tool" != racecheck ] || cases=tiny # it takes longest
    # shellcheck disable=SC2086 # two words
    timeout "${SANITIZE:-300}" compute-sanitizer --tool "$tool" --error-exitcode 1 --print-limit 5 "$driver" $cases >"$work/$tool" 2>&1
    case $? in
    0) echo "ok     $tool" ;;
    124) echo "none   $tool: not finished" ;;
    *)
      if grep -q 'Device not supported' "$work/$tool"; then
        echo "none   $tool: not supported here"
      else
        failed "$tool"
        tail -n 40 "$work/$tool"
      fi
      ;;
    esac
  done
fi
exit $status
