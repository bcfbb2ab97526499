// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a scene, its cloud and its mesh by a similarity, shrinks its images, and measures volumes.

#include <algorithm>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "evaluate/alignment.h"
#include "find_move.h"
#include "image_scaling.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/moved_housing.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply_transform.h"
#include "measure_volume.h"
#include "options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

fs::path cloud_output(const Options& options) {
  return fs::path(options.output).replace_extension(".ply");
}

fs::path mesh_output(const Options& options) {
  fs::path path = fs::path(options.output).replace_extension();
  path += "_mesh.ply";
  return path;
}

// Called before the work.
void check_outputs(const Options& options) {
  const fs::path& scene = options.files.scene;
  const std::vector<fs::path> inputs{scene,
                                     io::housing_file(options.files),
                                     io::lenses_beside(scene),
                                     io::geo_offset_beside(scene),
                                     options.cloud,
                                     options.mesh,
                                     options.align,
                                     options.transform,
                                     options.positions};
  std::vector<fs::path> outputs;
  if (options.writes_scene())
    outputs = {options.output, io::housing_beside(options.output),
               io::lenses_beside(options.output), io::geo_offset_beside(options.output)};
  if (options.moves() && !options.cloud.empty()) outputs.push_back(cloud_output(options));
  if (options.moves() && !options.mesh.empty()) outputs.push_back(mesh_output(options));
  require_no_inputs(outputs, inputs, "--output-file");
  std::error_code ignored;
  if (!outputs.empty()) fs::create_directories(options.output.parent_path(), ignored);
  for (const fs::path& output : outputs) require_writable(output);
  if (!options.moves() || options.transform_out.empty()) return;
  require_not_an_input(options.transform_out, inputs, "--transform-out");
  std::vector<NamedOutput> all;
  for (const fs::path& output : outputs) all.push_back({"--output-file", output});
  all.push_back({"--transform-out", options.transform_out});
  require_different(all);
  require_writable(options.transform_out);
}

void apply(const Options& options, const FrameMove& move, io::SceneWithCameras& scene) {
  axial::apply(move.similarity, scene.scene);
  scene.frame = move.to;
  if (scene.housing)
    scene.housing =
        io::moved(move.between_worlds(), std::move(*scene.housing), options.scale_ports);
}

// Called before the first file is written, because the scene is written last.
void require_writable_scene(const Options& options, const Scene& scene) {
  const std::string file = options.files.scene.string();
  if (std::ranges::none_of(scene.images, &SceneImage::calibrated))
    fail("{}: no image is calibrated", file);
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    if (!scene.points[i].position.allFinite())
      fail("{}: point {} has no finite position after the transformation", file, i);
}

void shrink_images_of(Scene& scene, const Options& options) {
  if (options.max_resolution == 0) return;
  shrink_images(options.max_resolution,
                options.output.parent_path() / fmt::format("images{}", options.max_resolution),
                scene);
}

// Writes the files of the cloud and of the mesh, and the images. An error in one of the inputs
// leaves none of these outputs.
void write_clouds_and_images(const Options& options, const FrameMove& move, Scene& scene) {
  std::vector<fs::path> inputs, outputs;
  const auto add = [&](const fs::path& input, const fs::path& output) {
    if (!options.moves() || input.empty()) return;
    inputs.push_back(input);
    outputs.push_back(output);
  };
  add(options.cloud, cloud_output(options));
  add(options.mesh, mesh_output(options));
  write_together(outputs, [&](const std::vector<fs::path>& temporaries) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      io::transform_ply(inputs[i], temporaries[i], move);
    shrink_images_of(scene, options);
  });
  for (const fs::path& output : outputs) log_info("{}: transformed", output.string());
  if (options.moves() && !options.transform_out.empty())
    write_atomically(options.transform_out, evaluate::matrix_text(move.between_worlds()));
}

// The files beside the scene are written first: without them the scene would be read as a scene
// without ports at the origin.
void write_scene(const Options& options, const io::SceneWithCameras& scene) {
  const io::SceneLenses lenses = io::lenses_of(scene.scene, options.output);
  io::write_cameras_beside(options.output, scene, lenses, options.files);
  io::write_mvs(options.output, scene.scene, options.files.working_folder);
  log_info("{}: {} images, {} points", options.output.string(), scene.scene.images.size(),
           scene.scene.points.size());
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const ThreadLimit threads(options.parsed.common.max_threads);
  check_outputs(options);
  io::SceneWithCameras scene = io::read_scene_with_cameras(options.files);
  const FrameMove move = find_move(options, scene);
  check_scale(options, scene, move.similarity);
  apply(options, move, scene);
  if (options.writes_scene()) require_writable_scene(options, scene.scene);
  if (options.compute_volume) measure_volume(options, scene.scene, move);
  write_clouds_and_images(options, move, scene.scene);
  if (options.writes_scene()) write_scene(options, scene);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("TransformScene", [&] { return axial::apps::run(argc, argv); });
}
