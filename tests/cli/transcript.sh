#!/usr/bin/env bash
# transcript.sh — runs a transcript and compares: every command's standard output, standard error and exit status.
#
#   transcript.sh [--record] BIN SOURCE FILE     BIN: folder of the programs; SOURCE: root of the project
#
# A transcript: `$ command` is given to bash in an empty folder that the whole file shares, with BIN first in PATH and
# $SOURCE set; `> line` is expected on standard output, `! line` on standard error, `? N` is the exit status (0 when
# absent); `…` in an expected line stands for any text; `#` is a comment. `% command` is what the transcript needs: where
# that fails it says so and is skipped (77). --record writes what happened into FILE.
set -u
record=no
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEFILES # make check is how this is often run
if [ "$1" = --record ]; then record=yes; shift; fi
bin=$(realpath "$1") SOURCE=$(realpath "$2") file=$(realpath "$3")
export TOOLS="pdb2hier hier2density density2tet tetsmooth tetstat density2map"
export SOURCE PATH="$bin:$PATH" LC_ALL=C.UTF-8
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/work" && cd "$folder/work" || exit 1

# matches ACTUAL EXPECTED: equal line by line, … being any text.
matches() {
  local -a actual expected
  mapfile -t actual <<<"$1"
  mapfile -t expected <<<"$2"
  [ ${#actual[@]} = ${#expected[@]} ] || return 1
  local i c pattern
  for i in "${!expected[@]}"; do
    pattern=${expected[i]//\\/\\\\}
    for c in '*' '?' '[' ']' '(' ')' '|' '+' '@' '!'; do pattern=${pattern//"$c"/\\"$c"}; done
    [[ ${actual[i]} == ${pattern//…/*} ]] || return 1
  done
}

prefixed() { [ -z "$2" ] || sed "s/^/$1 /; s/ *$//" <<<"$2"; }

failures=0 command='' out='' err='' status=0 line_number=0 command_line=0
finish() { # the command before is complete: run it, compare
  [ -n "$command" ] || return 0
  bash -c "$command" >"$folder/out" 2>"$folder/err" </dev/null
  local got_status=$? got_out got_err
  out=${out%$'\n'} err=${err%$'\n'} # as $(…) does
  got_out=$(tr '\0' '?' <"$folder/out") got_err=$(tr '\0' '?' <"$folder/err")
  if [ "$got_status" = "$status" ] && matches "$got_out" "$out" && matches "$got_err" "$err"; then
    [ $record = no ] || recorded+=$(printf '%s\n' "\$ $command"; prefixed '>' "$out"; prefixed '!' "$err"
      [ "$status" = 0 ] || echo "? $status")$'\n'
  else
    failures=$((failures + 1))
    if [ $record = yes ]; then
      recorded+=$(printf '%s\n' "\$ $command"; prefixed '>' "$got_out"; prefixed '!' "$got_err"
        [ "$got_status" = 0 ] || echo "? $got_status")$'\n'
    else
      echo "$file:$command_line: $ $command"
      diff <(prefixed '>' "$out"; prefixed '!' "$err"; echo "? $status") \
           <(prefixed '>' "$got_out"; prefixed '!' "$got_err"; echo "? $got_status") |
        sed -n 's/^</  expected/p; s/^>/  found   /p'
    fi
  fi
  command='' out='' err='' status=0
}

recorded=''
while IFS= read -r line || [ -n "$line" ]; do
  line_number=$((line_number + 1))
  case $line in
    '$ '*) finish; command=${line#'$ '} command_line=$line_number ;;
    '> '* | '>') line=${line#>}; out+=${line#' '}$'\n' ;;
    '! '* | '!') line=${line#!}; err+=${line#' '}$'\n' ;;
    '? '*) status=${line#'? '} ;;
    '% '*)
      finish; recorded+=$line$'\n'
      bash -c "${line#'% '}" >/dev/null 2>&1 </dev/null || { echo "$file: skipped, not here: ${line#'% '}"; exit 77; } ;;
    '' | '#'*) finish; recorded+=$line$'\n' ;;
    *) echo "$file:$line_number: found '$line', expected a line that begins with \$, >, !, ?, % or #"; exit 1 ;;
  esac
done <"$file"
finish
if [ $record = yes ]; then
  printf '%s' "$recorded" >"$file"
  echo "$file: recorded, $failures changed"
  exit 0
fi
[ $failures = 0 ]
