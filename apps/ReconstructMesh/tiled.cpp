// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiled.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "base/naming.h"
#include "base/parse_number.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "io/artifacts/artifact.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/lenses.h"
#include "io/openmvs/point_source.h"
#include "io/openmvs/scene_files.h"
#include "mesh/tiled.h"
#include "scene/point_cloud.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPortion = 1 << 16;  // [points]

fs::path tile_folder(const Options& options) {
  return fs::path(options.output).replace_extension(fmt::format(".tiles{}", options.tiling.count));
}

void add(const mesh::ReconstructOptions& options, Fingerprint& print) {
  // A new option does not compile until it has a name here.
  const auto& [merge, votes, clean, only_region, crop_to_region] = options;
  const auto& [min_distance, most_points] = merge;
  const auto& [constant_weight, weak_support, thickness, quality] = votes;
  const auto& [decimate, target_faces, spurious, spikes, close_holes, smooth, edge_length, cut_off,
               may_be_empty] = clean;
  for (const double value : {min_distance, thickness, quality, spurious, cut_off}) print.add(value);
  for (const bool value : {constant_weight, weak_support, spikes, only_region, crop_to_region})
    print.add(std::uint64_t{value});
  for (const std::uint64_t value : {std::uint64_t{close_holes}, std::uint64_t{smooth}})
    print.add(value);
}

mesh::TileRun run_of(const Options& options) {
  Fingerprint print;
  print.add(version_line("ReconstructMesh"));
  const fs::path& scene = options.survey.files.scene;
  for (const fs::path& file : {scene, cloud_file(options), io::housing_file(options.survey.files),
                               io::lenses_beside(scene), io::geo_offset_beside(scene)})
    if (!io::add_state(print, file)) print.add("no file");
  add(options.reconstruct, print);
  print.add(options.roi_border).add(static_cast<std::uint64_t>(options.survey.files.ports));
  const mesh::CleanOptions& clean = options.reconstruct.clean;
  mesh::TileRun run{options.tiling.count, tile_folder(options), print.hex()};
  // A mean edge is 3 to 4 pixels long. A piece that is not spurious must be seen as such from each
  // tile that has a part of it, and a smoothing step has effects two edges away.
  run.margin = std::max(run.margin, 7.5 * clean.spurious) + 7.5 * clean.smooth;
  return run;
}

// Errors in the cloud are named by its file, as those of a mesh in one piece.
fs::path named_source(const Options& options) {
  const fs::path cloud = cloud_file(options);
  return cloud.empty() ? options.survey.files.scene : cloud;
}

}  // namespace

fs::path cloud_file(const Options& options) {
  if (!options.cloud.empty()) return options.cloud;
  const fs::path beside = io::cloud_beside(options.survey.files.scene);
  std::error_code error;
  return fs::exists(beside, error) ? beside : fs::path();
}

mesh::CloudSource source_of(const io::SceneWithCameras& scene, const Options& options,
                            const Context& context) {
  return [&scene, &context, file = cloud_file(options)](const io::CloudPortionSink& sink) {
    if (file.empty()) {
      PointCloud points = cloud_of(scene.scene);
      const std::size_t count = points.size();
      sink(std::move(points), count);
    } else {
      io::read_cloud_of_scene_in_portions(scene.frame, file, kPortion, sink, context);
    }
  };
}

void make_tile(const io::SceneWithCameras& scene, const Options& options, const Context& context) {
  naming(named_source(options), [&] {
    mesh::reconstruct_tile(*options.tiling.tile - 1, source_of(scene, options, context),
                           scene.scene, options.reconstruct, run_of(options), context);
  });
  context.info("{}: tile {} of {} is complete", tile_folder(options).string(), *options.tiling.tile,
               options.tiling.count);
}

Mesh join_tiles(const io::SceneWithCameras& scene, const Options& options, const Context& context) {
  return naming(named_source(options), [&] {
    return mesh::reconstruct_in_tiles(source_of(scene, options, context), scene.scene,
                                      options.reconstruct, run_of(options), context);
  });
}

// Runs with another number of tiles keep their intermediate files in folders of the same form.
void remove_tiles(const Options& options) {
  const std::string begin = without_known_extension(options.output).filename().string() + ".tiles";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(options.output.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory(ignored) || !name.starts_with(begin)) continue;
    const auto tiles = parse_number<std::size_t>(name.substr(begin.size()));
    if (tiles && *tiles <= kMostTiles) mesh::remove_intermediate_files({*tiles, entry.path(), {}});
  }
}

}  // namespace axial::apps
