// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/parallel.h"
#include "io/colmap.h"
#include "io/colmap_scene.h"
#include "io/geo_offset.h"
#include "io/housing.h"
#include "io/lenses.h"
#include "io/mvs.h"
#include "options.h"
#include "pose/colmap_bundle.h"

namespace fs = std::filesystem;
using namespace axial;

namespace {

std::size_t count_behind_ports(const Scene& scene) {
  std::size_t count = 0;
  for (const SceneImage& image : scene.images) count += image.camera.port.has_value();
  return count;
}

std::size_t count_distorted(const Scene& scene) {
  std::size_t count = 0;
  for (const SceneImage& image : scene.images) count += image.camera.distortion.has_value();
  return count;
}

// Of the file, or else what the model's cameras carry. COLMAP-Underwater writes ports into models
// whose poses it solved without refraction, too, and the files do not say so: the tracks do.
io::Housing load_housing(const Options& options, const io::ColmapModel& model) {
  if (!options.housing_file.empty()) return io::read_housing(options.housing_file);
  const io::Housing carried = io::housing_of(model.cameras);
  if (carried.ports.empty()) return carried;
  const pose::PortFit fit = pose::port_fit(model);
  log_info("The model's cameras carry ports: its points are {:.3f} px off behind them",
           fit.behind_ports);
  if (fit.behind_ports > fit.in_air)
    log_warning(
        "The points are {:.3f} px off in air: the poses were solved without refraction. "
        "RefinePoses makes refractive ones of them",
        fit.in_air);
  return carried;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const ThreadLimit threads(options.parsed.common.max_threads);

  const fs::path model_folder = io::find_colmap_model(options.colmap_folder);
  io::ColmapModel model = io::read_colmap_model(model_folder);
  log_info("{}: {} images, {} cameras, {} points", model_folder.string(), model.images.size(),
           model.cameras.size(), model.points.size());
  const LocalFrame frame = io::enter_local_frame(model);
  const io::Housing housing = load_housing(options, model);
  log_info("Images in {}", options.image_folder.string());

  const fs::path folder = options.scene_file.parent_path();
  make_folder(folder);
  const fs::path housing_file = io::housing_beside(options.scene_file);
  std::error_code ignored;
  const bool behind_ports = !housing.ports.empty() || fs::exists(housing_file, ignored);
  const bool undistort = options.undistort.value_or(!behind_ports);
  const io::ColmapImport import{model_folder, options.image_folder, folder / "undistorted",
                                undistort};
  Scene scene = io::import_colmap_scene(model, import, console_progress("Undistorted images"));

  const io::Lenses lenses = io::lenses_of(scene, options.scene_file);
  // The housing goes first: a scene without the one it was made with would count as dry.
  if (options.housing_file.empty() && housing.ports.empty()) {
    if (behind_ports)
      log_warning("{}: is left as it is, and goes with this scene", housing_file.string());
  } else {
    const io::Housing by_image = io::housing_by_image(housing, model, scene, import);
    for (const std::string& entry : io::unused_entries(housing, model))
      log_warning("{}: no image goes by {}", options.housing_file.string(), entry);
    io::attach_ports(scene, io::in_frame(frame, by_image));
    io::write_housing(housing_file, by_image);
    log_info("{}: {} of {} images behind a port", housing_file.string(), count_behind_ports(scene),
             scene.images.size());
  }
  io::write_lenses_beside(options.scene_file, lenses, behind_ports);
  if (const std::size_t distorted = count_distorted(scene))
    log_info("{}: {} of {} images keep their distorted lens",
             io::lenses_beside(options.scene_file).string(), distorted, scene.images.size());
  io::write_geo_offset_beside(options.scene_file, frame);
  if (!frame.is_world())
    log_info("{}: coordinates count from ({}, {}, {})",
             io::geo_offset_beside(options.scene_file).string(), frame.origin.x(), frame.origin.y(),
             frame.origin.z());
  io::write_mvs(options.scene_file, scene, folder);
  log_info("{}: {} images, {} points", options.scene_file.string(), scene.images.size(),
           scene.points.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("InterfaceCOLMAP", [&] { return run(argc, argv); });
}
