#!/usr/bin/env bash
# pages.sh — the pages of the docs are those of the programs' options; man pages and completion are right.
#
#   pages.sh BUILD SOURCE PROGRAM...     BUILD: build folder, with bin/
set -u
export LC_ALL=C.UTF-8
build=$(realpath "$1") source=$(realpath "$2")
shift 2
failures=0
fail() { echo "$1"; failures=$((failures + 1)); }
remake='cmake --build build --target program_pages'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for program; do
  for kind in man bash markdown; do
    "$build/bin/$program" --help=$kind >"$work/$kind" || fail "$program --help=$kind: status $?"
  done
  cmp -s "$work/markdown" "$source/docs/programs/$program.md" ||
    fail "docs/programs/$program.md: differs from the program's options, made again by: $remake"
  for other in "$program" $(sed -n '/^## See also/,$p' "$work/markdown" | grep -o '([a-z0-9]*\.md)' | tr -d '()' | sed 's/\.md$//'); do
    [[ " $* " == *" $other "* ]] || fail "$program: see also $other, which is no program"
  done
  for file in $(grep -o 'formats/[A-Za-z0-9/.]*\.md' "$work/markdown"); do
    [ -e "$source/$file" ] || fail "$program: names $file, which is not there"
  done
  [ "$("$build/bin/$program" --help | wc -l)" -le 60 ] || fail "$program --help: more than 60 lines"
  if command -v groff >/dev/null; then
    groff -man -Tutf8 -ww "$work/man" 2>"$work/warnings" | sed 's/.\x08//g' >"$work/page" # no overstrikes
    [ ! -s "$work/warnings" ] || fail "$program --help=man: $(head -n 1 "$work/warnings")"
    for part in NAME SYNOPSIS DESCRIPTION OPTIONS EXAMPLES 'EXIT STATUS' FILES 'SEE ALSO'; do
      grep -q "$part" "$work/page" || fail "$program --help=man: has no $part"
    done
  fi
done
for page in "$source"/docs/programs/*.md; do
  name=$(basename "$page" .md)
  [[ " $* " == *" $name "* ]] || fail "docs/programs/$name.md: is of no program"
done

# complete LINE WORDS...: what bash offers after LINE holds all WORDS, and no word that begins otherwise.
complete_with() {
  local line=$1
  shift
  local -a COMP_WORDS COMPREPLY=()
  read -ra COMP_WORDS <<<"${line//=/ = }"
  [[ $line != *[\ =] ]] || COMP_WORDS+=('')
  [[ $line != *= ]] || unset 'COMP_WORDS[-1]'
  local COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  "_molmesh_${COMP_WORDS[0]}"
  for word; do
    [[ " ${COMPREPLY[*]} " == *" $word "* ]] || fail "completion of '$line': found '${COMPREPLY[*]}', expected $word"
  done
}
complete() { :; }
for program; do
  eval "$("$build/bin/$program" --help=bash)" || fail "$program --help=bash: bash does not read it"
  cd "$work" || exit 1
  complete_with "$program --mo" --mode
  complete_with "$program --mode " seq omp cuda
  complete_with "$program --mode=s" seq
  complete_with "$program --mode=" seq
  complete_with "$program -o ma" man markdown
  complete_with "$program ma" man markdown
done
[ $failures = 0 ]
