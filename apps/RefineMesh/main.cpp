// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/error.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/point_source.h"
#include "io/openmvs/scene_files.h"
#include "io/textured/textured_mesh.h"
#include "mesh/cloud_source.h"
#include "mesh/point_distances.h"
#include "mesh/unseen.h"
#include "options.h"
#include "refine/state_file.h"
#include "scene/check_mesh.h"
#include "survey/fingerprint.h"
#include "survey/image_store.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// Where the state of a run is kept until the run is complete.
fs::path state_file(const Options& options) {
  return fs::path(options.output) += ".state";
}

survey::Survey open(const Options& options, const Context& context) {
  survey::Survey survey = survey::open_scene(options.survey, context);
  survey::find_photographs(survey, context);
  survey.add_inputs(io::files_of_mesh(options.mesh));
  survey.keep_inputs(std::vector{options.output, state_file(options)}, "--output-file");
  return survey;
}

// Sets `has_marks` if faces of the mesh are marked as unseen. The result has no marks.
Mesh read_mesh(const Options& options, const LocalFrame& frame, bool& has_marks,
               const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(options.mesh),
                           "reading " + options.mesh.string());
  Mesh mesh = io::read_mesh_of_scene(frame, options.mesh, context);
  naming(options.mesh, [&] { check_mesh(mesh); });
  if (mesh.faces.empty()) fail_in(options.mesh, "the mesh has no faces");
  context.info("Mesh {}: {} vertices, {} faces", options.mesh.filename().string(),
               mesh.vertices.size(), mesh.faces.size());
  has_marks = !mesh.unseen.empty();
  mesh.unseen = {};
  if (options.decimate == 1) return mesh;
  mesh::CleanOptions fewer = options.cleaning;
  fewer.decimate = options.decimate;
  context.memory().require(mesh::bytes_to_clean(mesh.vertices.size()),
                           "decimating " + options.mesh.string());
  return naming(options.mesh, [&] { return mesh::clean(mesh, fewer); });
}

// The state after the last resolution that an earlier run with the same input finished, or a state
// that begins with `mesh`.
refine::State first_state(Mesh mesh, const Options& options, const std::string& fingerprint,
                          const Context& context) {
  const fs::path file = state_file(options);
  if (auto state = refine::read_state(file, fingerprint)) {
    context.info("{}: {} of {} resolutions are done already", file.string(), state->done,
                 options.refine.scales);
    return std::move(*state);
  }
  refine::State state;
  state.mesh = std::move(mesh);
  return state;
}

Mesh refine_mesh(Mesh mesh, const survey::Survey& survey, const Options& options,
                 refine::StateOfRun& of_run, const Context& context) {
  const std::string fingerprint =
      refine::fingerprint(mesh, options.refine, survey::fingerprint_of_views(survey, context));
  refine::State state = first_state(std::move(mesh), options, fingerprint, context);
  return_freed_memory();
  const survey::ImageShares shares = survey::share_out(context.memory(), survey);
  survey::ImageStore images(survey, survey::Channels::grey, shares.images);
  images.check_all(1, context);
  refine::Options settings = options.refine;
  settings.bytes_afterwards = mesh::bytes_to_clean(1);
  naming(options.mesh, [&] {
    refine::refine(
        state, survey::posed_cameras(survey),
        [&](std::size_t view) {
          const auto image = images.get(view);
          return refine::Picture{image->grey, image->mask};
        },
        settings, [&](const refine::State& now) { of_run.write(now, fingerprint); },
        Context(context, shares.for_work));
  });
  survey.photograph_check->report(context);
  const refine::Report& report = state.report;
  context.info("{} vertices measured in {} pairs of images; median displacement {:.3g} m",
               report.measured, report.pairs, report.moved);
  return std::move(state.mesh);
}

// Points of the cloud beside the scene, of which the mesh was made. Empty if there is no cloud.
std::vector<Eigen::Vector3f> points_of(const survey::Survey& survey, std::size_t faces,
                                       const Context& context) {
  constexpr std::size_t kPortion = 1 << 16;
  const fs::path cloud = io::cloud_beside(survey.file());
  std::error_code error;
  if (!fs::is_regular_file(cloud, error) || io::ply_has_faces(cloud)) return {};
  return mesh::some_positions(
      [&](const io::CloudPortionSink& sink) {
        io::read_cloud_of_scene_in_portions(survey.frame, cloud, kPortion, sink, context);
      },
      mesh::enough_points(faces));
}

// Removes or marks the surface that no two cameras see.
Mesh without_unseen(Mesh mesh, const survey::Survey& survey, bool keep, const Context& context) {
  mesh::UnseenOptions unseen;
  unseen.keep = keep;
  const std::vector<Eigen::Vector3f> points = points_of(survey, mesh.faces.size(), context);
  unseen.points = points;
  return mesh::treat_unseen(std::move(mesh), survey::posed_cameras(survey), unseen, context);
}

void write(const fs::path& file, const Mesh& mesh, const LocalFrame& frame,
           const Context& context) {
  if (!mesh.unseen.empty() && file.extension() != ".ply")
    context.warning("{}: only PLY has marks of unseen faces: use --export-type ply", file.string());
  io::write_mesh(file, mesh, frame);
  context.info("{}: {} vertices, {} faces", file.string(), mesh.vertices.size(), mesh.faces.size());
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const Context context = program_context(options.parsed);
  const OutputLock lock = lock_output(options.output);
  const survey::Survey survey = open(options, context);
  bool has_marks = false;
  Mesh mesh = read_mesh(options, survey.frame, has_marks, context);
  belong::check_surface(survey.scene, belong::shape_of(mesh), {options.mesh, survey.file()},
                        context);
  points_of(survey, 1, context);  // a malformed cloud is an Error now, not after hours
  refine::StateOfRun state(state_file(options), context);
  mesh = refine_mesh(std::move(mesh), survey, options, state, context);
  return_freed_memory();
  mesh = naming(options.mesh, [&] {
    return without_unseen(mesh::clean(mesh, options.cleaning), survey,
                          options.close_unseen || has_marks, context);
  });
  state.writing([&] { write(options.output, mesh, survey.frame, context); });
  state.remove();
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("RefineMesh", [&] { return axial::apps::run(argc, argv); });
}
