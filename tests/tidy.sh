#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Reads all sources outside tests/ with clang-tidy 14 (package clang-tidy) and the checks of .clang-tidy. Every finding
# is an error.
#     bash tests/tidy.sh             # about half an hour
#     bash tests/tidy.sh libs/pose/  # only compiled files whose path matches
# Precompiled headers are left out, because clang-tidy may be of another version than the compiler.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset release -B build/tidy -DAXIAL_TESTS=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
cmake --build build/tidy --target axial_commit > /dev/null
run-clang-tidy -p build/tidy -quiet -j 1 -extra-arg=-Wno-unused-command-line-argument \
  -extra-arg=-Wno-unknown-warning-option \
  "${1:-/(refractive|libs|apps)/}"
