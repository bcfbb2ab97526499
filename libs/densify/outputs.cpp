// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/outputs.h"

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/program/tiling.h"
#include "io/artifacts/artifact.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/housing.h"
#include "io/openmvs/scene_files.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

fs::path cloud_file(const fs::path& scene) {
  return fs::path(scene).replace_extension(".ply");
}

// The housing is not among these files: it is not written if it is the file that was read.
std::vector<fs::path> cloud_outputs(const Options& options) {
  const fs::path& scene = options.output.scene;
  std::vector<fs::path> files;
  const auto* job = options.job_as<TileJob>();
  const std::size_t last = job ? job->tile : options.fusion.tiles;
  for (std::size_t tile = job ? job->tile : 1; tile <= last; ++tile)
    std::ranges::copy(io::with_side_file(tile_file(scene, tile, options.fusion.tiles, ".ply")),
                      std::back_inserter(files));
  files.insert(files.end(), {scene, cloud_file(scene), io::lenses_beside(scene)});
  return files;
}

std::vector<fs::path> depth_outputs(const Project& project, bool pictures) {
  std::vector<fs::path> files;
  for (const std::size_t image : project.references) {
    const fs::path map = depth_map_path(project, image);
    std::ranges::copy(io::with_side_file(map), std::back_inserter(files));
    for (const char* picture : {".png", ".normal.png", ".confidence.png"})
      if (pictures) files.push_back(fs::path(map).replace_extension(picture));
  }
  return files;
}

// Whether both paths name the same file, which may not exist.
bool is_one_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return a.filename() == b.filename() &&
         fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

// Error if the output is a file that the reconstruction reads, writes or resumes.
void check_side_output(const NamedOutput& output, const std::vector<fs::path>& inputs,
                       const std::vector<fs::path>& outputs) {
  require_not_an_input(output.path, inputs, output.setting);
  for (const fs::path& other : outputs)
    if (is_one_file(output.path, other))
      fail("{} {}: is also the file name of the run's {}", output.setting, output.path.string(),
           other.filename().string());
}

}  // namespace

RunFiles files_of(const Options& options) {
  RunFiles files{
      options.output.scene, io::files_of_scene(options.survey.files), cloud_outputs(options), {}};
  files.inputs.insert(files.inputs.end(),
                      {options.views.point_cloud, options.views.neighbour_lists});
  std::ranges::copy(options.output.other_inputs, std::back_inserter(files.inputs));
  const auto add = [&](const std::string& setting, const fs::path& file) {
    if (!file.empty()) files.others.push_back({setting, file});
  };
  add(setting("report"), options.output.report);
  if (const auto* job = options.job_as<PlanJob>()) add(setting("plan"), job->file);
  if (const auto* job = options.job_as<NeighbourListsJob>())
    add(setting("neighbour_lists_output"), job->file);
  return files;
}

void check_outputs(const RunFiles& files, const io::SceneFiles& from) {
  require_no_inputs(files.outputs, files.inputs, setting("output"));
  for (const NamedOutput& other : files.others)
    require_not_an_input(other.path, files.inputs, other.setting);
  require_writable(files.scene);
  require_writable(cloud_file(files.scene));
  for (const NamedOutput& other : files.others) require_writable(other.path);
  require_writable(from.working_folder / "depth0000.dmap");
  remove_abandoned(from.working_folder, "depth");
}

void check_outputs(const Project& project, const RunFiles& files, Pictures pictures) {
  std::vector<fs::path> inputs = files.inputs;
  std::ranges::copy(survey::photograph_files(project), std::back_inserter(inputs));
  require_no_inputs(files.outputs, inputs, setting("output"));
  std::vector<fs::path> outputs = depth_outputs(project, pictures != Pictures::none);
  require_no_inputs(outputs, inputs, setting("working_folder"));
  std::ranges::copy(files.outputs, std::back_inserter(outputs));
  outputs.push_back(io::housing_beside(files.scene));
  outputs.push_back(io::geo_offset_beside(files.scene));
  for (const NamedOutput& other : files.others) check_side_output(other, inputs, outputs);
}

}  // namespace axial::densify
