#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Reconstructs point clouds from photographs in three ways, and measures each cloud against ground
# truth: in air; under water behind a flat port, with --refractive; and under water as is common
# today, without refraction, with a lens that COLMAP calibrates itself.
#
#   bash apps/pipeline/demo.sh [closeup|reef] [--full]
#
# Needs Debian 12, and a network connection to install packages. --full: full resolution; without
# it, images are halved in width and height. Results:
# build/demo/{air,refractive,selfcalibrated}.ply, table.json and report.html. Another run keeps
# COLMAP's models and the ground truth.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source apps/pipeline/steps.sh

scene=closeup
resolution=(--resolution-level 1 --min-resolution 320)
size=half
for argument in "$@"; do
  case $argument in
    closeup | reef) scene=$argument ;;
    --full) resolution=(--resolution-level 0) size=full ;;
    *) die "usage: demo.sh [closeup|reef] [--full]" ;;
  esac
done
tolerance=0.002
[[ $scene == reef ]] && tolerance=0.005

bin=build/release/bin
data=data/synthetic/$scene
out=build/demo
work=$out/work/$scene
truth=$work/truth
mkdir -p "$work"

stage "Packages"
bash apps/pipeline/install-deps.sh

stage "Build"
build_programs

stage "Ground truth of the scene '$scene', simulated again from its seed"
make_truth "$scene" "$truth"

lens=$(pinhole_parameters "$data/sparse")
stage "Poses from the photographs in air (COLMAP, true intrinsics)"
colmap_model "$data/air" "$work/poses" PINHOLE "$lens" fixed
align_to_truth "$work/poses/model" "$data/sparse" "$work/poses/metric"

stage "Poses without a port: COLMAP calibrates a lens from the photographs under water"
colmap_model "$data/water" "$work/poses-today" OPENCV "$lens,0,0,0,0" free
align_to_truth "$work/poses-today/model" "$data/sparse" "$work/poses-today/metric"

# reconstruct RUN POSES MEDIUM IMPORT-OPTIONS... -- DENSIFY-OPTIONS...: reconstructs the photographs
# of MEDIUM from scratch on the COLMAP model POSES, in the folder $work/RUN.
reconstruct() {
  local run=$work/$1 poses=$2 medium=$3 import=()
  shift 3
  while [[ $1 != -- ]]; do import+=("$1"); shift; done
  shift
  rm -rf "$run"
  "$bin/InterfaceCOLMAP" -i "$poses" --image-folder "$data/$medium" -o "$run/scene.mvs" "${import[@]}"
  densify "$run" "${resolution[@]}" "$@"
}

stage "(a) In air"
reconstruct air "$work/poses/metric" air --
stage "(b) Under water, refractive, same poses"
reconstruct refractive "$work/poses/metric" water --housing "$data/housing.json" -- --refractive
stage "(c) Under water, self-calibrated lens, no refraction"
reconstruct selfcalibrated "$work/poses-today/metric" water --

# evaluate RUN NAME OPTION...: compares the cloud with the true mesh. Writes RUN/NAME.json, the
# cloud coloured by error (NAME.ply) and a picture of it (NAME.png).
evaluate() {
  local run=$work/$1 name=$2
  shift 2
  "$bin/EvaluateReconstruction" -i "$run/scene_dense.ply" -m "$truth/mesh.ply" \
    --cameras "$data/sparse" --tolerance "$tolerance" --json "$run/$name.json" \
    --error-cloud "$run/$name.ply" --picture "$run/$name.png" --picture-width 900 "$@"
}

# depth_pictures RUN MEDIUM POSES: draws two depth maps beside the truth. The number in a depth
# map's file name is COLMAP's image id minus one.
depth_pictures() {
  local run=$work/$1 name id
  for name in 0000 0005; do
    id=$(awk -v name="$name.jpg" '$10 == name { print $1 - 1 }' "$3/images.txt")
    [[ -n $id ]] || continue
    "$bin/EvaluateReconstruction" -i "$run/$(printf 'depth%04d.dmap' "$id")" \
      -m "$truth/$2/$name.distance.tiff" --tolerance "$tolerance" --picture "$run/depth-$name.png"
  done
}

stage "Comparison with the ground truth"
wet=(--housing "$data/housing.json")
evaluate air evaluation
evaluate refractive evaluation "${wet[@]}"
evaluate selfcalibrated evaluation "${wet[@]}"
evaluate selfcalibrated evaluation-moved "${wet[@]}" --align icp
depth_pictures air air "$work/poses/metric" >"$work/depth.log"
depth_pictures refractive water "$work/poses/metric" >>"$work/depth.log"
for run in air refractive selfcalibrated; do cp "$work/$run/scene_dense.ply" "$out/$run.ply"; done

stage "Done: $out/{air,refractive,selfcalibrated}.ply, $out/table.json, $out/report.html"
python3 apps/pipeline/report.py --work "$work" --out "$out" --scene "$scene" --size "$size"
