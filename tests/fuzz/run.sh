#!/usr/bin/env bash
# run.sh SECONDS [READER…]: builds the libFuzzer targets in build-sanitize, then runs each for SECONDS, as many
# at a time as there are cores. What it finds stays in build-sanitize/found; a finding is status 1.
set -u
cd "$(dirname "$0")/../.." || exit 1
seconds=$1
shift
readers=("$@")
[ ${#readers[@]} -gt 0 ] || readers=(hier join vtu mesh vdb pdb mmcif mmjson pqr rules map plan)
cmake --preset sanitize >/dev/null && cmake --build --preset sanitize --target "${readers[@]/#/fuzz_}" || exit 1

fuzz() { # fuzz READER: its seeds are the samples of its format and what an earlier run kept
  local reader=$1 seeds=() folder
  for folder in "tests/fuzz/corpus/$reader" "formats/$reader/samples/passed" "formats/$reader/samples/failed"; do
    [ -d "$folder" ] && seeds+=("$folder")
  done
  [ "$reader" = pdb ] && seeds+=(tests/data/cases) # it chooses the format
  [ "$reader" = mesh ] && seeds+=(formats/{gmsh,medit,vtk,vtu}/samples/{passed,failed})
  mkdir -p "build-sanitize/corpus/$reader" build-sanitize/found
  if "build-sanitize/bin/fuzz_$reader" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build-sanitize/found/$reader-" "build-sanitize/corpus/$reader" "${seeds[@]}" >"build-sanitize/$reader.log" 2>&1; then
    echo "$reader: $(sed -n 's/^stat::number_of_executed_units: *//p' "build-sanitize/$reader.log") inputs"
  else
    echo "$reader: FOUND"
    tail -n 40 "build-sanitize/$reader.log"
    return 1
  fi
}
export -f fuzz
export seconds
printf '%s\n' "${readers[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz {}'
