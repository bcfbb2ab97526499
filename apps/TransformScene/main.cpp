// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a scene, its cloud and its mesh by a similarity, shrinks its images, and measures volumes.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/log.h"
#include "base/output_lock.h"
#include "base/program/output_name.h"
#include "base/same_file.h"
#include "belong/surface_check.h"
#include "converted_mesh.h"
#include "evaluate/alignment.h"
#include "find_move.h"
#include "image_scaling.h"
#include "io/cameras/geo_offset.h"
#include "io/frames/ply_transform.h"
#include "io/openmvs/mvs.h"
#include "io/openmvs/point_source.h"
#include "io/openmvs/scene_files.h"
#include "io/textured/textured_mesh.h"
#include "las_cloud.h"
#include "measure_volume.h"
#include "moved_mesh.h"
#include "options.h"
#include "survey/survey.h"
#include "texture_copies.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

fs::path cloud_output(const Options& options) {
  return io::cloud_beside(options.output);
}

fs::path mesh_output(const Options& options) {
  return without_known_extension(options.output) += "_mesh." + options.export_type;
}

fs::path folder_of_small_images(const Options& options) {
  return options.output.parent_path() / fmt::format("images{}", options.max_resolution);
}

// A PLY file that is moved with the scene.
struct MovedPly {
  std::string what;
  fs::path input, output;
};

bool is_ply(const fs::path& path) {
  return lower_extension(path) == ".ply";
}

// Whether the mesh is copied with everything that its file holds.
bool is_moved_as_ply(const Options& options) {
  return is_ply(options.mesh) && options.export_type == "ply";
}

std::vector<MovedPly> moved_plys(const Options& options) {
  std::vector<MovedPly> plys;
  if (options.moves() && !options.cloud.empty())
    plys.push_back({"cloud", options.cloud, cloud_output(options)});
  if (options.writes_mesh() && is_moved_as_ply(options))
    plys.push_back({"mesh", options.mesh, mesh_output(options)});
  return plys;
}

// What is moved besides the scene.
struct Files {
  std::vector<MovedPly> plys;
  std::vector<TextureCopy> textures;  // of the mesh
  std::optional<ConvertedMesh> mesh;  // if it is not a PLY, or is written in another format
};

Files files_of(const Options& options, const Context& context) {
  Files files{moved_plys(options), {}, {}};
  if (!options.writes_mesh()) return files;
  if (is_moved_as_ply(options))
    files.textures = texture_copies(options.mesh, mesh_output(options));
  else
    files.mesh = converted_mesh(options.mesh, mesh_output(options), context);
  return files;
}

std::vector<NamedOutput> outputs_of(const Options& options, const Files& files) {
  std::vector<NamedOutput> outputs;
  for (const MovedPly& ply : files.plys) outputs.push_back({"--output-file", ply.output});
  if (files.mesh)
    for (const fs::path& file : files.mesh->outputs) outputs.push_back({"--output-file", file});
  if (options.writes_scene())
    for (const fs::path& file :
         {options.output, io::housing_beside(options.output), io::lenses_beside(options.output),
          io::geo_offset_beside(options.output)})
      outputs.push_back({"--output-file", file});
  if (options.moves() && !options.transform_out.empty())
    outputs.push_back({"--transform-out", options.transform_out});
  if (options.sample_mesh != 0) outputs.push_back({"--sample-mesh", samples_file(options)});
  for (const TextureCopy& texture : files.textures)
    if (texture.needed) outputs.push_back({"--mesh-file", texture.to});
  return outputs;
}

// Called before the scene is read. Makes the folders of copied textures.
void check_outputs(const Options& options, const Files& files) {
  std::vector<fs::path> inputs = io::files_of_scene(options.survey.files);
  inputs.insert(inputs.end(),
                {options.cloud, options.mesh, options.align, options.transform, options.positions});
  for (const fs::path& file : io::files_of_mesh(options.mesh)) inputs.push_back(file);
  for (const TextureCopy& texture : files.textures) {
    inputs.push_back(texture.from);
    if (!texture.needed) inputs.push_back(texture.to);
  }
  const std::vector<NamedOutput> outputs = outputs_of(options, files);
  for (const NamedOutput& output : outputs)
    require_not_an_input(output.path, inputs, output.setting);
  require_different(outputs);
  std::error_code ignored;
  for (const NamedOutput& output : outputs) {
    if (output.setting != "--transform-out")
      fs::create_directories(output.path.parent_path(), ignored);
    require_writable(output.path);
  }
}

// Error if an output is a photograph, a mask or a depth map of the scene.
void keep_images(const Options& options, const Files& files, const survey::Survey& survey) {
  for (const NamedOutput& output : outputs_of(options, files))
    require_not_an_input(output.path, survey.inputs, output.setting);
}

// Warns of a mesh or a cloud that does not belong to the scene, which is still unmoved. The
// vertices of a mesh are looked at as points. transform_ply() reports the faults of files.
void warn_of_foreign_points(const Options& options, const io::SceneWithCameras& scene,
                            const fs::path& ply, const Context& context) {
  constexpr std::size_t kPortion = 1 << 18, kMost = 1'000'000;
  std::vector<Eigen::Vector3f> points;
  std::size_t read = 0;
  try {
    io::read_cloud_of_scene_in_portions(
        scene.frame, ply, kPortion,
        [&](const PointCloud& portion, std::size_t all) {
          const std::size_t step = all / kMost + 1;
          for (const Eigen::Vector3f& position : portion.positions)
            if (read++ % step == 0) points.push_back(position);
        },
        context);
  } catch (const Error&) {
    return;
  }
  belong::check_surface(scene.scene, {points}, {ply, options.survey.files.scene, true}, context);
}

void apply(const Options& options, const FrameMove& move, io::SceneWithCameras& scene) {
  axial::apply(move.similarity, scene.scene);
  scene.frame = move.to;
  if (scene.housing)
    scene.housing =
        io::moved(move.between_worlds(), std::move(*scene.housing), options.scale_ports);
}

// Called before the first file is written.
void require_writable_scene(const Options& options, const Scene& scene) {
  const std::string file = options.survey.files.scene.string();
  if (std::ranges::none_of(scene.images, &SceneImage::calibrated))
    fail_in(file, "no image is calibrated");
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    if (!scene.points[i].position.allFinite())
      fail_in(file, "point {} has no finite position after the transformation", i);
}

void copy_texture(const TextureCopy& texture, const fs::path& temporary) {
  std::error_code error;
  if (!fs::copy_file(texture.from, temporary, error))
    fail_in(texture.from, "cannot be copied to {}: {}", texture.to.string(), error.message());
}

// A file to write, and how to write it under a temporary name. Without a function, the file is
// written together with others.
struct Output {
  fs::path path;
  std::function<void(const fs::path& temporary)> write;
};

// The last output is the scene, if it is written. It needs the files beside it and the smaller
// images.
std::vector<Output> all_outputs(const Options& options, const Files& files, const FrameMove& move,
                                const Scene& scene, const Context& context) {
  std::vector<Output> outputs;
  if (files.mesh)  // these files come first
    for (const fs::path& file : files.mesh->outputs) outputs.push_back({file, {}});
  for (const TextureCopy& texture : files.textures)
    if (texture.needed)
      outputs.push_back({texture.to, [&](const fs::path& file) { copy_texture(texture, file); }});
  for (const MovedPly& ply : files.plys)
    outputs.push_back(
        {ply.output, [&](const fs::path& file) { io::transform_ply(ply.input, file, move); }});
  if (options.moves() && !options.transform_out.empty())
    outputs.push_back({options.transform_out, [&](const fs::path& file) {
                         write_atomically(file, evaluate::matrix_text(move.between_worlds()));
                       }});
  if (options.sample_mesh != 0)
    outputs.push_back({samples_file(options),
                       [&](const fs::path& file) { write_samples(options, move, file, context); }});
  if (options.writes_scene())
    outputs.push_back({options.output, [&](const fs::path& file) {
                         io::write_mvs(file, scene, options.survey.files.working_folder);
                       }});
  return outputs;
}

void tell_outputs(const Options& options, const Files& files, const std::vector<SmallImage>& images,
                  const Scene& scene) {
  const char* done = options.moves() ? "transformed" : "converted";
  for (const MovedPly& ply : files.plys) log_info("{}: {} {}", ply.output.string(), done, ply.what);
  if (files.mesh) log_info("{}: {} mesh", files.mesh->outputs[0].string(), done);
  if (options.sample_mesh != 0) log_info("{}: points on the mesh", samples_file(options).string());
  if (options.max_resolution > 0)
    log_info("{} of {} images were shrunk to at most {} pixels, in {}", images.size(),
             scene.images.size(), options.max_resolution, folder_of_small_images(options).string());
  if (options.writes_scene())
    log_info("{}: {} images, {} points", options.output.string(), scene.images.size(),
             scene.points.size());
}

// No file changes before all inputs are read. The files beside the scene are written before the
// scene: without them the scene would be read as a scene without ports at the origin.
void write_all(const Options& options, const Files& files, const FrameMove& move,
               const std::vector<SmallImage>& images, const io::SceneWithCameras& scene,
               const Context& context) {
  const io::SceneLenses lenses =
      options.writes_scene() ? io::lenses_of(scene.scene, options.output) : io::SceneLenses();
  const std::vector<Output> outputs = all_outputs(options, files, move, scene.scene, context);
  std::vector<fs::path> paths;
  for (const Output& output : outputs) paths.push_back(output.path);
  write_together(paths, [&](const std::vector<fs::path>& temporaries) {
    if (files.mesh) write_moved(*files.mesh, move, temporaries, context);
    for (std::size_t k = 0; k < outputs.size(); ++k)
      if (outputs[k].write) outputs[k].write(temporaries[k]);
    if (!options.writes_scene()) return;
    write_small_images(images, folder_of_small_images(options));
    io::write_cameras_beside(options.output, scene, lenses, options.survey.files, context);
  });
  tell_outputs(options, files, images, scene.scene);
}

// A cloud or a mesh that stays beside the new scene from an earlier scene of this name would seem
// to belong to the new scene.
void warn_of_older_files(const Options& options, const Files& files) {
  if (!options.moves()) return;
  std::vector<fs::path> older{cloud_output(options)};
  for (const char* type : {".ply", ".obj", ".glb", ".gltf"})
    older.push_back(with_extension(mesh_output(options), type));
  for (const fs::path& file : older) {
    const bool is_written =
        std::ranges::find(files.plys, file, &MovedPly::output) != files.plys.end() ||
        (files.mesh && files.mesh->outputs.front() == file);
    std::error_code error;
    if (!is_written && fs::exists(file, error))
      log_warning("{}: is older than {} and was not moved with it: remove or rename it",
                  file.string(), options.output.filename().string());
  }
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  if (options.is_cloud()) {
    write_as_las(options, context);
    return 0;
  }
  const Files files = files_of(options, context);
  std::optional<OutputLock> lock;
  const bool writes = !outputs_of(options, files).empty();
  if (writes) lock.emplace(options.output, LockUse::alone, ParentFolder::made);
  check_outputs(options, files);
  survey::Survey survey = survey::open_scene(options.survey, context);
  keep_images(options, files, survey);
  for (const MovedPly& ply : files.plys)
    warn_of_foreign_points(options, survey, ply.input, context);
  const FrameMove move = find_move(options, survey, context);
  check_scale(options, survey, move.similarity);
  apply(options, move, survey);
  if (options.writes_scene()) require_writable_scene(options, survey.scene);
  if (options.compute_volume) measure_volume(options, survey.scene, move, context);
  std::vector<SmallImage> images;
  if (options.max_resolution > 0)
    images =
        find_large_images(options.max_resolution, folder_of_small_images(options), survey.scene);
  if (writes) write_all(options, files, move, images, survey, context);
  warn_of_older_files(options, files);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("TransformScene", [&] { return axial::apps::run(argc, argv); });
}
