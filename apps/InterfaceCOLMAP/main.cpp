// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/output_lock.h"
#include "base/program/unused_input.h"
#include "base/progress.h"
#include "base/same_file.h"
#include "diagnosis/import_check.h"
#include "io/bytes/json.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_export.h"
#include "io/colmap/colmap_frame.h"
#include "io/colmap/colmap_scene.h"
#include "io/colmap/other_ports.h"
#include "io/openmvs/mvs.h"
#include "io/openmvs/point_source.h"
#include "options.h"
#include "pose/colmap_bundle.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

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

// The housing file, or the ports that the model's cameras carry. COLMAP-Underwater also writes
// ports into models whose poses it computed without refraction. The files do not tell this, but the
// tracks do; then this function warns and sets `warned`.
io::Housing load_housing(const Options& options, const io::ColmapModel& model, bool& warned,
                         const Context& context) {
  io::Housing carried = io::housing_of(model.cameras);
  if (!options.housing_file.empty()) {
    io::Housing housing = io::read_housing(options.housing_file, model, context);
    io::warn_of_other_ports(housing, options.housing_file.string(), carried,
                            "the model in " + options.colmap_folder.string(), model, context);
    if (io::gives_no_image_a_port(housing, model))
      UnusedInput(options.allow_missing)
          .report(fmt::format("--housing {}: gives no image a port", options.housing_file.string()),
                  context);
    return housing;
  }
  if (carried.ports.empty()) return carried;
  const pose::PortFit fit = pose::port_fit(model);
  log_info(
      "The model's cameras have ports: its points have an error of {:.3f} px behind these ports",
      fit.behind_ports);
  warned = fit.behind_ports > fit.in_air;
  if (warned)
    log_warning(
        "The points have an error of {:.3f} px in air: the poses were computed without refraction. "
        "RefinePoses computes refractive poses from them",
        fit.in_air);
  return carried;
}

// All files that a COLMAP model may have in its folder.
std::vector<fs::path> model_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* part : {"cameras", "images", "points3D", "rigs", "frames"})
    for (const char* extension : {".txt", ".bin"})
      files.push_back(folder / (std::string(part) + extension));
  return files;
}

// Error if the output would replace the model, a photograph or the housing file.
void check_outputs(const Options& options, const fs::path& model_folder,
                   const io::ColmapModel& model) {
  std::vector<fs::path> inputs = model_files(model_folder);
  inputs.push_back(options.housing_file);
  for (const io::ColmapImage& image : model.images)
    inputs.push_back(options.image_folder / image.name);
  const std::vector<fs::path> outputs{
      options.named_output, options.scene_file, io::housing_beside(options.scene_file),
      io::lenses_beside(options.scene_file), io::geo_offset_beside(options.scene_file)};
  require_no_inputs(outputs, inputs, "--output-file");
}

// Logs the image folder, and another folder that also has images of these names.
void say_image_folder(const Options& options, const io::ColmapModel& model) {
  std::error_code error;
  const fs::path& other = options.other_image_folder;
  const bool other_has_images = !other.empty() && !model.images.empty() &&
                                fs::exists(other / model.images.front().name, error) &&
                                !fs::equivalent(other, options.image_folder, error);
  log_info("Images in {}{}", options.image_folder.string(),
           other_has_images
               ? ", not in " + other.string() + ", which also contains images with these names"
               : "");
}

// Few cameras take no time: shows no progress for them.
ProgressSink progress_of_many(const std::string& title) {
  constexpr std::size_t kMany = 100;
  return [show = console_progress(title)](std::size_t done, std::size_t total) {
    if (total >= kMany) show(done, total);
  };
}

// Marks a model as exported: the next export may replace it.
constexpr const char* kExportMarker = "export.json";

// If an export was stopped while it replaced files, the marker may be left in its staging folder.
bool is_export(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / kExportMarker, error)) return true;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with("staging.") &&
        fs::exists(entry.path() / kExportMarker, error))
      return true;
  return false;
}

// Exports often go where the model lies that the scene was made from: that model is not
// overwritten. An export has no binary files, and COLMAP would read them instead of the export.
void check_export_folder(const fs::path& folder) {
  std::error_code error;
  const bool exported = is_export(folder);
  for (const fs::path& file : model_files(folder))
    if (fs::exists(file, error) && !(exported && file.extension() == ".txt"))
      fail_in(file,
              "belongs to a model that is not an export, and is not overwritten: give another "
              "folder with --output-file");
}

// The part of the log line about images that do not exist. A scene's paths count from the working
// folder, which may differ from the folder that they were written for.
std::string say_missing(const Scene& scene, const Options& options) {
  std::error_code error;
  const auto missing = std::ranges::count_if(scene.images, [&](const SceneImage& image) {
    return image.calibrated && !fs::exists(image.path, error);
  });
  if (missing == 0) return "";
  return fmt::format(
      " ({} of them do not exist: a scene's paths are relative to the working folder, {}, which -w "
      "sets)",
      missing, fs::weakly_canonical(options.parsed.common.working_folder, error).string());
}

// The scene with its lenses and ports, and its points or the cloud that replaces them. `frame`: the
// scene's frame.
Scene read_scene(const Options& options, LocalFrame& frame, const Context& context) {
  Scene scene = io::read_mvs(options.scene_file, options.parsed.common.working_folder, context);
  frame = io::enter_local_frame(scene, options.scene_file, context);
  io::attach_lenses_beside(scene, options.scene_file, context);
  const fs::path housing_file = io::housing_beside(options.scene_file);
  std::error_code error;
  if (fs::exists(housing_file, error)) {
    const io::Housing housing = io::read_housing(housing_file, io::PortValues::checked, context);
    io::attach_ports(scene, io::in_frame(frame, housing), housing_file.string(), context);
  }
  if (!options.point_cloud.empty()) io::use_point_cloud(scene, frame, options.point_cloud, context);
  return scene;
}

// The longest end of `path` that is a file below `folder`; empty if there is none.
fs::path end_below(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  for (auto begin = path.begin(); begin != path.end(); ++begin) {
    fs::path end;
    for (auto part = begin; part != path.end(); ++part) end /= *part;
    if (end.is_relative() && fs::is_regular_file(folder / end, error)) return end;
  }
  return {};
}

// Takes the images from the folder of --image-folder if it has all of them: a scene often names
// another place where they were before. Returns the folder below which the images are.
fs::path find_images(const Options& options, Scene& scene) {
  const fs::path& folder = options.image_folder;
  if (folder.empty()) return io::common_image_folder(scene);
  std::vector<std::string> paths;
  for (const SceneImage& image : scene.images) {
    const fs::path stored(image.path), end = stored.lexically_relative(folder);
    const bool is_below = !end.empty() && *end.begin() != "..";
    const fs::path found = is_below ? end : end_below(stored, folder);
    if (image.calibrated && found.empty()) {
      const fs::path common = io::common_image_folder(scene);
      log_warning("--image-folder {}: has no file for {}: the images' names count from {}",
                  folder.string(), image.path, common.string());
      return common;
    }
    paths.push_back(found.empty() ? image.path : (folder / found).string());
  }
  for (std::size_t i = 0; i < paths.size(); ++i) scene.images[i].path = paths[i];
  return folder;
}

// A model with ports is written for COLMAP-Underwater, whose files can hold ports.
void write_export(const Options& options, const fs::path& folder, const io::ColmapModel& model,
                  bool behind_ports) {
  write_folder(folder, [&](const fs::path& staging) {
    (behind_ports ? io::write_underwater_text : io::write_colmap_text)(staging, model);
    io::write_json(staging / kExportMarker,
                   {{"version", 1}, {"scene", options.scene_file.string()}});
  });
}

int export_scene(const Options& options, const Context& context) {
  LocalFrame frame;
  Scene scene = read_scene(options, frame, context);
  const fs::path images = find_images(options, scene);
  io::ColmapModel model = io::export_colmap_model(scene, images);
  io::leave(frame, model);
  const fs::path folder = options.export_folder / "sparse";
  const OutputLock lock = lock_output(folder);
  check_export_folder(folder);
  const std::size_t behind_ports = count_behind_ports(scene);
  if (behind_ports > 0)
    log_warning(
        "{} of {} images are behind ports, which are written in the format of COLMAP-Underwater: "
        "COLMAP itself cannot read them",
        behind_ports, scene.images.size());
  write_export(options, folder, model, behind_ports > 0);
  const std::string missing = say_missing(scene, options);
  const std::string line = fmt::format("{}: {} images below {}{}, {} cameras, {} points",
                                       folder.string(), model.images.size(), images.string(),
                                       missing, model.cameras.size(), model.points.size());
  if (missing.empty())
    log_info("{}", line);
  else
    log_warning("{}", line);
  return 0;
}

// A model and its ports.
struct Input {
  fs::path folder;  // of the model
  io::ColmapModel model;
  LocalFrame frame;  // of the model
  io::Housing housing;
  bool warned = false;  // of poses that were computed without refraction
};

// Reports the images that are missing. If missing images are allowed, removes them from the model.
void leave_out_missing(const Options& options, io::ColmapModel& model, const Context& context) {
  const std::size_t all = model.images.size();
  const auto missing = io::remove_missing_images(model, options.image_folder);
  if (missing.empty()) return;
  const std::string others =
      missing.size() > 1 ? fmt::format(", and {} more are missing, of {}", missing.size() - 1, all)
                         : "";
  UnusedInput(options.allow_missing)
      .report(fmt::format("{}: image not found{}", missing.front().string(), others), context);
}

Input read_input(const Options& options, const Context& context) {
  Input input;
  input.folder = io::find_colmap_model(options.colmap_folder, context);
  input.model = io::read_colmap_model(input.folder, context);
  const io::ColmapModel& model = input.model;
  log_info("{}: {} images, {} cameras, {} points", input.folder.string(), model.images.size(),
           model.cameras.size(), model.points.size());
  leave_out_missing(options, input.model, context);
  input.frame = io::enter_local_frame(input.model);
  input.housing = load_housing(options, model, input.warned, context);
  say_image_folder(options, model);
  check_outputs(options, input.folder, model);
  return input;
}

// Attaches the ports to the scene, and writes the housing file beside it. If neither --housing nor
// the model gives ports, a housing file that is there already is kept.
void write_ports(const Options& options, const Input& input, const io::ColmapImport& import,
                 Scene& scene, const Context& context) {
  const fs::path housing_file = io::housing_beside(options.scene_file);
  std::error_code ignored;
  if (options.housing_file.empty() && input.housing.ports.empty()) {
    if (fs::exists(housing_file, ignored))
      log_warning("{}: is kept unchanged and belongs to this scene", housing_file.string());
    return;
  }
  const io::Housing by_image = io::housing_by_image(input.housing, input.model, scene, import);
  for (const std::string& entry : io::unused_entries(input.housing, input.model))
    log_warning("{}: no image matches {}", options.housing_file.string(), entry);
  io::warn_of_housing_beside(
      scene, options.scene_file, by_image,
      options.housing_file.empty() ? options.colmap_folder : options.housing_file, context);
  // Messages about ports that the model carries name the housing file that is written here.
  const fs::path& ports_from = options.housing_file.empty() ? housing_file : options.housing_file;
  io::attach_ports(scene, io::in_frame(input.frame, by_image), ports_from.string(), context);
  io::write_housing(housing_file, by_image);
  log_info("{}: {} of {} images behind a port", housing_file.string(), count_behind_ports(scene),
           scene.images.size());
}

void write_lenses(const Options& options, const io::SceneLenses& lenses, const Scene& scene,
                  bool behind_ports) {
  io::write_lenses_beside(options.scene_file, lenses, behind_ports);
  if (const std::size_t distorted = count_distorted(scene))
    log_info("{}: {} of {} images keep their distorted lens",
             io::lenses_beside(options.scene_file).string(), distorted, scene.images.size());
}

void write_frame(const Options& options, const LocalFrame& frame, const Context& context) {
  io::write_geo_offset_beside(options.scene_file, frame, context);
  if (!frame.is_world())
    log_info("{}: coordinates are relative to ({}, {}, {})",
             io::geo_offset_beside(options.scene_file).string(), frame.origin.x(), frame.origin.y(),
             frame.origin.z());
}

void warn_of_misfit(const Options& options, const Input& input, const Context& context) {
  const io::Housing ports = io::in_frame(input.frame, input.housing);
  if (const auto line =
          diagnosis::import_warning(input.model, ports, options.image_folder, context))
    log_warning("{}", *line);
}

int import_model(const Options& options, const Context& context) {
  const Input input = read_input(options, context);
  const fs::path folder = options.scene_file.parent_path();
  const OutputLock lock = lock_output(options.scene_file);
  make_folder(folder);  // tells why it cannot be made
  std::error_code ignored;
  const bool behind_ports =
      !input.housing.ports.empty() || fs::exists(io::housing_beside(options.scene_file), ignored);
  const bool undistort = options.undistort.value_or(!behind_ports);
  const io::ColmapImport import{input.folder, options.image_folder, folder / "undistorted",
                                undistort};
  Scene scene = io::import_colmap_scene(input.model, import, console_progress("Undistorted images"),
                                        progress_of_many("Prepared cameras"),
                                        progress_of_many("Checked images"), context);
  const io::SceneLenses lenses = io::lenses_of(scene, options.scene_file);
  // The housing is written first: a scene without its housing would be read as dry.
  write_ports(options, input, import, scene, context);
  write_lenses(options, lenses, scene, behind_ports);
  write_frame(options, input.frame, context);
  io::write_mvs(options.scene_file, scene, folder,
                options.normalize ? io::MvsIntrinsics::normalised : io::MvsIntrinsics::pixels);
  log_info("{}: {} images, {} points", options.scene_file.string(), scene.images.size(),
           scene.points.size());
  // The ports of an existing housing file beside the scene are not known here.
  const bool ports_unknown = input.housing.ports.empty() && behind_ports;
  if (!input.warned && !ports_unknown) warn_of_misfit(options, input, context);
  return 0;
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  if (!options.masks.masks.empty()) {
    const OutputLock lock = lock_output(options.masks.output);
    io::write_colmap_masks(options.masks, console_progress("Wrote masks"), context);
    return 0;
  }
  return options.export_folder.empty() ? import_model(options, context)
                                       : export_scene(options, context);
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("InterfaceCOLMAP", [&] { return axial::apps::run(argc, argv); });
}
