// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/error.h"
#include "base/memory.h"
#include "base/naming.h"
#include "base/output_lock.h"
#include "belong/surface_check.h"
#include "boundary/cut_mesh.h"
#include "boundary/scene_boundary.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/point_source.h"
#include "io/textured/textured_mesh.h"
#include "mesh/clean.h"
#include "mesh/point_distances.h"
#include "mesh/unseen.h"
#include "options.h"
#include "scene/region.h"
#include "survey/survey.h"
#include "tiled.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// Several runs may make tiles of one mesh at the same time.
LockUse lock_use(const Options& options) {
  return options.tiling.tile ? LockUse::shared : LockUse::alone;
}

// The mesh beside which the places of targets are looked for.
const fs::path& mesh_to_cut(const Options& options) {
  return options.mesh.empty() ? options.output : options.mesh;
}

survey::Survey open(const Options& options, const Context& context) {
  survey::Survey survey = survey::open_scene(options.survey, context);
  survey.add_inputs(std::vector{cloud_file(options)});
  survey.add_inputs(io::files_of_mesh(options.mesh));
  survey.add_inputs(options.boundary.inputs());
  boundary::check_files(options.boundary, mesh_to_cut(options));
  survey.keep_inputs(std::vector{options.output}, "--output-file");
  if (auto& region = survey.scene.region) region = with_border(*region, options.roi_border);
  return survey;
}

Mesh reconstruct(const io::SceneWithCameras& scene, const Options& options,
                 const Context& context) {
  const fs::path file = cloud_file(options);
  if (!file.empty())
    context.memory().require(io::bytes_to_read_cloud(file), "reading " + file.string());
  PointCloud cloud =
      file.empty() ? cloud_of(scene.scene) : io::read_cloud_of_scene(scene.frame, file, context);
  const fs::path& source = file.empty() ? options.survey.files.scene : file;
  context.info("Cloud {}: {} points", source.filename().string(), cloud.size());
  if (!file.empty())
    belong::check_surface(scene.scene, belong::shape_of(cloud), {file, options.survey.files.scene},
                          context);
  return naming(source, [&] {
    return mesh::reconstruct(std::move(cloud), scene.scene, options.reconstruct, context);
  });
}

// Sets `keep` if the mesh has marks of unseen faces.
Mesh clean_given(const io::SceneWithCameras& scene, const Options& options, bool& keep,
                 const Context& context) {
  context.memory().require(io::bytes_to_read_mesh(options.mesh),
                           "reading " + options.mesh.string());
  const Mesh mesh = io::read_mesh_of_scene(scene.frame, options.mesh, context);
  belong::check_surface(scene.scene, belong::shape_of(mesh),
                        {options.mesh, options.survey.files.scene}, context);
  keep = keep || !mesh.unseen.empty();
  context.memory().require(mesh::bytes_to_clean(mesh.vertices.size()),
                           "cleaning " + options.mesh.string());
  return naming(options.mesh, [&] { return mesh::clean(mesh, options.reconstruct.clean); });
}

// Removes or marks the surface that no two cameras see.
Mesh without_unseen(Mesh mesh, const io::SceneWithCameras& scene, const Options& options, bool keep,
                    const Context& context) {
  context.memory().require(mesh::bytes_of_unseen(mesh),
                           "finding the surface that no two cameras see");
  const fs::path& source = options.mesh.empty() ? options.survey.files.scene : options.mesh;
  mesh::UnseenOptions unseen;
  unseen.keep = keep;
  const mesh::CleanOptions& clean = options.reconstruct.clean;
  unseen.sizes_tell = options.mesh.empty() && clean.decimate == 1 && clean.target_faces == 0 &&
                      clean.edge_length == 0;
  unseen.cut_off = clean.cut_off;
  std::vector<Eigen::Vector3f> points;
  if (unseen.sizes_tell)
    points = mesh::some_positions(source_of(scene, options, context),
                                  mesh::enough_points(mesh.faces.size()));
  unseen.points = points;
  return naming(source, [&] {
    return mesh::treat_unseen(std::move(mesh), geometry::posed_cameras(scene.scene), unseen,
                              context);
  });
}

// Removes what is outside of the boundary.
void cut(const io::SceneWithCameras& scene, const Options& options, Mesh& mesh,
         const Context& context) {
  if (!options.boundary.is_given()) return;
  boundary::SceneFacts facts{scene.frame, {}, mesh_to_cut(options)};
  for (const geometry::PosedCamera& camera : geometry::posed_cameras(scene.scene))
    facts.centres.push_back(camera.pose.centre);
  boundary::mark_outside(options.boundary, facts, mesh, context);
  boundary::remove_outside(mesh);
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
  const OutputLock lock = lock_output(options.output, lock_use(options));
  const survey::Survey scene = open(options, context);
  if (options.tiling.tile) {
    make_tile(scene, options, context);
    return 0;
  }
  bool keep = options.close_unseen;
  Mesh mesh = options.tiling.count > 1 ? join_tiles(scene, options, context)
              : options.mesh.empty()   ? reconstruct(scene, options, context)
                                       : clean_given(scene, options, keep, context);
  return_freed_memory();
  mesh = without_unseen(std::move(mesh), scene, options, keep, context);
  cut(scene, options, mesh, context);
  write(options.output, mesh, scene.frame, context);
  remove_tiles(options);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("ReconstructMesh", [&] { return axial::apps::run(argc, argv); });
}
