// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the surface of a mesh in polygons that were drawn on a map.

#include <string>
#include <utility>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "earlier.h"
#include "geometry/faces.h"
#include "geometry/joined_vertices.h"
#include "geometry/vertex_bends.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "map/area_table.h"
#include "map/up_direction.h"
#include "map/world_axes.h"
#include "scene/check_mesh.h"
#include "scene/marked_faces.h"
#include "settings.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// Turns a mesh whose faces look down. Its lower side is not what a map shows.
void turn_up(Mesh& mesh, const fs::path& file) {
  if (!map::shows_far_side(Eigen::Vector3d::UnitZ(), geometry::mean_normal(mesh))) return;
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  log_warning(
      "{}: its faces are turned down: their other side is measured. Is the mesh inside out, or "
      "does --up point the wrong way?",
      file.string());
}

// A place near a mesh on the map, and the frame of the mesh's file there.
struct Near {
  LocalFrame frame;
  Eigen::Vector3d at, origin;  // of the frame [map], and the same in whole metres
};

Near near_mesh(const fs::path& file, const map::WorldAxes& axes, const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(file), "reading " + file.string());
  const LocalFrame frame = frame_near(io::mesh_place(file).first_vertex);
  const Eigen::Vector3d at = axes.axes * frame.origin + axes.offset;
  return {frame, at, at.array().round()};
}

// The mesh without the faces that are marked as unseen, in coordinates of the map minus the origin
// of `near`.
Mesh read_mesh(const fs::path& file, const map::WorldAxes& axes, const Near& near,
               const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(file), "reading " + file.string());
  Mesh mesh = io::read_shape(file, near.frame);
  mesh.colors = {};
  naming(file, [&] { check_mesh(mesh); });
  const std::size_t unseen = remove_marked_faces(mesh);
  if (unseen > 0) log_info("{} faces are left out: they are marked as unseen", unseen);
  if (mesh.faces.empty()) fail_in(file, "has no faces, or all are marked as unseen");
  geometry::join_vertices(mesh);  // for the noise, which is found from neighbours
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (axes.axes * vertex.cast<double>() + (near.at - near.origin)).cast<float>();
  turn_up(mesh, file);
  log_info("{}: {} vertices, {} faces", file.string(), mesh.vertices.size(), mesh.faces.size());
  return mesh;
}

std::vector<map::MeasuredArea> measure(const Mesh& mesh, const Eigen::Vector3d& origin,
                                       const std::vector<map::Area>& areas, const fs::path& file,
                                       const Context& context) {
  constexpr std::uint64_t kOfSmoothed = 2 * (sizeof(Eigen::Vector3f) + sizeof(Eigen::Vector3d));
  context.memory().require(2 * map::AreaMeter::bytes(mesh) + kOfSmoothed * mesh.vertices.size() +
                               sizeof(mesh.faces[0]) * mesh.faces.size(),
                           "measuring the mesh");
  const Mesh smooth = geometry::smoothed(mesh);
  const map::AreaMeter meter(mesh, origin), of_smooth(smooth, origin);
  std::vector<map::MeasuredArea> measured(areas.size());
  ProgressCounter progress(context.stage("Measured polygons"), areas.size());
  parallel_for(areas.size(), [&](std::size_t i) {
    naming(file, [&] {
      measured[i] = {areas[i], meter.measure(areas[i]), of_smooth.measure(areas[i])};
    });
    progress.add();
  });
  return measured;
}

// Warns of polygons that the surface does not fill.
void report(const std::vector<map::MeasuredArea>& areas, const fs::path& mesh) {
  constexpr double kPart = 0.01;
  constexpr std::size_t kMostNamed = 5;
  std::size_t empty = 0, odd = 0;
  const auto warn = [&](const map::MeasuredArea& one, const std::string& what) {
    if (++odd <= kMostNamed) log_warning("polygon '{}': {}", one.area.name, what);
  };
  for (const map::MeasuredArea& one : areas) {
    const double share = one.measures.planar / one.measures.polygon;
    empty += share > 0 ? 0 : 1;
    if (!(share > 0))
      warn(one, "the mesh has no surface there");
    else if (share < 1 - kPart)
      warn(one, fmt::format("only {:.1f} % of it has a surface", 100 * share));
  }
  if (odd > kMostNamed)
    log_warning("{} more polygons: see planar_m2 and polygon_m2", odd - kMostNamed);
  if (empty == areas.size())
    fail_in(mesh, "has no surface in any polygon: are the coordinates those of the map?");
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Settings& settings = options.settings;
  const Context context = program_context(options.parsed);
  const fs::path csv = settings.output.string() + ".csv";
  const fs::path package = settings.output.string() + ".gpkg";
  const OutputLock lock = lock_output(csv);
  std::vector<fs::path> inputs = io::files_of_mesh(settings.mesh);
  if (!settings.earlier.empty())
    for (const fs::path& file : io::files_of_mesh(settings.earlier)) inputs.push_back(file);
  inputs.push_back(settings.areas);
  inputs.push_back(settings.place.map);
  for (const fs::path& file : {csv, package}) require_not_an_input(file, inputs, "--output-file");
  const map::MapPlace place = map::place_of(settings.place);
  const std::vector<map::Area> areas = map::read_areas(settings.areas, place.crs);
  const Near near = near_mesh(settings.mesh, place.axes, context);
  const Mesh mesh = read_mesh(settings.mesh, place.axes, near, context);
  std::vector<map::MeasuredArea> measured =
      measure(mesh, near.origin, areas, settings.areas, context);
  report(measured, settings.mesh);
  if (!settings.earlier.empty()) {
    const Mesh earlier = read_mesh(settings.earlier, place.axes, near, context);
    std::vector<map::MeasuredArea> before =
        measure(earlier, near.origin, areas, settings.areas, context);
    add_changes(settings, near.origin, {earlier, before}, {mesh, measured}, context);
  }
  map::write_areas({csv, package}, measured, settings.length_sigma, place.crs);
  log_info("{} polygons measured: {}, {}", measured.size(), csv.string(), package.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("MeasureSurface", [&] { return axial::apps::run(argc, argv); });
}
