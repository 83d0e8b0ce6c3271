#!/usr/bin/env bash
# freefem.sh [SCRIPT ARGUMENT…] — runs SCRIPT.edp of this folder with FreeFEM's plugins found. Without a script: is FreeFEM here? Status 77: no.
set -eu
command -v FreeFem++ >/dev/null || { echo "SKIPPED: no FreeFem++ (Debian: freefem++ libfreefem++)"; exit 77; }
# Debian's own search path names a folder of an older version.
plugin=$(find /usr/lib /usr/local/lib -name msh3.so -not -path '*/mpi/*' 2>/dev/null | head -n 1)
[ -n "$plugin" ] || { echo "SKIPPED: FreeFEM without its plugin msh3 (Debian: libfreefem++)"; exit 77; }
[ $# -gt 0 ] || exit 0
export FF_LOADPATH=${plugin%/*}
script=$1
shift
exec FreeFem++ -nw -v 0 "$(dirname "$0")/$script.edp" "$@"
