// SPDX-License-Identifier: GPL-3.0-or-later
#include "outputs.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/same_file.h"
#include "depth_stage.h"
#include "io/geo_offset.h"
#include "io/housing.h"

namespace densify {
namespace fs = std::filesystem;

namespace {

fs::path cloud_file(const Options& options) {
  return fs::path(options.output).replace_extension(".ply");
}

// The housing is not among these files: it is not written if it is the file that was read.
std::vector<fs::path> cloud_outputs(const Options& options) {
  return {options.output, cloud_file(options), axial::io::lenses_beside(options.output)};
}

std::vector<fs::path> depth_outputs(const Project& project, const Options& options) {
  std::vector<fs::path> files;
  const bool pictures = options.parsed.common.verbosity >= kVerbosityOfPictures;
  for (const std::size_t image : project.references) {
    const fs::path map = depth_map_path(project, options, image);
    files.insert(files.end(), {map, map.string() + ".json"});
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
void check_side_output(const char* option, const fs::path& output,
                       const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  if (output.empty()) return;
  axial::require_not_an_input(output, inputs, option);
  for (const fs::path& other : outputs)
    if (is_one_file(output, other))
      axial::fail("{} {}: is also the file name of the run's {}", option, output.string(),
                  other.filename().string());
}

}  // namespace

std::vector<fs::path> scene_files(const Options& options) {
  return {options.input,
          housing_file(options),
          axial::io::lenses_beside(options.input),
          axial::io::geo_offset_beside(options.input),
          options.point_cloud,
          options.neighbour_lists,
          options.dense_config};
}

void check_outputs(const Options& options) {
  axial::require_no_inputs(cloud_outputs(options), scene_files(options), "--output-file");
  if (!options.neighbour_lists_output.empty())
    axial::require_not_an_input(options.neighbour_lists_output, scene_files(options),
                                "--output-view-neighbors-file");
  axial::require_writable(options.output);
  axial::require_writable(cloud_file(options));
  if (!options.report.empty()) {
    axial::require_not_an_input(options.report, scene_files(options), "--report-file");
    axial::require_writable(options.report);
  }
  axial::require_writable(options.parsed.common.working_folder / "depth0000.dmap");
  axial::remove_abandoned(options.parsed.common.working_folder, "depth");
}

void check_outputs(const Project& project, const Options& options) {
  std::vector<fs::path> inputs = scene_files(options);
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    inputs.push_back(project.scene.images[i].path);
    inputs.push_back(project.views[i].mask);
  }
  axial::require_no_inputs(cloud_outputs(options), inputs, "--output-file");
  std::vector<fs::path> outputs = depth_outputs(project, options);
  axial::require_no_inputs(outputs, inputs, "--working-folder");
  for (const fs::path& file : cloud_outputs(options)) outputs.push_back(file);
  outputs.push_back(axial::io::housing_beside(options.output));
  outputs.push_back(axial::io::geo_offset_beside(options.output));
  check_side_output("--report-file", options.report, inputs, outputs);
  check_side_output("--output-view-neighbors-file", options.neighbour_lists_output, inputs,
                    outputs);
}

}  // namespace densify
