// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/outputs.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/same_file.h"
#include "densify/depth_stage.h"
#include "densify/tile_files.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/housing.h"
#include "io/openmvs/scene_files.h"

namespace axial::densify {
namespace fs = std::filesystem;

namespace {

fs::path cloud_file(const Settings& settings) {
  return fs::path(settings.output).replace_extension(".ply");
}

// The housing is not among these files: it is not written if it is the file that was read.
std::vector<fs::path> cloud_outputs(const Settings& settings) {
  std::vector<fs::path> files = tile_outputs(settings);
  files.insert(files.end(),
               {settings.output, cloud_file(settings), io::lenses_beside(settings.output)});
  return files;
}

std::vector<fs::path> depth_outputs(const Project& project, const Settings& settings) {
  std::vector<fs::path> files;
  const bool pictures = settings.pictures != Pictures::none;
  for (const std::size_t image : project.references) {
    const fs::path map = depth_map_path(project, settings, image);
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
void check_side_output(const std::string& setting, const fs::path& output,
                       const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  if (output.empty()) return;
  require_not_an_input(output, inputs, setting);
  for (const fs::path& other : outputs)
    if (is_one_file(output, other))
      fail("{} {}: is also the file name of the run's {}", setting, output.string(),
           other.filename().string());
}

}  // namespace

std::vector<fs::path> scene_files(const Settings& settings) {
  std::vector<fs::path> files = io::files_of_scene(settings.survey.files);
  files.insert(files.end(), {settings.point_cloud, settings.neighbour_lists});
  files.insert(files.end(), settings.other_inputs.begin(), settings.other_inputs.end());
  return files;
}

void check_outputs(const Settings& settings) {
  require_no_inputs(cloud_outputs(settings), scene_files(settings), settings.name_of("output"));
  if (!settings.neighbour_lists_output.empty())
    require_not_an_input(settings.neighbour_lists_output, scene_files(settings),
                         settings.name_of("neighbour_lists_output"));
  require_writable(settings.output);
  require_writable(cloud_file(settings));
  if (!settings.plan.empty()) {
    require_not_an_input(settings.plan, scene_files(settings), settings.name_of("plan"));
    require_writable(settings.plan);
  }
  if (!settings.report.empty()) {
    require_not_an_input(settings.report, scene_files(settings), settings.name_of("report"));
    require_writable(settings.report);
  }
  require_writable(settings.survey.files.working_folder / "depth0000.dmap");
  remove_abandoned(settings.survey.files.working_folder, "depth");
}

void check_outputs(const Project& project, const Settings& settings) {
  std::vector<fs::path> inputs = scene_files(settings);
  for (const fs::path& file : survey::photograph_files(project)) inputs.push_back(file);
  require_no_inputs(cloud_outputs(settings), inputs, settings.name_of("output"));
  std::vector<fs::path> outputs = depth_outputs(project, settings);
  require_no_inputs(outputs, inputs, settings.name_of("working_folder"));
  for (const fs::path& file : cloud_outputs(settings)) outputs.push_back(file);
  outputs.push_back(io::housing_beside(settings.output));
  outputs.push_back(io::geo_offset_beside(settings.output));
  check_side_output(settings.name_of("report"), settings.report, inputs, outputs);
  check_side_output(settings.name_of("plan"), settings.plan, inputs, outputs);
  check_side_output(settings.name_of("neighbour_lists_output"), settings.neighbour_lists_output,
                    inputs, outputs);
}

}  // namespace axial::densify
