#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs missing packages, builds, and runs all tests under CTest. Each unit test is built once:
# the tests of base, lens, io, scene, picture and cloud with AddressSanitizer and
# UndefinedBehaviorSanitizer ("sanitized/..."), the other tests in the release build, like the
# programs. The build with sanitizers also gives every file reader wrong input for 2 seconds
# ("fuzz/...").
#
#   bash tests/run.sh [--all] [CTEST-OPTION...]
#
# --all: builds every unit test in both builds, runs the program tests that take minutes, and gives
# the readers wrong input for 30 seconds each. Other arguments go to ctest: tests/run.sh -R io.
# One CTest run covers both builds, so its summary at the end counts all tests.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CTEST_OUTPUT_ON_FAILURE=1

every=OFF
if [[ ${1:-} == --all ]]; then
  every=ON
  shift
fi

bash apps/pipeline/install-deps.sh

for preset in release sanitize; do
  echo "=== Building ($preset)"
  cmake --preset "$preset" -DAXIAL_TESTS=ON -DAXIAL_WERROR=ON -DAXIAL_EVERY_TEST=$every --log-level=WARNING
done
cmake --build --preset release
cmake --build --preset sanitize --target axial_tests

printf 'subdirs(release clang)\n' >build/CTestTestfile.cmake
# Two tests more than there are processors: tests of workflows wait most of their time.
exec ctest --test-dir build --parallel "$(($(nproc) + 2))" --no-tests=error "$@"
