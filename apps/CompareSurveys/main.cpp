// SPDX-License-Identifier: GPL-3.0-or-later
// Finds what changed between two surveys of the same place: maps of differences, volumes.

#include <memory>
#include <numbers>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
#include "boundary/boundary.h"
#include "compare/write_changes.h"
#include "geometry/faces.h"
#include "geometry/seen_part.h"
#include "io/cameras/geo_offset.h"
#include "io/frames/lost_offset.h"
#include "io/openmvs/point_source.h"
#include "io/openmvs/scene_files.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"
#include "map/map_place.h"
#include "map/up_direction.h"
#include "scene/check_mesh.h"
#include "scene/marked_faces.h"
#include "settings.h"
#include "survey/survey.h"
#include "targets.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

compare::ChangeFiles change_files(const Settings& settings) {
  const auto named = [&](const char* end) { return fs::path(settings.output.string() + end); };
  return {named(".change.difference.tif"), named(".change.significant.tif"),
          named(".change.sigma.tif"), named(".change.json"), named(".change.jpg")};
}

// The offset of the scene if the mesh has lost it (io::is_without_offset()); otherwise the world.
LocalFrame lost_offset(const fs::path& mesh, const fs::path& scene) {
  if (scene.empty()) return {};
  const LocalFrame frame = io::read_geo_offset_beside(scene).value_or(LocalFrame{});
  return io::is_without_offset(frame, mesh) ? frame : LocalFrame{};
}

// The shape of a survey in `frame`. `scene`: of the survey; empty: not known.
Mesh read_shape(const fs::path& path, const fs::path& scene, const LocalFrame& frame,
                const Context& context) {
  const LocalFrame lost = lost_offset(path, scene);
  if (lost.is_world()) return io::read_shape(path, frame);
  io::tell_lost_offset(path, lost, context);
  Mesh mesh = io::read_shape(path);
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = frame.to_local(lost.to_world(vertex.cast<double>())).cast<float>();
  return mesh;
}

Mesh read_survey(const fs::path& path, const fs::path& scene, const LocalFrame& frame,
                 const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(path), "reading " + path.string());
  Mesh mesh = read_shape(path, scene, frame, context);
  mesh.colors = {};
  naming(path, [&] { check_mesh(mesh); });
  remove_marked_faces(mesh);
  if (mesh.faces.empty()) fail_in(path, "all faces are marked as unseen");
  log_info("{}: {} vertices, {} faces", path.string(), mesh.vertices.size(), mesh.faces.size());
  return_freed_memory();
  return mesh;
}

// A mesh and its file.
struct MeshFile {
  const Mesh& mesh;
  const fs::path& path;
};

// The photographs of a survey, in the frame of the meshes. None without a scene.
std::vector<geometry::PosedCamera> read_photos(const Settings& settings, const fs::path& path,
                                               const LocalFrame& frame, const MeshFile& survey,
                                               const Context& context) {
  std::vector<geometry::PosedCamera> photos;
  if (path.empty()) return photos;
  survey::Options options;
  options.files.scene = path;
  options.files.working_folder = settings.working_folder;
  survey::Survey scene = survey::open_scene(options, context);
  enter(LocalFrame{frame.origin - scene.frame.origin}, scene.scene);
  photos = geometry::posed_cameras(scene.scene);
  if (photos.empty()) fail_in(path, "has no calibrated image");
  belong::check_surface(scene.scene, belong::shape_of(survey.mesh), {survey.path, path}, context);
  return photos;
}

// A frame near the mesh of the earlier survey.
LocalFrame frame_of_survey(const fs::path& path, const fs::path& scene, const Context& context) {
  if (const LocalFrame lost = lost_offset(path, scene); !lost.is_world()) return lost;
  context.memory().require(io::bytes_to_read_mesh(path), "reading " + path.string());
  return frame_near(io::mesh_place(path).first_vertex);
}

void keep_inputs(const Settings& settings) {
  const std::vector<fs::path> outputs = change_files(settings).all();
  std::vector<fs::path> inputs = io::files_of_mesh(settings.before);
  for (const fs::path& file : io::files_of_mesh(settings.after)) inputs.push_back(file);
  for (const fs::path& scene : {settings.scene_before, settings.scene_after}) {
    if (scene.empty()) continue;
    for (const fs::path& file : io::files_of_scene({scene, settings.working_folder, {}}))
      inputs.push_back(file);
  }
  for (const fs::path& file : {settings.targets_before, settings.targets_after})
    if (!file.empty()) inputs.push_back(file);
  for (const fs::path& file : settings.boundary.inputs()) inputs.push_back(file);
  survey::keep_inputs(outputs, inputs, "--output-file");
}

// True if the coordinates of the surveys are those of a reference system: if they are far from the
// origin, or if the user names the system.
bool has_system(const Settings& settings, const LocalFrame& frame) {
  return !frame.is_world() || settings.epsg > 0;
}

// The boundary, whose targets are those of the earlier survey.
boundary::Options boundary_of(const Settings& settings) {
  boundary::Options options = settings.boundary;
  if (!options.targets.empty() && options.places.empty()) options.places = settings.targets_before;
  return options;
}

// The test of the places to compare.
std::function<bool(const Eigen::Vector2d&)> inside_of(const Settings& settings,
                                                      const std::string& crs,
                                                      const map::MapFrame& map_frame,
                                                      const LocalFrame& frame) {
  if (!settings.boundary.is_given()) return {};
  const auto boundary = std::make_shared<const boundary::Boundary>(boundary::read_boundary(
      boundary_of(settings), map::world_axes(map_frame, frame), crs, frame, settings.before));
  return [boundary](const Eigen::Vector2d& place) { return boundary->contains_on_map(place); };
}

// Which side of a survey's surface is the near one.
struct NearSide {
  fs::path mesh;
  bool is_seen = false;    // the cameras of a scene show it; false: the faces are turned to it
  Eigen::Vector3d facing;  // the mean normal
};

// Removes stray faces of the survey if its photographs are known.
NearSide near_side(const fs::path& path, const std::vector<geometry::PosedCamera>& photos,
                   Mesh& mesh, const Context& context) {
  return naming(path, [&]() -> NearSide {
    const Eigen::Vector3d turned = geometry::mean_normal(mesh);
    if (photos.empty()) return {path, false, turned};
    context.memory().require(geometry::bytes_of_sights(mesh), "what the cameras see");
    const geometry::SeenPart part = geometry::find_seen_part(mesh, photos);
    geometry::warn_if_inside_out(part, path, context);
    geometry::warn_of_strays(part, path, mesh.faces.size(), context);
    geometry::erase_at(part.strays, mesh.faces);
    return_freed_memory();
    if (part.facing.isZero(0)) return {path, false, turned};
    return {path, true, part.facing};
  });
}

// Both surveys in the frame of the earlier one.
struct Surveys {
  LocalFrame frame;
  Mesh before, after;
  NearSide near_before, near_after;
};

// Error if the map would show the far side of a survey: what came would count as gone.
void check_up(const Settings& settings, const LocalFrame& frame, const Eigen::Vector3d& up,
              const NearSide& side) {
  if (!map::shows_far_side(up, side.facing)) return;
  const std::string name = side.mesh.string();
  const char* what = side.is_seen ? "the cameras of" : "the side to which the faces are turned of";
  const char* remedy =
      side.is_seen ? ""
                   : "; if the faces are turned the wrong way, flip them in an editor, or give "
                     "--scene and --other-scene, whose cameras show which side is up";
  if (!settings.boundary.map.empty())
    fail_in(settings.boundary.map,
            "its heights point away from {} {}, so that what came would count as gone{}", what,
            name, remedy);
  if (settings.up && settings.epsg == 0)
    fail("--up {}: points away from {} {}, so that what came would count as gone; give --up {}{}",
         map::up_text(up), what, name, map::up_text(-up), remedy);
  if (has_system(settings, frame))
    fail_in(name,
            "z points away from {} the mesh, so that what came would count as gone: are the "
            "positions depths, positive downwards, or do they state northing before easting?{}",
            what, remedy);
  fail_in(name, "is turned to the other side than {}: one of the meshes is inside out{}",
          settings.before.string(), remedy);
}

// `wanted`: the axes that the user wants, or nothing.
map::MapFrame place_map(const Settings& settings, const std::optional<map::WorldAxes>& wanted,
                        const Surveys& surveys) {
  const LocalFrame& frame = surveys.frame;
  const Eigen::Vector3d up =
      wanted        ? Eigen::Vector3d(wanted->axes.row(2).transpose())
      : settings.up ? *settings.up
      : has_system(settings, frame)
          ? Eigen::Vector3d::UnitZ()
          : naming(settings.before, [&] {
              return compare::upward_direction(surveys.before, surveys.near_before.facing);
            });
  check_up(settings, frame, up, surveys.near_before);
  check_up(settings, frame, up, surveys.near_after);
  return wanted ? map::frame_on(*wanted, frame) : map::frame_with_up(up, frame);
}

// `with`: what the registration used.
void report_motion(const compare::Registration& r, const std::string& with) {
  const Eigen::Vector3d shift = r.motion.translation * 1e3;
  const Eigen::Vector3d sigma = r.covariance.diagonal().tail<3>().cwiseMax(0).cwiseSqrt() * 1e3;
  const double angle = Eigen::AngleAxisd(r.motion.rotation).angle() * 180 / std::numbers::pi;
  log_info(
      "later survey moved by ({:.3f}, {:.3f}, {:.3f}) +- ({:.3f}, {:.3f}, {:.3f}) mm along the "
      "map's axes and by {:.4f} degrees, with {}",
      shift.x(), shift.y(), shift.z(), sigma.x(), sigma.y(), sigma.z(), angle, with);
}

void report_registration(const compare::Registration& r) {
  report_motion(r, fmt::format("{:.1f} % of the ground", 100 * r.share_used));
  if (r.determined < 6)
    log_warning("the ground determines only {} of 6 directions of motion: it is too level",
                r.determined);
  if (r.share_used < 0.5)
    log_warning(
        "--align icp: less than half of the ground agrees: are the surveys nearly in one frame, "
        "and "
        "of the same scale?");
  if (!r.converged) log_warning("--align icp: did not converge after {} steps", r.iterations);
}

// Warns if most of the map changed: the estimated noise then contains the changes.
void warn_of_large_changes(const compare::Comparison& comparison) {
  constexpr double kMuch = 5;
  const compare::Changes& changes = comparison.changes;
  const compare::Noise& noise = comparison.noise;
  if (changes.came.area + changes.gone.area > 0.5 * changes.area_compared)
    log_warning("more than half of the map changed: are both surveys in one frame?");
  if (!noise.is_given && noise.typical > kMuch * noise.local && noise.local > 0)
    log_warning(
        "the noise of {:.3f} mm is {:.1f} times that between neighbouring pixels: if more than "
        "half of the map changed, changes count as noise; --sigma-before and --sigma-after state "
        "the noise",
        noise.typical * 1e3, noise.typical / noise.local);
}

void report_place(const compare::PlaceAgreement& place) {
  if (place.verdict == compare::PlaceVerdict::unknown)
    return log_info(
        "the surveys have too little relief in common to tell whether they show the same place");
  log_info("correlation of the reliefs of both surveys: {:.2f}; by chance: {:.2f}",
           place.correlation, place.chance);
  if (place.verdict == compare::PlaceVerdict::different)
    log_warning("--allow-other-place: the surveys show different places");
}

void report(const compare::Comparison& comparison) {
  report_place(comparison.place);
  const compare::Changes& changes = comparison.changes;
  log_info("map of {} x {} pixels of {:.4g} m, {:.4g} m^2 compared", comparison.grid.columns,
           comparison.grid.rows, comparison.grid.pixel, changes.area_compared);
  log_info("noise of the difference {:.3f} mm ({:.3f} to {:.3f} mm), registration {:.3f} mm",
           comparison.noise.typical * 1e3, comparison.noise.lowest * 1e3,
           comparison.noise.highest * 1e3, comparison.registration_sigma * 1e3);
  const auto line = [&](const char* what, const compare::Volume& volume) {
    log_info("{}: {:.6g} +- {:.2g} m^3 on {:.4g} m^2 ({:.2f} % of the area)", what, volume.volume,
             volume.sigma, volume.area, 100 * volume.area / changes.area_compared);
  };
  line("came", changes.came);
  line("gone", changes.gone);
  if (comparison.area_unseen > 0)
    log_info("{:.4g} m^2 were not compared, because too few photographs see them",
             comparison.area_unseen);
  if (comparison.area_unseen > changes.area_compared)
    log_warning(
        "--min-views: less than half of the common ground was compared, because fewer photographs "
        "of a survey than this number see the rest");
  warn_of_large_changes(comparison);
}

// Reads the surveys and the photographs of `settings`. `by_targets`: how the later survey is moved;
// empty: not here.
Surveys read_surveys(Settings& settings, const std::optional<ByTargets>& by_targets,
                     const Context& context) {
  Surveys surveys;
  compare::SurveyPhotos& photos = settings.compare.photos;
  surveys.frame = frame_of_survey(settings.before, settings.scene_before, context);
  const LocalFrame later =
      by_targets ? frame_of_survey(settings.after, settings.scene_after, context) : surveys.frame;
  surveys.before = read_survey(settings.before, settings.scene_before, surveys.frame, context);
  surveys.after = read_survey(settings.after, settings.scene_after, later, context);
  photos.before = read_photos(settings, settings.scene_before, surveys.frame,
                              {surveys.before, settings.before}, context);
  photos.after =
      read_photos(settings, settings.scene_after, later, {surveys.after, settings.after}, context);
  return_freed_memory();
  surveys.near_before = near_side(settings.before, photos.before, surveys.before, context);
  surveys.near_after = near_side(settings.after, photos.after, surveys.after, context);
  if (by_targets)
    move_later(*by_targets, later, surveys.frame, surveys.after, photos.after,
               surveys.near_after.facing);
  return surveys;
}

void report(const compare::Comparison& comparison, const std::optional<ByTargets>& by_targets,
            bool aligned) {
  if (by_targets) {
    report_motion(comparison.registration,
                  fmt::format("{} targets", by_targets->found.used.size()));
    report(*by_targets);
  } else if (aligned) {
    report_registration(comparison.registration);
  }
  report(comparison);
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  Settings settings = options.settings;
  const Context context = program_context(options.parsed);
  compare::ChangeFacts facts{settings.before.filename().string(),
                             settings.after.filename().string()};
  if (settings.epsg > 0) facts.crs = map::crs_of_epsg(settings.epsg);
  const std::optional<map::WorldAxes> wanted = boundary::take_map(settings.boundary, facts.crs);
  const OutputLock lock = lock_output(change_files(settings).difference);
  const std::optional<ByTargets> by_targets = register_by_targets(settings);
  boundary::check_files(boundary_of(settings), settings.before, facts.crs);
  if (settings.align == Align::automatic) settings.compare.align = !by_targets;
  const Surveys surveys = read_surveys(settings, by_targets, context);
  facts.mesh_frame = surveys.frame;
  facts.aligned = settings.compare.align || by_targets;
  const map::MapFrame map_frame = place_map(settings, wanted, surveys);
  const bool is_known = has_system(settings, surveys.frame) || !facts.crs.empty();
  facts.is_georeferenced =
      is_known && (map_frame.axes.isIdentity(0) || (wanted && !facts.crs.empty()));
  if (by_targets) {
    facts.by_targets = by_targets->found;
    facts.labels = by_targets->labels;
    settings.compare.registered = compare::on_map(by_targets->found, map_frame, surveys.frame);
  }
  settings.compare.is_inside = inside_of(settings, facts.crs, map_frame, surveys.frame);
  keep_inputs(settings);
  settings.compare.name_before = settings.before;
  settings.compare.name_after = settings.after;
  const compare::Comparison comparison =
      compare::compare_surveys(surveys.before, surveys.after, map_frame, settings.compare, context);
  report(comparison, by_targets, settings.compare.align);
  const compare::ChangeFiles files = change_files(settings);
  compare::write_changes(files, comparison, facts);
  for (const fs::path& file : files.all()) log_info("wrote {}", file.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("CompareSurveys", [&] { return axial::apps::run(argc, argv); });
}
