#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what is missing, builds, and runs every test under CTest: all of them in the release
# build, and the unit and reader tests once more under AddressSanitizer and
# UndefinedBehaviorSanitizer ("sanitized/..."). One CTest run over both builds, so its summary,
# printed last, counts everything. Arguments go to ctest: tests/run.sh -R io/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CTEST_OUTPUT_ON_FAILURE=1

bash apps/pipeline/install-deps.sh

for preset in release sanitize; do
  echo "=== Building ($preset)"
  cmake --preset "$preset" -DAXIAL_TESTS=ON --log-level=WARNING
done
cmake --build --preset release
cmake --build --preset sanitize --target axial_tests

printf 'subdirs(release sanitize)\n' >build/CTestTestfile.cmake
exec ctest --test-dir build --parallel "$(nproc)" --no-tests=error "$@"
