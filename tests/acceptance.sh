#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Measures the acceptance points that are too slow for tests/run.sh, and writes them into one table:
#
#   bash tests/acceptance.sh [--list] [POINT...]
#
# Without names, measures all points. A point that passed or was reported for the same source is not
# measured again, so that an interrupted run can be resumed. COLMAP's models are never computed
# again. The table is build/acceptance/table.md. Exit code 1 if a point fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bash apps/pipeline/install-deps.sh
cmake --preset release -DAXIAL_TESTS=ON --log-level=WARNING
cmake --build --preset release --target InterfaceCOLMAP DensifyPointCloud SimulateUnderwater \
  EvaluateReconstruction AlignModel RefinePoses ReconstructMesh RefineMesh TextureMesh \
  MapSurface CompareSurveys TransformScene ViewScene CalibrateHousing ReproducePaper ExtractFrames \
  FindTargets RestoreColors MeasureSurface ProjectLabels color_check color_baselines \
  map_check change_check held_out_check seam_check unseen_check \
  drawn_boards dive_photograph matching_benchmark man axial_python
exec python3 tests/acceptance/acceptance.py "$@"
