// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from the photographs of a scene.

#include <algorithm>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/same_file.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/lenses.h"
#include "io/openmvs/mvs_counts.h"
#include "io/openmvs/point_source.h"
#include "settings.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The memory of the program itself: code and libraries, stacks, small blocks.
constexpr std::uint64_t kProgramBytes = 64 * kMegabyte;

MemoryAllowance memory_of(const Settings& settings) {
  return {settings.max_memory, "--max-memory", kProgramBytes};
}

Mesh read_mesh(const Settings& settings, const LocalFrame& frame) {
  memory_of(settings).require(io::bytes_to_read_mesh(settings.mesh),
                              "reading " + settings.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, settings.mesh);
  if (mesh.faces.empty()) fail("{}: the mesh has no faces", settings.mesh.string());
  log_info("{}: {} vertices, {} faces", settings.mesh.string(), mesh.vertices.size(),
           mesh.faces.size());
  mesh.colors = {};  // the textured mesh has none
  return mesh;
}

void report(const TexturedMesh& mesh, const texture::Report& facts) {
  if (facts.new_faces > 0)
    log_info("{} faces were added by splitting faces whose image is not linear", facts.new_faces);
  log_info("{} parts of photographs in {} textures; {} of {} faces are not seen", facts.charts,
           mesh.textures.size(), facts.unseen_faces, mesh.mesh.faces.size());
}

// Error if a file of a mesh with `textures` textures is an input.
void keep_inputs(const Settings& settings, const texture::Photographs& photographs,
                 std::size_t textures) {
  const fs::path& scene = settings.scene.scene;
  std::vector<fs::path> inputs = photographs.files();
  inputs.insert(inputs.end(),
                {scene, settings.mesh, io::housing_file(settings.scene), io::lenses_beside(scene),
                 io::geo_offset_beside(scene), settings.photographs.views_file});
  for (const io::TexturedFormat format : settings.formats)
    require_no_inputs(io::textured_files(settings.output, format, textures), inputs,
                      "--output-file");
}

void require_writable_outputs(const Settings& settings) {
  std::error_code ignored;
  fs::create_directories(settings.output.parent_path(), ignored);
  for (const io::TexturedFormat format : settings.formats)
    for (const fs::path& file : io::textured_files(settings.output, format, 1))
      require_writable(file);
}

// The options of texture_mesh(), with what is left of the memory after the input was read.
texture::Options with_memory(const Settings& settings, const texture::Photographs& photographs) {
  texture::Options options = settings.texture;
  options.max_bytes = std::max<std::uint64_t>(memory_of(settings).left(), 1);  // 0: no limit
  options.image_bytes = photographs.bytes_to_load();
  options.bytes_to_write = [&settings](const texture::ResultSize& size) {
    std::uint64_t bytes = 0;
    for (const io::TexturedFormat format : settings.formats)
      bytes = std::max(
          bytes, io::bytes_to_write_textured(format, size.vertices, size.faces, size.textures));
    return bytes;
  };
  return options;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const Settings& settings = options.settings;
  const ThreadLimit limit(options.parsed.common.max_threads);
  if (const auto counts = io::count_mvs(settings.scene.scene))
    memory_of(settings).require(counts->reading_bytes(),
                                "reading " + settings.scene.scene.string());
  io::SceneWithCameras scene = io::read_scene_with_cameras(settings.scene);
  Mesh mesh = read_mesh(settings, scene.frame);
  const texture::Photographs photographs(scene.scene, settings.scene.scene, settings.photographs);
  keep_inputs(settings, photographs, 1);
  require_writable_outputs(settings);
  const LocalFrame frame = scene.frame;
  scene = {};
  return_freed_memory();
  texture::Report facts;
  const TexturedMesh textured = naming(settings.mesh, [&] {
    return texture::texture_mesh(
        std::move(mesh), photographs.views(),
        [&](std::size_t view) { return photographs.load(view); },
        with_memory(settings, photographs), &facts,
        [](const std::string& stage) { return console_progress(stage); });
  });
  return_freed_memory();
  report(textured, facts);
  keep_inputs(settings, photographs, textured.textures.size());
  for (const io::TexturedFormat format : settings.formats) {
    io::write_textured_mesh(settings.output, textured, format, frame);
    log_info("wrote {}", io::textured_files(settings.output, format, 1).front().string());
  }
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("TextureMesh", [&] { return axial::apps::run(argc, argv); });
}
