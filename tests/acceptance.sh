#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The acceptance points that are too slow for tests/run.sh, each by name, into one table:
#
#   bash tests/acceptance.sh [--list] [POINT...]
#
# Resumable: a point measured for this very source is not measured again, and COLMAP's models are
# kept for good. Table: build/acceptance/table.md. Exit code 1 if a point fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/pipeline/steps.sh
bash apps/pipeline/install-deps.sh
build_programs
cmake --preset release -DAXIAL_TESTS=ON --log-level=WARNING
cmake --build --preset release --target held_out_check matching_benchmark RefinePoses
exec python3 tests/acceptance/acceptance.py "$@"
