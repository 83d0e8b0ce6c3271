#!/usr/bin/env bash
# array.sh BUILD SOURCE — molmesh-array on a real Slurm: twelve structures, one of them broken, one killed, one over its
# time limit; a second call; the bytes of `make -j`; and kill -9 at ten random moments of arrays of four structures.
set -eu
build=$(realpath "$1") source=$(realpath "$2")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
. "$here/slurm.sh"
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEFILES OMP_NUM_THREADS
export LC_ALL=C.UTF-8
trap 'stop_slurm; rm -rf "$work"' EXIT
start_slurm || exit $?

fail() { # fail MESSAGE [FILE]
  echo "FAILED: $1"
  [ $# = 1 ] || cat "$2"
  tail -n 3 "$work"/*/array/log/* 2>/dev/null | tail -n 60
  exit 1
}

# An installation that may only be read, in a folder whose name holds a blank. Two of its programs meet with accidents:
# hier2density is killed once at the structure `killed`, density2tet hangs once at the structure `slow`.
prefix="$work/in stalled"
mkdir -p "$prefix/bin" "$prefix/share"
cp -r "$build/share/molmesh" "$prefix/share/"
cp "$source/tools/molmesh-array" "$prefix/bin/"
cp "$source/Makefile.pipeline" "$prefix/share/molmesh/"
for program in pdb2hier hier2density densityjoin density2tet tetsmooth; do ln -s "$build/bin/$program" "$prefix/bin/"; done
rm "$prefix/bin/hier2density" "$prefix/bin/density2tet"
cat >"$prefix/bin/hier2density" <<END
#!/bin/bash
case "\$*" in *killed*) if mkdir "$work/was_killed"; then
  mkfifo "$work/never"
  "$build/bin/hier2density" "$work/never" -o never.vdb & # it has opened its output and reads its input
  exec 3>"$work/never"
  sleep 0.2
  kill -9 \$!
  wait \$!
  kill -9 \$\$
fi 2>/dev/null;; esac
exec "$build/bin/hier2density" "\$@"
END
cat >"$prefix/bin/density2tet" <<END
#!/bin/bash
case "\$*" in *slow*) if mkdir "$work/was_slow" 2>/dev/null; then exec sleep 1000; fi;; esac
exec "$build/bin/density2tet" "\$@"
END
chmod +x "$prefix"/bin/*
chmod -R a-w "$prefix"
touch "$work/installed"
array="$prefix/bin/molmesh-array"
options=(--hier2density '--spacing 2' --tetsmooth "--iterations 3 --parts 2" --mem 100M --cpus 1)

# Pieces of 1TII with names as people give them.
structures="$work/some structures"
mkdir "$structures"
n=0
for name in a 'b c' "it's" 'd  e (1)' killed slow 'f;g' h 'i&j' 'k.l'; do
  n=$((n + 1))
  awk -v n=$n '/^ATOM/ && substr($0, 22, 1) == "D" { r = substr($0, 23, 4) + 0; if (r > 8 * n && r <= 8 * n + 10) print }' \
    "$source/tests/data/1tii.pdb" >"$structures/$name.pdb"
  [ -s "$structures/$name.pdb" ] || fail "no atoms for $name"
done
gzip -c "$structures/a.pdb" >"$structures/packed.pdb.gz"
{ head -n 5 "$structures/a.pdb"; echo 'ATOM      6  CB  ALA D  10      12.345  xx.000  -3.200  1.00 20.00           C'; } \
  >"$structures/broken.pdb"

out="$work/the out"
"$array" -o "$out" "$structures" "${options[@]}" --throttle 6 --time 1 -- --signal=B:USR1@50 >"$work/first.txt" 2>&1 ||
  fail "the first call: status $?" "$work/first.txt"

# The density in tiles. One structure is broken.
"$array" -o "$work/tiled" "$structures/a.pdb" "$structures/b c.pdb" "$structures/broken.pdb" "${options[@]}" --tiles 3 --time 5 \
  >"$work/tiled.txt" 2>&1 || fail "the call with tiles: status $?" "$work/tiled.txt"

# Meanwhile ten arrays of four structures; in each, one process of a task is killed at a random moment.
seed=${SEED:-$$}
RANDOM=$seed
four=("$structures/a.pdb" "$structures/b c.pdb" "$structures/k.l.pdb" "$structures/it's.pdb")
declare -A due
for n in $(seq 10); do due[$n]=$(($(date +%s%3N) + RANDOM % 10000)); done
{
  for n in $(seq 10); do "$array" -o "$work/kill$n" "${four[@]}" "${options[@]}" --time 5 >"$work/kill$n.txt" 2>&1 & done
  wait
} &
submission=$! # on a busy machine tasks run before it ends
while [ ${#due[@]} -gt 0 ] &&
  { kill -0 $submission 2>/dev/null || [ -n "$(squeue -h --name=pdb2hier,hier2density,density2tet,tetsmooth)" ]; }; do
  now=$(date +%s%3N)
  while read -r process n; do
    [ "${due[$n]:-$now}" -lt "$now" ] && kill -9 "$process" 2>/dev/null && unset "due[$n]"
  done < <(ls -l /proc/[0-9]*/cwd 2>/dev/null | sed -nE "s,.* /proc/([0-9]+)/cwd -> $work/kill([0-9]+)\$,\1 \2,p" |
    shuf --random-source=<(yes $RANDOM)) || true
done
echo "killed a process of $((10 - ${#due[@]})) arrays, seed $seed: $SECONDS s"
wait
[ ${#due[@]} -le 5 ] || fail "expected at least 5 kills"
while [ -n "$(squeue -h)" ]; do sleep 0.5; done
echo "all jobs are over: $SECONDS s"
[ -e "$out/summary.tsv" ] || fail "no summary" "$work/first.txt"
# row STRUCTURE STAGE: "status: message"
row() { awk -F '\t' -v s="$1" -v g="$2" '$1 == s && $2 == g { print $10 ": " $11 }' "$out/summary.tsv"; }
expect() { [[ $(row "$1" "$2") == $3 ]] || fail "$1, $2: found '$(row "$1" "$2")', expected '$3'" "$out/summary.tsv"; }
expect broken pdb2hier 'failed: pdb2hier: broken.pdb:6: *'
expect broken tetsmooth 'not run: *'
expect killed pdb2hier 'done: '
expect killed hier2density 'failed: ended by a signal: Killed'
expect killed density2tet 'not run: *'
expect slow tetsmooth 'done: '
[ "$(awk -F '\t' '$2 == "tetsmooth" && $10 == "done" && $5 > 100 && $3 > 0 && $4 > 1e6 && $6 > 1 && $8 > 1' "$out/summary.tsv" | wc -l)" = 10 ] ||
  fail "expected 10 finished rows with figures" "$out/summary.tsv"
grep -q '"threads": 1,' "$out/a.vtu.json" || fail "a.vtu.json: threads, expected --cpus" "$out/a.vtu.json"
grep -q 'starts again with twice the time' "$out"/array/log/* || fail "the slow task did not go back into the queue"

# A second call does what is missing, and no more.
touch "$work/second"
"$array" -o "$out" "$structures" "${options[@]}" --wait >"$work/second.txt" 2>&1 && fail "the second call: status 0" "$work/second.txt"
expect killed tetsmooth 'done: '
expect broken pdb2hier 'failed: *'
[ "$(find "$out" -maxdepth 1 -name '*.vtu' ! -name '*.tet.vtu' | wc -l)" = 11 ] || fail "expected 11 meshes"
made=$(find "$out" -maxdepth 1 -newer "$work/second" -type f ! -name summary.tsv ! -name 'killed.*')
[ -z "$made" ] || fail "made again: $made"

# The bytes of make -j, here of densities in two tiles. A .vdb has a new UUID, of 36 letters, at each write.
same_files() { # same_files FOLDER FOLDER
  local file name
  for file in "$1"/*.hier "$1"/*.vtu "$1"/*.vdb; do
    name=$(basename "$file")
    case $name in
      *.vdb) [ "$(stat -c %s "$file")" = "$(stat -c %s "$2/$name")" ] && [ "$(cmp -l "$file" "$2/$name" | wc -l)" -le 36 ] ;;
      *) cmp -s "$file" "$2/$name" ;;
    esac || fail "$name differs: $1, $2"
  done
}
mkdir "$work/make"
for file in "$structures"/*; do ln -s "$file" "$work/make/"; done
goals=()
for file in "$out"/*.vdb; do goals+=("$(basename "$file" .vdb).vtu"); done
(cd "$work/make" && make -s -j4 -f "$prefix/share/molmesh/Makefile.pipeline" BIN="$prefix/bin" THREADS=1 TILES=2 \
  HIER2DENSITY_FLAGS='--spacing 2' TETSMOOTH_FLAGS='--iterations 3 --parts 2' -- "${goals[@]}") >"$work/make.txt" 2>&1 ||
  fail "make -j" "$work/make.txt"
same_files "$work/make" "$out"

# The same by tiles.
[ "$(ls "$work/tiled" | grep -c -e '\.vtu$' -e '\.vdb$' -e '-of-3\.tile\.json$')" = 12 ] || fail "tiled: $(ls "$work/tiled")"
same_files "$work/tiled" "$out"
grep -q "^b c	hier2density	[0-9.]*	[0-9]*.*	done" "$work/tiled/summary.tsv" || fail "tiled: no row" "$work/tiled/summary.tsv"
grep -q "^broken	hier2density	.*	not run" "$work/tiled/summary.tsv" || fail "tiled: broken" "$work/tiled/summary.tsv"

# The same of the arrays that were disturbed.
for n in $(seq 10); do
  "$array" -o "$work/kill$n" "${four[@]}" "${options[@]}" --wait >"$work/again$n.txt" 2>&1 || echo "$n" >>"$work/bad" &
done
wait
[ ! -e "$work/bad" ] || fail "second calls after a kill" "$work/again$(head -n 1 "$work/bad").txt"
for n in $(seq 10); do
  for name in a 'b c' k.l "it's"; do
    for suffix in hier vdb tet.vtu vtu hier.json vdb.json tet.vtu.json vtu.json; do
      [ -s "$work/kill$n/$name.$suffix" ] || fail "kill$n: $name.$suffix is missing"
    done
  done
  same_files "$work/kill$n" "$out"
done

changed=$(find "$prefix" -newer "$work/installed")
[ -z "$changed" ] || fail "the installation changed: $changed"
echo "good: $SECONDS s"
