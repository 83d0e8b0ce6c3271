#!/usr/bin/env bash
# install.sh BUILD SOURCE COMPILER — installs the library of a build, builds the example against it alone, and runs it.
set -eu
build=$(realpath "$1") source=$(realpath "$2") compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --component library --prefix "$work/prefix" >"$work/log" || { cat "$work/log"; exit 1; }
if grep -rnE '#include [<"](hwy|CLI|nlohmann)' "$work/prefix/include"; then
  echo "an installed header needs more than the standard library"
  exit 1
fi
cmake -S "$source/tests/install" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS='-Wall -Wextra -Werror'
cmake --build "$work/build"
"$work/build/example"
