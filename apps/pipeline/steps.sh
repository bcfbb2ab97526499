# SPDX-License-Identifier: GPL-3.0-or-later
# Steps that the demo and the acceptance tests share. Scripts source this file. The steps expect the
# folder of the programs in $bin, and end the script if something fails.

started=$SECONDS

# Prints the headline of a stage, with the time since the start.
stage() { printf '\n[%02d:%02d] %s\n' $(((SECONDS - started) / 60)) $(((SECONDS - started) % 60)) "$*"; }

die() {
  echo "error: $*" >&2
  exit 1
}

# logged FILE COMMAND...: writes the command's output to FILE; if the command fails, prints the last
# 20 lines and ends the script.
logged() {
  local log=$1
  shift
  if ! "$@" >"$log" 2>&1 </dev/null; then
    tail -n 20 "$log" >&2
    die "failed (all of its output is in $log): $*"
  fi
}

# Configures and builds the programs in release mode.
build_programs() {
  mkdir -p build
  logged build/configure.log cmake --preset release
  cmake --build --preset release --target InterfaceCOLMAP DensifyPointCloud SimulateUnderwater \
    EvaluateReconstruction AlignModel
}

# make_truth SCENE FOLDER: writes the ground truth of data/synthetic/SCENE, which is not in git,
# simulated again from its seed. Does nothing if the same SimulateUnderwater binary wrote it before.
make_truth() {
  local made_by
  made_by=$(sha1sum <"$bin/SimulateUnderwater")
  [[ $(cat "$2/made-by" 2>/dev/null) == "$made_by" ]] && return
  "$bin/SimulateUnderwater" --preset "$1" --seed 1 --truth-only -o "$2"
  echo "$made_by" >"$2/made-by"
}

# pinhole_parameters MODEL: prints "fx,fy,cx,cy" of the only PINHOLE camera of a text model.
pinhole_parameters() { awk '$2 == "PINHOLE" { print $5 "," $6 "," $7 "," $8 }' "$1/cameras.txt"; }

# registered_images MODEL: prints the number of images in a binary model.
registered_images() { od -An -tu8 -N8 "$1/images.bin" | tr -d ' '; }

# colmap_model IMAGES WORK MODEL PARAMETERS fixed|free: poses and sparse points from photographs.
# All photographs share one camera of the type MODEL. Its intrinsics stay at PARAMETERS (fixed) or
# start there (free). The model with the most images becomes WORK/model. Does nothing if WORK/model
# exists, because COLMAP gives a different model in each run.
colmap_model() {
  local images=$1 work=$2 model=$3 parameters=$4 refine=1
  [[ -f $work/model/images.bin ]] && { echo "  (kept from an earlier run: $work/model)"; return; }
  [[ $5 == fixed ]] && refine=0
  rm -rf "$work"
  mkdir -p "$work/models"
  echo "  features of $(find "$images" -name '*.jpg' | wc -l) images"
  logged "$work/features.log" colmap feature_extractor --database_path "$work/database.db" \
    --image_path "$images" --ImageReader.single_camera 1 --ImageReader.camera_model "$model" \
    --ImageReader.camera_params "$parameters" --SiftExtraction.use_gpu 0
  echo "  matches of all pairs"
  logged "$work/matches.log" colmap exhaustive_matcher --database_path "$work/database.db" \
    --SiftMatching.use_gpu 0
  echo "  poses"
  logged "$work/mapper.log" colmap mapper --database_path "$work/database.db" \
    --image_path "$images" --output_path "$work/models" \
    --Mapper.ba_refine_focal_length $refine --Mapper.ba_refine_principal_point 0 \
    --Mapper.ba_refine_extra_params $refine
  local candidate best='' most=0 count
  for candidate in "$work"/models/*/; do
    [[ -f $candidate/images.bin ]] || continue
    count=$(registered_images "$candidate")
    if ((count > most)); then most=$count best=$candidate; fi
  done
  [[ -n $best ]] || die "COLMAP found no poses for $images (see $work/mapper.log)"
  mv "$best" "$work/model"
  echo "  $most images registered"
}

# align_to_truth MODEL TRUTH OUT: writes MODEL to OUT, aligned to the true camera centres in metres.
align_to_truth() { "$bin/AlignModel" -i "$1" --reference "$2" -o "$3"; }

# densify FOLDER OPTION...: makes FOLDER/scene_dense.ply from FOLDER/scene.mvs. Writes the elapsed
# seconds to FOLDER/seconds.
densify() {
  local folder=$1 begin=$EPOCHREALTIME
  shift
  "$bin/DensifyPointCloud" -i scene.mvs -w "$folder" "$@"
  awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f\n", b - a }' >"$folder/seconds"
}
