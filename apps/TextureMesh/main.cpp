// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from the photographs of a scene.

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "base/program/tiling.h"
#include "belong/surface_check.h"
#include "boundary/cut_mesh.h"
#include "boundary/scene_boundary.h"
#include "cloud/tiles.h"
#include "geometry/seen_part.h"
#include "io/openmvs/point_source.h"
#include "mesh/clean.h"
#include "scene/check_mesh.h"
#include "settings.h"
#include "survey/photographs.h"
#include "texture/faces/photograph_source.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

Mesh read_mesh(const Settings& settings, const LocalFrame& frame, const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(settings.mesh),
                           "reading " + settings.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, settings.mesh, context);
  if (mesh.faces.empty()) fail_in(settings.mesh, "the mesh has no faces");
  log_info("{}: {} vertices, {} faces", settings.mesh.string(), mesh.vertices.size(),
           mesh.faces.size());
  mesh.colors = {};  // the textured mesh has none
  return mesh;
}

// The mesh with fewer faces, simplified as by ReconstructMesh.
Mesh simplified(const Settings& settings, Mesh mesh, const Context& context) {
  if (settings.decimate == 1) return mesh;
  context.memory().require(mesh::bytes_to_clean(mesh.vertices.size()),
                           "decimating " + settings.mesh.string());
  mesh::CleanOptions fewer;
  fewer.decimate = settings.decimate;
  fewer.close_holes = settings.close_holes;
  fewer.spurious = 0;
  fewer.spikes = false;
  Mesh result = naming(settings.mesh, [&] { return mesh::clean(mesh, fewer); });
  log_info("{} of {} faces were kept", result.faces.size(), mesh.faces.size());
  return result;
}

// The output of a tile, with the extension .mvs. It is that of the run if there is one tile.
fs::path output_of(const Settings& settings, std::size_t tile) {
  if (settings.texture.tiles == 1) return settings.output;
  return tile_file(settings.output, tile + 1, settings.texture.tiles, ".mvs");
}

// Error if a file of a tile's mesh with `textures` textures is an input or cannot be written.
void keep_inputs(const Settings& settings, const survey::Survey& survey, std::size_t tile,
                 std::size_t textures) {
  for (const io::TexturedFormat format : settings.formats)
    survey.keep_inputs(io::textured_files(output_of(settings, tile), format, textures),
                       setting("output_file"));
}

// What the meshes of all tiles have.
struct Written {
  std::size_t textures = 0, faces = 0;
  std::size_t outside = 0;  // faces outside of the boundary, which are left out
};

void write(const Settings& settings, const LocalFrame& frame, std::size_t tile,
           const TexturedMesh& mesh) {
  const fs::path output = output_of(settings, tile);
  for (const io::TexturedFormat format : settings.formats) {
    const fs::path file = io::textured_files(output, format, 1).front();
    if (mesh.mesh.faces.empty()) {
      // The file of another run would seem to belong to this one.
      std::error_code ignored;
      fs::remove(file, ignored);
      log_info("{}: not written: the tile has no faces", file.string());
      continue;
    }
    io::write_textured_mesh(output, mesh, format, frame);
    log_info("wrote {}", file.string());
  }
}

void report(const Written& written, const texture::Report& facts) {
  if (facts.new_faces > 0)
    log_info("{} faces were added by splitting faces whose image is not linear", facts.new_faces);
  log_info("{} parts of photographs in {} textures; {} of {} faces are not seen", facts.charts,
           written.textures, facts.unseen_faces - written.outside, written.faces);
}

// The options of texture_mesh(), with the memory to read a photograph and to write the results.
texture::Options with_memory(const Settings& settings, const survey::Photographs& photographs) {
  texture::Options options = settings.texture;
  options.image_bytes = photographs.bytes_to_read_color();
  options.bytes_to_write = [&settings](const texture::ResultSize& size) {
    std::uint64_t bytes = 0;
    for (const io::TexturedFormat format : settings.formats)
      bytes = std::max(
          bytes, io::bytes_to_write_textured(format, size.vertices, size.faces, size.textures));
    return bytes;
  };
  return options;
}

// Marks the faces outside of the boundary. They are textured by no photograph, and stay until the
// end, because they hide parts of the other faces.
void mark_outside(const Settings& settings, const survey::Survey& survey, Mesh& mesh,
                  const Context& context) {
  if (!settings.boundary.is_given()) return;
  boundary::SceneFacts scene{survey.frame, {}, settings.mesh};
  for (const survey::View& view : survey.views) scene.centres.push_back(view.pose.centre);
  boundary::mark_outside(settings.boundary, scene, mesh, context);
  return_freed_memory();
}

// Removes the faces that mark_outside() marked. Returns their number.
std::size_t remove_outside(const Settings& settings, TexturedMesh& mesh) {
  const std::size_t before = mesh.mesh.faces.size();
  if (settings.boundary.is_given()) boundary::remove_outside(mesh);
  return before - mesh.mesh.faces.size();
}

void texture_and_write(const Settings& settings, const survey::Survey& survey, Mesh mesh,
                       const Eigen::Matrix3d& axes, const Context& context) {
  const survey::Photographs photographs(survey);
  texture::Options options = with_memory(settings, photographs);
  options.axes = axes;
  texture::Report facts;
  Written written;
  naming(settings.mesh, [&] {
    texture::texture_tiles(
        std::move(mesh), survey::posed_cameras(survey), texture::source_of(photographs), options,
        [&](std::size_t tile, TexturedMesh textured) {
          written.outside += remove_outside(settings, textured);
          return_freed_memory();
          if (tile == 0) photographs.report(context);
          keep_inputs(settings, survey, tile, textured.textures.size());
          written.textures += textured.textures.size();
          written.faces += textured.mesh.faces.size();
          if (tile + 1 == options.tiles) report(written, facts);
          write(settings, survey.frame, tile, textured);
        },
        &facts, context);
  });
}

// Warns if the mesh is inside out: no photograph shows faces that are turned away from it.
void check_sides(const Settings& settings, const survey::Survey& survey, const Mesh& mesh,
                 const Context& context) {
  context.memory().require(geometry::bytes_of_sights(mesh), "what the cameras see");
  naming(settings.mesh, [&] {
    geometry::warn_if_inside_out(
        geometry::find_seen_part(mesh, survey::posed_cameras(survey), {.strays = false}),
        settings.mesh, context);
  });
  return_freed_memory();
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const Settings& settings = options.settings;
  const Context context = program_context(options.parsed);
  const OutputLock lock = lock_output(settings.output);
  survey::Survey survey = survey::open_scene(settings.survey, context);
  boundary::check_files(settings.boundary, settings.mesh);
  Mesh mesh = read_mesh(settings, survey.frame, context);
  naming(settings.mesh, [&] { check_mesh(mesh); });
  belong::check_surface(survey.scene, belong::shape_of(mesh), {settings.mesh, survey.file()},
                        context);
  mesh = simplified(settings, std::move(mesh), context);
  survey::find_photographs(survey, context);
  survey.add_inputs(io::files_of_mesh(settings.mesh));
  survey.add_inputs(settings.boundary.inputs());
  for (std::size_t tile = 0; tile < settings.texture.tiles; ++tile)
    keep_inputs(settings, survey, tile, 1);
  const Eigen::Matrix3d axes = cloud::tile_axes(survey.scene);
  survey.scene = {};
  return_freed_memory();
  check_sides(settings, survey, mesh, context);
  mark_outside(settings, survey, mesh, context);
  texture_and_write(settings, survey, std::move(mesh), axes, context);
  warn_of_other_tiles(other_tiles(settings.output, settings.texture.tiles), context);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("TextureMesh", [&] { return axial::apps::run(argc, argv); });
}
