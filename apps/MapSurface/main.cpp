// SPDX-License-Identifier: GPL-3.0-or-later
// Makes maps of a mesh: heights, an orthomosaic of photographs, and the numbers of views.

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "axial/map.h"
#include "axial/texture.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "base/parallel.h"
#include "base/program/option_values.h"
#include "belong/surface_check.h"
#include "boundary/boundary.h"
#include "boundary/cut_mesh.h"
#include "geometry/seen_part.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "map/height_error.h"
#include "map/local_coordinates.h"
#include "map/map_place.h"
#include "map/pixel_width.h"
#include "map/profiles.h"
#include "map/up_direction.h"
#include "outputs.h"
#include "scene/check_mesh.h"
#include "scene/marked_faces.h"
#include "settings.h"
#include "survey/photographs.h"
#include "texture/faces/face_views.h"
#include "texture/faces/photograph_source.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The mesh, with its textures if it has some.
TexturedMesh read_mesh(const Settings& settings, const LocalFrame& frame, const Context& context) {
  const std::string work = "reading " + settings.mesh.string();
  const std::uint64_t bytes = io::bytes_to_read_mesh(settings.mesh);
  context.memory().require(bytes, work);
  TexturedMesh mesh;
  if (io::is_textured_mesh(settings.mesh)) {
    context.memory().require(bytes + io::bytes_to_read_textures(settings.mesh, context), work);
    mesh = io::read_textured_mesh_of_scene(frame, settings.mesh, context);
  } else {
    mesh.mesh = io::read_mesh_of_scene(frame, settings.mesh, context);
  }
  if (mesh.mesh.faces.empty()) fail_in(settings.mesh, "the mesh has no faces");
  log_info("{}: {} vertices, {} faces, {} textures", settings.mesh.string(),
           mesh.mesh.vertices.size(), mesh.mesh.faces.size(), mesh.textures.size());
  mesh.mesh.colors = {};  // the textures give the colours
  const std::size_t unseen = naming(settings.mesh, [&] {
    check_mesh(mesh.mesh);
    return remove_marked_faces(mesh);
  });
  if (unseen > 0) log_info("{} faces are left out: they are marked as unseen", unseen);
  if (mesh.mesh.faces.empty()) fail_in(settings.mesh, "all faces are marked as unseen");
  return mesh;
}

struct PlacedMap {
  std::optional<boundary::Boundary> boundary;
  map::MapFrame frame;
  LocalFrame mesh_frame;
  map::MapGrid grid;
  bool is_georeferenced = false;
};

std::vector<Eigen::Vector3d> centres_of(const survey::Survey& survey) {
  std::vector<Eigen::Vector3d> centres;
  centres.reserve(survey.views.size());
  for (const survey::View& view : survey.views) centres.push_back(view.pose.centre);
  return centres;
}

// Prepares the mesh: removes stray faces, and turns a mesh that is inside out, because the sides
// that the cameras see are those to map. Returns the direction from which they are seen
// (geometry::SeenPart::facing).
Eigen::Vector3d keep_seen_part(const Settings& settings, const survey::Survey& survey,
                               TexturedMesh& mesh, const Context& context) {
  context.memory().require(geometry::bytes_of_sights(mesh.mesh), "what the cameras see");
  const geometry::SeenPart part =
      geometry::find_seen_part(mesh.mesh, survey::posed_cameras(survey));
  geometry::warn_if_inside_out(part, settings.mesh, context);
  geometry::warn_of_strays(part, settings.mesh, mesh.mesh.faces.size(), context);
  geometry::erase_at(part.strays, mesh.mesh.faces);
  geometry::erase_at(part.strays, mesh.uv);
  geometry::erase_at(part.strays, mesh.texture_of);
  if (part.is_inside_out()) {
    for (auto& face : mesh.mesh.faces) std::swap(face[1], face[2]);
    for (auto& uv : mesh.uv) std::swap(uv[1], uv[2]);
  }
  return_freed_memory();
  return part.facing;
}

// Error if the direction of --up shows the far side of what the cameras see. A warning if z is up
// for another reason: the coordinates may be right, as those of the roof of a cave.
void check_up(const Settings& settings, const Eigen::Vector3d& up, const Eigen::Vector3d& facing) {
  if (!map::shows_far_side(up, facing)) return;
  if (!settings.boundary.map.empty())
    fail_in(settings.boundary.map,
            "its heights point away from the cameras, so that the map would show the far side of "
            "the surface");
  if (settings.up && settings.epsg == 0)
    fail(
        "{} {}: points away from the cameras, so that the map would show the far side of the "
        "surface; give {} {}",
        setting("up"), map::up_text(up), setting("up"), map::up_text(-up));
  log_warning(
      "{}: the cameras are below the surface that they see, and the map shows its far side: are "
      "the positions depths, positive downwards, or do they state northing before easting?",
      settings.survey.files.scene.string());
}

// Error for a map that is far larger than the photographs can fill. `remedy`: the words before the
// option that makes pixels larger.
void require_resolved(const map::MapGrid& grid, const survey::Survey& survey, const char* remedy) {
  constexpr double kMost = 1000;  // as many pixels as all photographs have together
  double pixels = 0;
  for (const survey::View& view : survey.views) pixels += static_cast<double>(view.pixels());
  if (static_cast<double>(grid.pixels()) > kMost * pixels)
    fail(
        "the map would have {} x {} pixels of {:.4g} m, and all photographs together have {:.0f} "
        "times fewer: {} {}",
        grid.columns, grid.rows, grid.pixel, static_cast<double>(grid.pixels()) / pixels, remedy,
        setting("ground_sample_distance"));
}

double pixel_of(const Settings& settings, const Mesh& mesh, const survey::Survey& survey,
                const Context& context) {
  if (settings.pixel > 0) return settings.pixel;
  context.memory().require(map::bytes_of_pixel_width(mesh), "the width of a pixel");
  return map::rounded_width(map::median_pixel_width(mesh, survey::posed_cameras(survey)));
}

// Where the user wants the map.
struct WantedPlace {
  std::optional<map::WorldAxes> axes;
  std::string crs;  // WKT; empty: none
};

// Without wanted axes, heights are along z if the coordinates of the scene are those of a reference
// system: if the scene has an offset, or if the user names the system.
PlacedMap place_map(const Settings& settings, const Mesh& mesh, const survey::Survey& survey,
                    const WantedPlace& wanted, const Eigen::Vector3d& facing,
                    const Context& context) {
  const LocalFrame& frame = survey.frame;
  const bool has_system = !frame.is_world() || !wanted.crs.empty();
  const Eigen::Vector3d up = wanted.axes   ? Eigen::Vector3d(wanted.axes->axes.row(2).transpose())
                             : settings.up ? *settings.up
                             : has_system  ? Eigen::Vector3d::UnitZ()
                                           : map::fitted_up(mesh, centres_of(survey));
  check_up(settings, up, facing);
  PlacedMap map;
  map.mesh_frame = frame;
  map.frame = wanted.axes ? map::frame_on(*wanted.axes, frame) : map::frame_with_up(up, frame);
  // A registered survey is turned a little against a map with a reference system.
  map.is_georeferenced =
      has_system && (map.frame.axes.isIdentity(0) || (wanted.axes && !wanted.crs.empty()));
  map.grid.pixel = pixel_of(settings, mesh, survey, context);
  if (settings.boundary.is_given())
    map.boundary = boundary::read_boundary(settings.boundary, map::world_axes(map.frame, frame),
                                           wanted.crs, frame, settings.mesh);
  const auto& axes = map.frame.axes;
  log_info("map's x: {:.4f} {:.4f} {:.4f}, y: {:.4f} {:.4f} {:.4f}, up: {:.4f} {:.4f} {:.4f}",
           axes(0, 0), axes(0, 1), axes(0, 2), axes(1, 0), axes(1, 1), axes(1, 2), axes(2, 0),
           axes(2, 1), axes(2, 2));
  return map;
}

// Marks the faces outside of the boundary. They stay until the views of the others are known,
// because they hide parts of them.
void mark_outside(const PlacedMap& place, TexturedMesh& mesh, const Context& context) {
  context.memory().require(boundary::bytes_to_mark(mesh.mesh), "cutting the mesh at the boundary");
  const std::size_t outside = boundary::mark_outside(mesh, *place.boundary);
  log_info("{}: {} faces are inside and {} are left out", place.boundary->name(),
           mesh.mesh.faces.size() - outside, outside);
}

// The values of each face of the mesh that the maps show.
struct FaceFacts {
  std::vector<std::uint16_t> views;  // the number of views that see each face
  std::vector<float> errors;         // MapContent::errors
};

// The memory [bytes] of facts_of(), with the result.
std::uint64_t bytes_of_facts(const Mesh& mesh) {
  return mesh.faces.size() * (sizeof(std::uint16_t) + sizeof(float));
}

// The middle of a face, and its normal, of any length.
std::pair<Eigen::Vector3d, Eigen::Vector3d> middle_and_normal(const Mesh& mesh, std::size_t face) {
  Eigen::Matrix3d at;
  for (int k = 0; k < 3; ++k)
    at.col(k) = mesh.vertices[mesh.faces[face][static_cast<std::size_t>(k)]].cast<double>();
  return {at.rowwise().mean(), (at.col(1) - at.col(0)).cross(at.col(2) - at.col(0))};
}

FaceFacts facts_of(const Mesh& mesh, const texture::FaceViews& seen,
                   const std::optional<map::HeightErrors>& errors) {
  FaceFacts facts;
  facts.views.resize(seen.faces());
  if (errors) facts.errors.resize(seen.faces());
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max() - 1u;  // the last is none
  parallel_for(
      seen.faces(),
      [&](std::size_t f) {
        const auto sights = seen.of(f);
        facts.views[f] = static_cast<std::uint16_t>(std::min(sights.size(), kMost));
        if (!errors) return;
        std::vector<std::uint32_t> views;
        for (const texture::Sight& sight : sights) views.push_back(sight.view);
        const auto [middle, normal] = middle_and_normal(mesh, f);
        facts.errors[f] = errors->at(middle, normal, views);
      },
      kPointGrain);
  return facts;
}

// What is left besides FaceFacts. Splitting adds few faces to a large mesh.
MemoryBudget left_for_views(const Mesh& mesh, const MemoryBudget& memory) {
  const auto facts = memory.reserve(bytes_of_facts(mesh));
  return memory.share();
}

// The views of the faces of a mesh that has its textures.
FaceFacts look_at_faces(const Mesh& mesh, const survey::Photographs& photographs,
                        const std::optional<map::HeightErrors>& errors, const Context& context) {
  const texture::FaceViews seen = texture::find_face_views(
      mesh, survey::posed_cameras(photographs.survey()), texture::source_of(photographs), {},
      context.stage("Numbers of views"),
      {left_for_views(mesh, context.memory()), photographs.bytes_to_read_color()});
  return facts_of(mesh, seen, errors);
}

// Gives the mesh textures. `facts`: of the faces of the textured mesh.
TexturedMesh textured(TexturedMesh mesh, const survey::Photographs& photographs,
                      const std::optional<map::HeightErrors>& errors, FaceFacts& facts,
                      const Context& context) {
  texture::Options options;
  options.image_bytes = photographs.bytes_to_read_color();
  options.take_views = [&](const Mesh& split, const texture::FaceViews& seen) {
    facts = facts_of(split, seen, errors);
  };
  const Context texturing(context, left_for_views(mesh.mesh, context.memory()));
  TexturedMesh result =
      texture::texture_mesh(std::move(mesh.mesh), survey::posed_cameras(photographs.survey()),
                            texture::source_of(photographs), options, nullptr, texturing);
  return_freed_memory();
  return result;
}

// Chooses the pixels of the map: those of the boundary, or else those of the mesh.
void place_pixels(const Mesh& mesh, const survey::Survey& survey, PlacedMap& place) {
  const double pixel = place.grid.pixel;
  if (place.boundary) {
    naming(place.boundary->name(), [&] {
      place.grid = map::grid_over(place.boundary->extent(), pixel);
      require_resolved(place.grid, survey, "make the polygons smaller, or give a larger");
    });
  } else {
    place.grid = map::grid_around(mesh, place.frame, pixel);
    require_resolved(place.grid, survey,
                     "remove parts of the mesh that lie far away, or give a larger");
  }
  log_info("map of {} x {} pixels of {:.4g} m", place.grid.columns, place.grid.rows, pixel);
}

// Removes the faces that mark_outside() marked.
void remove_outside(TexturedMesh& mesh, FaceFacts& facts) {
  const std::vector<std::uint32_t> outside = boundary::outside_faces(mesh.mesh);
  geometry::erase_at(outside, facts.views);
  geometry::erase_at(outside, facts.errors);
  boundary::remove_outside(mesh);
}

void write(const Settings& settings, const TexturedMesh& mesh, const FaceFacts& facts,
           const PlacedMap& place, const map::MapFiles& files, const std::string& crs,
           const Context& context) {
  map::WriteOptions options;
  options.crs = crs;
  options.is_georeferenced = place.is_georeferenced;
  options.mesh_frame = place.mesh_frame;
  options.contour_interval = settings.contours;
  const map::MapReport report = map::write_maps(
      files, {mesh, facts.views, facts.errors, place.frame, place.grid}, options, context);
  const auto share = [&](std::int64_t pixels) {
    return 100.0 * static_cast<double>(pixels) / static_cast<double>(place.grid.pixels());
  };
  log_info("{:.1f} % of the map have a height, {:.1f} % have a colour", share(report.surface),
           share(report.colored));
  remove_stale_files(settings, files.all());
  for (const fs::path& file : files.all()) log_info("wrote {}", file.string());
}

// The textures of a mesh are its colours.
void leave_out_colors(const Options& options, survey::Options& survey) {
  warn_without_effect(options.parsed, {"colors"}, "on a mesh that has textures");
  survey.color_folder.clear();
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  Settings settings = options.settings;
  const Context context = program_context(options.parsed);
  WantedPlace wanted{{}, settings.epsg > 0 ? map::crs_of_epsg(settings.epsg) : ""};
  const std::string& crs = wanted.crs;
  wanted.axes = boundary::take_map(settings.boundary, wanted.crs);
  const OutputLock lock = lock_output(first_file(settings));
  survey::Survey survey = survey::open_scene(settings.survey, context);
  boundary::check_files(settings.boundary, settings.mesh, crs);
  if (!settings.profiles.empty()) map::read_lines(settings.profiles, crs);
  TexturedMesh mesh = read_mesh(settings, survey.frame, context);
  if (survey.frame.is_world())
    map::warn_of_local_coordinates(settings.epsg, settings.survey.files.scene, context);
  if (!mesh.textures.empty()) leave_out_colors(options, survey.options);
  belong::check_surface(survey.scene, belong::shape_of(mesh.mesh), {settings.mesh, survey.file()},
                        context);
  survey::find_photographs(survey, context);
  survey.add_inputs(io::files_of_mesh(settings.mesh));
  survey.add_inputs(settings.boundary.inputs());
  survey.add_inputs(std::vector<fs::path>{settings.profiles});
  survey.scene = {};
  return_freed_memory();
  const survey::Photographs photographs(survey);
  naming(settings.mesh, [&] {
    const Eigen::Vector3d facing = keep_seen_part(settings, survey, mesh, context);
    PlacedMap place = place_map(settings, mesh.mesh, survey, wanted, facing, context);
    if (place.boundary) mark_outside(place, mesh, context);
    place_pixels(mesh.mesh, survey, place);
    const map::MapFiles files = map_files(settings, survey, place.grid, crs);
    survey.keep_inputs(files.all(), setting("output_file"));
    std::optional<map::HeightErrors> errors;
    if (settings.image_noise > 0)
      errors.emplace(survey::posed_cameras(survey), place.frame.axes.row(2).transpose(),
                     settings.image_noise);
    FaceFacts facts;
    if (mesh.textures.empty())
      mesh = textured(std::move(mesh), photographs, errors, facts, context);
    else
      facts = look_at_faces(mesh.mesh, photographs, errors, context);
    if (place.boundary) remove_outside(mesh, facts);
    return_freed_memory();
    photographs.report(context);
    write(settings, mesh, facts, place, files, crs, context);
  });
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("MapSurface", [&] { return axial::apps::run(argc, argv); });
}
