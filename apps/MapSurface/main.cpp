// SPDX-License-Identifier: GPL-3.0-or-later
// Makes maps of a mesh: heights, an orthomosaic of photographs, and the numbers of views.

#include <algorithm>
#include <limits>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/lenses.h"
#include "io/images/image.h"
#include "io/openmvs/mvs_counts.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "map/pixel_width.h"
#include "map/write_maps.h"
#include "scene/check_mesh.h"
#include "settings.h"
#include "texture/texture_mesh.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The memory of the program itself: code and libraries, stacks, small blocks.
constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

MemoryAllowance memory_of(const Settings& settings) {
  return {settings.max_memory, "--max-memory", kProgramBytes};
}

map::MapFiles map_files(const Settings& settings) {
  const auto named = [&](const char* end) { return fs::path(settings.output.string() + end); };
  map::MapFiles files;
  files.heights = named(".dem.tif");
  files.colors = named(".ortho.tif");
  files.counts = named(".views.tif");
  if (settings.hillshade) files.shades = named(".hillshade.tif");
  if (settings.contours > 0) files.contours = named(".contours.geojson");
  files.picture = named(".jpg");
  return files;
}

// The memory [bytes] that reading the mesh needs, with the textures that a PLY names.
std::uint64_t bytes_to_read(const fs::path& mesh) {
  std::uint64_t bytes = io::bytes_to_read_mesh(mesh), largest = 0;
  if (lower_extension(mesh) != ".ply" || !io::is_textured_mesh(mesh)) return bytes;
  for (const std::string& texture : io::textures_of_ply(mesh)) {
    const io::ImageHeader header = io::read_image_header(mesh.parent_path() / texture);
    bytes += 3 * static_cast<std::uint64_t>(header.size.area());
    largest = std::max(largest, io::bytes_needed(header));
  }
  return bytes + largest;
}

// The mesh, with its textures if it has some.
TexturedMesh read_mesh(const Settings& settings, const LocalFrame& frame) {
  memory_of(settings).require(bytes_to_read(settings.mesh), "reading " + settings.mesh.string());
  TexturedMesh mesh;
  if (io::is_textured_mesh(settings.mesh))
    mesh = io::read_textured_mesh(settings.mesh, frame);
  else
    mesh.mesh = io::read_mesh_of_scene(frame, settings.mesh);
  if (mesh.mesh.faces.empty()) fail("{}: the mesh has no faces", settings.mesh.string());
  log_info("{}: {} vertices, {} faces, {} textures", settings.mesh.string(),
           mesh.mesh.vertices.size(), mesh.mesh.faces.size(), mesh.textures.size());
  mesh.mesh.colors = {};  // the textures give the colours
  return mesh;
}

void keep_inputs(const Settings& settings, const texture::Photographs& photographs) {
  const fs::path& scene = settings.scene.scene;
  std::vector<fs::path> inputs = photographs.files();
  inputs.insert(inputs.end(),
                {scene, settings.mesh, io::housing_file(settings.scene), io::lenses_beside(scene),
                 io::geo_offset_beside(scene), settings.photographs.views_file});
  if (lower_extension(settings.mesh) == ".ply" && io::is_textured_mesh(settings.mesh))
    for (const std::string& texture : io::textures_of_ply(settings.mesh))
      inputs.push_back(settings.mesh.parent_path() / texture);
  const std::vector<fs::path> outputs = map_files(settings).all();
  require_no_inputs(outputs, inputs, "--output-file");
  std::error_code ignored;
  fs::create_directories(settings.output.parent_path(), ignored);
  for (const fs::path& file : outputs) require_writable(file);
}

struct PlacedMap {
  map::MapFrame frame;
  LocalFrame mesh_frame;
  map::MapGrid grid;
  bool is_georeferenced = false;
};

std::vector<Eigen::Vector3d> centres_of(const std::vector<texture::View>& views) {
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(views.size());
  for (const texture::View& view : views) centres.push_back(view.pose.centre);
  return centres;
}

double pixel_of(const Settings& settings, const Mesh& mesh,
                const std::vector<texture::View>& views) {
  if (settings.pixel > 0) return settings.pixel;
  std::vector<map::Photo> photos;
  photos.reserve(views.size());
  for (const texture::View& view : views) photos.push_back({view.camera, view.pose});
  return map::rounded_width(map::median_pixel_width(mesh, photos));
}

// Heights are along z if the coordinates of the scene are those of a reference system: if the scene
// has an offset, or if the user names the system.
PlacedMap place_map(const Settings& settings, const Mesh& mesh, const LocalFrame& frame,
                    const std::vector<texture::View>& views) {
  const bool has_system = !frame.is_world() || settings.epsg > 0;
  const Eigen::Vector3d up = settings.up  ? *settings.up
                             : has_system ? Eigen::Vector3d::UnitZ()
                                          : map::fitted_up(mesh, centres_of(views));
  PlacedMap map;
  map.mesh_frame = frame;
  map.frame = map::frame_with_up(up, frame);
  map.is_georeferenced = has_system && map.frame.axes.isIdentity(0);
  map.grid = map::grid_around(mesh, map.frame, pixel_of(settings, mesh, views), option_of);
  const auto& axes = map.frame.axes;
  log_info("map of {} x {} pixels of {:.4g} m", map.grid.columns, map.grid.rows, map.grid.pixel);
  log_info("map's x: {:.4f} {:.4f} {:.4f}, y: {:.4f} {:.4f} {:.4f}, up: {:.4f} {:.4f} {:.4f}",
           axes(0, 0), axes(0, 1), axes(0, 2), axes(1, 0), axes(1, 1), axes(1, 2), axes(2, 0),
           axes(2, 1), axes(2, 2));
  return map;
}

texture::Options texture_options(const Settings& settings,
                                 const texture::Photographs& photographs) {
  texture::Options options;
  options.max_bytes = std::max<std::uint64_t>(memory_of(settings).left(), 1);  // 0: no limit
  options.image_bytes = photographs.bytes_to_load();
  options.name_of = option_of;
  return options;
}

// The number of views that see each face.
std::vector<std::uint16_t> count_views(const Mesh& mesh, const Settings& settings,
                                       const texture::Photographs& photographs) {
  const texture::FaceViews seen = texture::find_face_views(
      mesh, photographs.views(), [&](std::size_t view) { return photographs.load(view); }, {},
      console_progress("Numbers of views"),
      {texture::Budget(std::max<std::uint64_t>(memory_of(settings).left(), 1), option_of),
       photographs.bytes_to_load()});
  std::vector<std::uint16_t> counts(seen.faces());
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max() - 1u;  // the last is none
  for (std::size_t f = 0; f < counts.size(); ++f)
    counts[f] = static_cast<std::uint16_t>(std::min(seen.of(f).size(), kMost));
  return counts;
}

TexturedMesh textured(TexturedMesh mesh, const Settings& settings,
                      const texture::Photographs& photographs) {
  if (!mesh.textures.empty()) return mesh;
  TexturedMesh result = texture::texture_mesh(
      std::move(mesh.mesh), photographs.views(),
      [&](std::size_t view) { return photographs.load(view); },
      texture_options(settings, photographs), nullptr,
      [](const std::string& stage) { return console_progress(stage); });
  return_freed_memory();
  return result;
}

void write(const Settings& settings, const TexturedMesh& mesh,
           const std::vector<std::uint16_t>& views, const PlacedMap& place,
           const std::string& crs) {
  map::WriteOptions options;
  options.crs = crs;
  options.is_georeferenced = place.is_georeferenced;
  options.mesh_frame = place.mesh_frame;
  options.contour_interval = settings.contours;
  options.memory = memory_of(settings);
  options.name_of = option_of;
  const map::MapFiles files = map_files(settings);
  const map::MapReport report =
      map::write_maps(files, {mesh, views, place.frame, place.grid}, options,
                      [](const std::string& stage) { return console_progress(stage); });
  const auto share = [&](std::int64_t pixels) {
    return 100.0 * static_cast<double>(pixels) / static_cast<double>(place.grid.pixels());
  };
  log_info("{:.1f} % of the map have a height, {:.1f} % have a colour", share(report.surface),
           share(report.colored));
  for (const fs::path& file : files.all()) log_info("wrote {}", file.string());
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const Settings& settings = options.settings;
  const ThreadLimit limit(options.parsed.common.max_threads);
  const std::string crs = settings.epsg > 0 ? map::crs_of_epsg(settings.epsg, option_of) : "";
  if (const auto counts = io::count_mvs(settings.scene.scene))
    memory_of(settings).require(counts->reading_bytes(),
                                "reading " + settings.scene.scene.string());
  io::SceneWithCameras scene = io::read_scene_with_cameras(settings.scene);
  TexturedMesh mesh = read_mesh(settings, scene.frame);
  const texture::Photographs photographs(scene.scene, settings.scene.scene, settings.photographs);
  const LocalFrame frame = scene.frame;
  scene = {};
  return_freed_memory();
  const auto& views = photographs.views();
  naming(settings.mesh, [&] {
    check_mesh(mesh.mesh);
    const PlacedMap place = place_map(settings, mesh.mesh, frame, views);
    keep_inputs(settings, photographs);
    mesh = textured(std::move(mesh), settings, photographs);
    const std::vector<std::uint16_t> counts = count_views(mesh.mesh, settings, photographs);
    return_freed_memory();
    write(settings, mesh, counts, place, crs);
  });
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("MapSurface", [&] { return axial::apps::run(argc, argv); });
}
