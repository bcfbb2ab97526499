#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Reconstructs point clouds from photographs in three ways, and measures each cloud against ground
# truth: in air; under water behind a flat port, with --refractive; and under water as is common
# today, without refraction, with a lens that COLMAP calibrates itself. The first two clouds become
# textured meshes, and these become maps. A page for the browser shows the survey under water.
#
#   bash apps/pipeline/demo.sh [closeup|reef] [--full]
#
# Needs Debian 12, and a network connection to install packages. --full: matching at full resolution;
# without it, at half the width and height. Results:
# build/demo/{air,refractive,selfcalibrated}.ply, {air,refractive}.glb, {air,refractive}_map.*,
# surveys.change.*, refractive_page/index.html, table.json and report.html.
# Another run keeps COLMAP's models and the ground truth. axial_pipeline/demo.py runs the steps.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

die() {
  echo "error: $*" >&2
  exit 1
}

# Prints the headline of a stage, with the time since the start.
stage() { printf '\n[%02d:%02d] %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; }

for argument in "$@"; do
  [[ $argument == closeup || $argument == reef || $argument == --full ]] ||
    die "usage: demo.sh [closeup|reef] [--full]"
done

stage "Packages"
bash apps/pipeline/install-deps.sh

stage "Build"
mkdir -p build
if ! cmake --preset release >build/configure.log 2>&1 </dev/null; then
  tail -n 20 build/configure.log >&2
  die "cmake --preset release: failed, its output is in build/configure.log"
fi
cmake --build --preset release --target InterfaceCOLMAP DensifyPointCloud SimulateUnderwater \
  EvaluateReconstruction AlignModel ReconstructMesh RefineMesh TextureMesh MapSurface \
  CompareSurveys ViewScene

PYTHONPATH=apps/pipeline exec python3 -B -m axial_pipeline.demo --seconds $SECONDS "$@"
