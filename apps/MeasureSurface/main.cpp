// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the surface of a mesh in polygons that were drawn on a map.

#include <algorithm>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "base/parallel.h"
#include "base/same_file.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "map/area_table.h"
#include "map/world_axes.h"
#include "scene/check_mesh.h"
#include "scene/marked_faces.h"
#include "settings.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The axes of the map, and its coordinate reference system as WKT (empty: none).
struct MapPlace {
  map::WorldAxes axes;
  std::string crs;
};

MapPlace place_of(const Settings& settings) {
  MapPlace place;
  if (settings.map.empty()) {
    if (settings.epsg > 0) place.crs = map::crs_of_epsg(settings.epsg);
    const Eigen::Vector3d up = settings.up.value_or(Eigen::Vector3d::UnitZ());
    place.axes.axes = map::frame_with_up(up, {}).axes;
    return place;
  }
  const map::StatedPlace stated = map::stated_place(settings.map);
  if (!stated.axes) fail_in(settings.map, "does not state its axes: is it a map of MapSurface?");
  place.axes = *stated.axes;
  place.crs = stated.crs;
  return place;
}

// The faces that cameras have seen, in coordinates of the map minus `origin`, which is set to a
// place near the mesh.
Mesh read_mesh(const fs::path& file, const map::WorldAxes& axes, Eigen::Vector3d& origin,
               const Context& context) {
  context.memory().require(2 * io::bytes_to_read_mesh(file), "reading " + file.string());
  const LocalFrame frame = frame_near(io::mesh_place(file).first_vertex);
  Mesh mesh = io::read_shape(file, frame);
  mesh.colors = {};
  naming(file, [&] { check_mesh(mesh); });
  remove_marked_faces(mesh);
  if (mesh.faces.empty()) fail_in(file, "has no face that cameras have seen");
  const Eigen::Vector3d at = axes.axes * frame.origin + axes.offset;
  origin = at.array().round();
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (axes.axes * vertex.cast<double>() + (at - origin)).cast<float>();
  log_info("{}: {} vertices, {} faces", file.string(), mesh.vertices.size(), mesh.faces.size());
  return mesh;
}

std::vector<map::MeasuredArea> measure(const Mesh& mesh, const Eigen::Vector3d& origin,
                                       const std::vector<map::Area>& areas,
                                       const Context& context) {
  context.memory().require(geometry::bytes_of_surface(mesh), "measuring the mesh");
  const map::AreaMeter meter(mesh, origin);
  std::vector<map::MeasuredArea> measured(areas.size());
  ProgressCounter progress(context.stage("Measured polygons"), areas.size());
  parallel_for(areas.size(), [&](std::size_t i) {
    measured[i] = {areas[i], meter.measure(areas[i])};
    progress.add();
  });
  return measured;
}

void report(const std::vector<map::MeasuredArea>& areas, const fs::path& mesh) {
  constexpr double kHole = 0.99;
  std::size_t empty = 0;
  for (const map::MeasuredArea& one : areas) {
    const map::AreaMeasures& found = one.measures;
    if (!(found.planar > 0)) {
      ++empty;
      log_warning("polygon '{}': the mesh has no surface there", one.area.name);
    } else if (found.planar < kHole * found.polygon) {
      log_warning("polygon '{}': only {:.1f} % of it has a surface", one.area.name,
                  100 * found.planar / found.polygon);
    }
  }
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
  inputs.push_back(settings.areas);
  inputs.push_back(settings.map);
  for (const fs::path& file : {csv, package}) require_not_an_input(file, inputs, "--output-file");
  const MapPlace place = place_of(settings);
  const std::vector<map::Area> areas = map::read_areas(settings.areas, place.crs);
  Eigen::Vector3d origin;
  const Mesh mesh = read_mesh(settings.mesh, place.axes, origin, context);
  const std::vector<map::MeasuredArea> measured = measure(mesh, origin, areas, context);
  report(measured, settings.mesh);
  map::write_area_csv(csv, measured, settings.length_sigma);
  map::write_area_package(package, measured, settings.length_sigma, place.crs);
  log_info("{} polygons measured: {}, {}", measured.size(), csv.string(), package.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("MeasureSurface", [&] { return axial::apps::run(argc, argv); });
}
