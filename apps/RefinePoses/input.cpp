// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/files_in.h"
#include "base/log.h"
#include "base/naming.h"
#include "base/same_file.h"
#include "control/target_places.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/colmap_frame.h"
#include "io/colmap/colmap_scene.h"
#include "io/colmap/other_ports.h"
#include "stages.h"
#include "usual_housing.h"

namespace axial::apps {

using LensesInAir = std::vector<io::ColmapCamera>;

namespace {

namespace fs = std::filesystem;

// The ports of the lenses' file, and of the model's cameras where the lenses have none.
io::Housing carried_housing(const io::ColmapModel& model, const LensesInAir& lenses) {
  // A single lens applies to all cameras, whatever its id.
  if (lenses.size() == 1 && lenses.front().port)
    return io::housing_with(io::to_housing_port(*lenses.front().port));
  io::Housing carried = io::housing_of(lenses);
  io::Housing of_model = io::housing_of(model.cameras);
  carried.ports.merge(of_model.ports);
  carried.cameras.merge(of_model.cameras);
  return carried;
}

// The input files: an output must not replace one.
std::vector<fs::path> inputs_of(const Options& options, const fs::path& model) {
  std::vector<fs::path> inputs{options.housing, options.database, options.control.targets,
                               options.control.bars, options.control.control};
  constexpr std::string_view kPositions = "positions:";
  if (options.scale_from.starts_with(kPositions))
    inputs.push_back(options.parsed.common.working_folder /
                     options.scale_from.substr(kPositions.size()));
  for (fs::path& file : files_of(options.rigs)) inputs.push_back(std::move(file));
  for (const fs::path& folder : {model, options.lens})
    for (const fs::path& file : files_in(folder)) inputs.push_back(file);
  return inputs;
}

std::vector<fs::path> outputs_of(const Options& options) {
  std::vector<fs::path> outputs{options.output / "housing.json", options.output / "report.json",
                                options.output / control::kTargetPlaces};
  if (options.control.find) outputs.push_back(options.output / kFoundTargets);
  for (const char* name : {"cameras", "images", "points3D"}) {
    const fs::path sparse = options.output / "sparse", other = options.output / "colmap-underwater";
    outputs.push_back(sparse / name += ".txt");
    for (const char* extension : {".txt", ".bin"})
      if (options.underwater) outputs.push_back(other / name += extension);
  }
  return outputs;
}

bool same_lens(const io::ColmapCamera& a, const io::ColmapCamera& b) {
  return a.model == b.model && std::ranges::equal(a.params, b.params, [](double x, double y) {
           return std::abs(x - y) <= 1e-9 * std::max(1.0, std::abs(x));
         });
}

// A model's camera with a port has its lens in air, too. Warns if that lens is not used and
// differs.
void warn_of_other_lenses(const Options& options, const io::ColmapModel& model,
                          const LensesInAir& lenses) {
  for (const io::ColmapCamera& camera : model.cameras) {
    const auto lens = std::ranges::find_if(lenses, [&](const io::ColmapCamera& candidate) {
      return lenses.size() == 1 || candidate.id == camera.id;
    });
    if (!camera.port || lens == lenses.end() || same_lens(*lens, camera)) continue;
    return log_warning(
        "The lenses of {} are used; the lenses of {} differ and are ignored, first for camera {}",
        options.lens.string(), options.model.string(), camera.id);
  }
}

}  // namespace

LensesInAir load_lenses(const Options& options, const io::ColmapModel& model,
                        const Context& context) {
  if (options.lens.empty() && io::housing_of(model.cameras).ports.empty())
    fail("--lens is missing: the lens calibrated in air");
  LensesInAir lenses =
      options.lens.empty() ? model.cameras : io::read_colmap_cameras(options.lens, context);
  if (lenses.empty()) fail("{}: no camera", options.lens.string());
  return lenses;
}

io::Housing load_housing(const Options& options, const io::ColmapModel& model,
                         const LensesInAir& lenses, const Context& context) {
  if (!options.usual_housing.empty())
    return usual_housing(kind_named(options.usual_housing).value_or(pose::PortKind::flat));
  io::Housing carried = carried_housing(model, lenses);
  const std::string of_model = "the model in " + options.model.string();
  const std::string of_lens = options.lens.empty() ? of_model : options.lens.string();
  if (!options.housing.empty()) {
    io::Housing housing = io::read_housing(options.housing, model, context);
    io::refuse_water_surfaces(housing, options.housing);
    io::warn_of_other_ports(housing, options.housing.string(), carried, of_lens, model, context);
    return housing;
  }
  if (carried.ports.empty()) fail("--housing is missing: the port of the camera");
  io::warn_of_other_ports(carried, of_lens, io::housing_of(model.cameras), of_model, model,
                          context);
  return carried;
}

Input read_input(const Options& options, const Context& context) {
  Input input;
  input.folder = io::find_colmap_model(options.model, context);
  input.model = io::read_colmap_model(input.folder, context);
  // In world coordinates of millions of metres the solver would stop too early, because its steps
  // are small relative to the coordinates.
  input.frame = io::enter_local_frame(input.model);
  input.lenses = load_lenses(options, input.model, context);
  warn_of_other_lenses(options, input.model, input.lenses);
  if (options.poses == "known" && !options.database.empty())
    log_info("{} is not read, because the poses are known", options.database.string());
  else if (!options.database.empty())
    input.left_out = add_left_out(options.database, input.lenses, input.model);
  input.housing = load_housing(options, input.model, input.lenses, context);
  if (options.control.any() && !options.control.find) input.control = read_control(options.control);
  return input;
}

void check_output(const Options& options, const Input& input) {
  const fs::path& model = input.folder;
  std::error_code error;
  if (fs::equivalent(options.output / "sparse", model, error) ||
      fs::equivalent(options.output / "sparse", model.parent_path(), error))
    fail("--output-folder {}: its folder sparse/ is the model that is read",
         options.output.string());
  require_no_inputs(outputs_of(options), inputs_of(options, model), "--output-folder");
  io::require_no_binary_model(options.output / "sparse");
  require_writable_folder(options.output);
}

pose::ColmapBundle bundle_of(const Options& options, const Input& input,
                             const io::Housing& housing) {
  const fs::path& file = options.lens.empty() ? options.model : options.lens;
  return naming(file, [&] { return pose::to_bundle(input.model, input.lenses, housing); });
}

void check_ports(const Options& options, const Input& input, const pose::Bundle& bundle) {
  const fs::path& ports_from = !options.housing.empty() ? options.housing
                               : options.lens.empty()   ? options.model
                                                        : options.lens;
  for (const std::string& entry : io::unused_entries(input.housing, input.model))
    log_warning("{}: no image matches {}", ports_from.string(), entry);
  if (std::ranges::none_of(bundle.cameras, [](const pose::BundleCamera& camera) {
        return camera.measured.port.has_value();
      }))
    fail("no image is behind a port: there is nothing to refine");
}

}  // namespace axial::apps
