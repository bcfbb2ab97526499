// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the depth maps of many images in stages. Each map of each stage is a file, so that a run
// that was stopped continues where it ended.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "axial/densify.h"
#include "base/context.h"
#include "base/shared_cache.h"
#include "io/openmvs/dmap.h"
#include "scene/depth_map.h"

namespace axial::densify {

// Reads the map of the image with the index `image` in the scene from its file. Called by several
// threads at the same time.
using ReadMap = std::function<DepthMap(std::size_t image)>;

// The maps of the previous stage. They are always read from their files, even if the previous stage
// was part of this run, because a resumed run must see the same bytes. Thread-safe.
class PreviousMaps {
 public:
  // `read`: reads the map of an image from its file. `whole`: get() returns maps with normals and
  // confidences. `capacity`: the number of maps in the cache.
  PreviousMaps(ReadMap read, bool whole, std::size_t capacity);

  // Reads the whole map from its file. Does not use the cache.
  DepthMap read(std::size_t image) const { return read_(image); }

  // Returns the map from the cache, after reading it from its file if necessary. The map has
  // normals and confidences only if the constructor got `whole`.
  std::shared_ptr<const DepthMap> get(std::size_t image) { return cache_.get(image); }

 private:
  ReadMap read_;
  SharedCache<DepthMap> cache_;
};

// One round over all images.
struct Stage {
  // Part of the names of the stage's files, and stored in their side files; unique.
  std::string name;
  std::string title;  // shown with the progress of the stage
  // Makes the map of the image with the index `image`. Called by several threads at the same time.
  // The first stage must not use `previous`, because there are no previous maps.
  std::function<DepthMap(std::size_t image, PreviousMaps& previous)> make;
  // True: PreviousMaps::get() returns maps with normals and confidences, and the capacity of its
  // cache is StageRun::cached_maps. False: get() returns depths alone, and the capacity is
  // cached_depths.
  bool whole_maps = false;
  // The images whose maps of the previous stage `make` needs for the map of an image. Empty for the
  // first stage.
  std::function<std::vector<std::size_t>(std::size_t image)> needs = {};
};

// The arguments that all stages share. Images are named by their index in the scene.
struct StageRun {
  std::span<const std::size_t> images;  // the images that get maps, in this order
  // The file of an image's final map. The map of an earlier stage is in a file with the same name,
  // but with the stage's name before the extension.
  std::function<std::filesystem::path(std::size_t image)> final_file;
  std::string fingerprint;  // of all input of the maps; it is stored in their side files
  // The states of the final files before the run, indexed by image.
  std::span<const io::DmapStatus> existing;
  std::size_t in_flight = 1;      // number of images that are processed at the same time
  std::size_t cached_depths = 0;  // capacity of PreviousMaps; see Stage::whole_maps
  std::size_t cached_maps = 0;    // capacity of PreviousMaps for stages with whole_maps
  // Of which maps run_stages() writes pictures beside the maps.
  Pictures pictures = Pictures::none;
  // Checks maps early, because later stages may take hours. Called once. If the run makes maps of
  // the first stage, the call comes after the first stage, and `read_map` reads its maps. Otherwise
  // the call comes before the run makes a map, and `read_map` reads the maps of the latest complete
  // stage. `first_stage`: whether `read_map` reads maps of the first stage. Empty: no check.
  std::function<void(bool first_stage, const ReadMap& read_map)> check;
  // For run_part(): the images of all parts.
  std::span<const std::size_t> all_images = {};
  // The number of stages to run, if it is less than the number of all stages.
  std::size_t most_stages = std::numeric_limits<std::size_t>::max();
};

// The text `made_from` (io/openmvs/dmap.h) of the maps of a stage. `fingerprint`: of all their
// input.
std::string mark_of_stage(const std::string& fingerprint, const std::string& stage);

// Runs the stages one after the other. The maps of the last of `stages` are the result, in the
// files `run.final_file`; `run.most_stages` can end the run earlier. Precondition: there is at
// least one stage.
//
// * A file is used again only if its depth map is complete and its side file has the run's
//   fingerprint and the stage's name. Every other file with the name of a map is overwritten by a
//   new map, also a damaged file or a file of another program.
// * The run begins after the last stage whose files can all be used again. The files of earlier
//   stages are not needed. In a stage that is not complete, only the missing maps are made.
// * Every stage reads only complete files of the previous stage. So a run that was stopped and
//   continues gives the same bytes as a run without a stop.
// * The files of a stage are removed when the next stage is complete. Files of earlier stages that
//   other runs left are removed, too.
//
// Exceptions of Stage::make and StageRun::check end the run and reach the caller. The finished
// files stay.
void run_stages(std::span<const Stage> stages, const StageRun& run, const Context& context = {});

// Makes the maps of the stage stages[stage] for the images `run.images`, which are a part of all
// images. Other runs make the maps of the other images and of the other stages. No file is removed
// and `run.check` is not called, because the run does not know whether other runs have ended. Maps
// of the stage that exist are not made again. Nothing is made if the maps of a later stage exist
// for all of `run.all_images`, because a whole run has removed the maps of earlier stages then.
// Throws an Error, before it makes a map, if a map that the stage needs is missing or has another
// fingerprint. The error names the file.
void run_part(std::span<const Stage> stages, std::size_t stage, const StageRun& run,
              const Context& context = {});

}  // namespace axial::densify
