#!/usr/bin/env bash
# build.sh — what conda runs. map2density reads no OpenVDB files and tetreport's pages have stills: conda-forge's OpenVDB
# is large, and three.js is not there.
set -eu
# shellcheck disable=SC2086
cmake -S . -B build -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DMOLMESH_TESTS=OFF -DMOLMESH_CUDA=OFF -DMOLMESH_OPENVDB=OFF
cmake --build build
cmake --install build
