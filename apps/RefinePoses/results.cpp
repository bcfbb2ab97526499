// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "base/program/out_of_memory.h"
#include "control/target_places.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/colmap_frame.h"
#include "pose/adjust/depth_sigma.h"
#include "pose/adjust/uncertainty.h"
#include "stages.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

void write_model(const Options& options, const fs::path& folder, const io::ColmapModel& model,
                 const io::Housing& housing) {
  io::write_housing(folder / "housing.json", housing);
  if (options.underwater) {
    make_folder(folder / "colmap-underwater");
    io::write_underwater_text(folder / "colmap-underwater", model);
    io::write_underwater_binary(folder / "colmap-underwater", model);
  }
  make_folder(folder / "sparse");
  io::write_colmap_text(folder / "sparse", model);
}

// Writes the lens and the housing again, with the standard deviations of the results.
void write_sigmas(const Options& options, const Input& input, const pose::ColmapBundle& refined,
                  const pose::Uncertainty& known) {
  const auto sigmas = pose::present_sigmas(refined.bundle, options.refine.adjust, &known);
  io::write_housing(options.output / "housing.json", to_housing(refined, input.housing, sigmas));
  io::write_colmap_cameras(options.output / "sparse" / "cameras.txt",
                           refined_cameras(refined, sigmas));
}

// Sets Results::control and writes the places of the targets.
void write_control(const Options& options, const Input& input, const Refined& refined,
                   Results& results) {
  const pose::Bundle& bundle = refined.after.bundle;
  std::vector<std::string> left_out = refined.control.unused;
  left_out.insert(left_out.end(), refined.report.wrong_control.begin(),
                  refined.report.wrong_control.end());
  results.control = control_results(bundle, results.options, refined.frame, refined.control.checks,
                                    std::move(left_out));
  results.control->crs = input.control.crs;
  results.control->map_scale = refined.control.map_scale;
  control::TargetPlaces places =
      target_places(bundle, results.options, options.refine.targets, refined.frame);
  places.crs = input.control.crs;
  control::write_target_places(options.output / control::kTargetPlaces, places);
}

}  // namespace

pose::Uncertainty write_results(const fs::path& folder,
                                const std::function<void(const fs::path& staging)>& write_model,
                                const Results& results,
                                const std::function<pose::Uncertainty()>& compute) {
  constexpr const char* kReport = "report.json";
  // The places of targets of an earlier run do not belong to this model.
  fs::remove(folder / control::kTargetPlaces);
  write_folder(folder, [&](const fs::path& staging) {
    write_model(staging);
    write_atomically(staging / kReport, report_json(results, nullptr));
  });
  try {
    pose::Uncertainty known = compute();
    write_atomically(folder / kReport, report_json(results, &known));
    return known;
  } catch (const std::exception& error) {
    fail("{}: contains the refined model, only its standard deviations are missing: {}",
         folder.string(), is_out_of_memory(error) ? "memory ran out" : marked_text(error));
  }
}

pose::Uncertainty write(const Options& options, const Input& input, const Refined& refined,
                        Results& results, const Context& context) {
  const pose::ColmapBundle& after = refined.after;
  const auto sigmas = pose::present_sigmas(after.bundle, results.options, nullptr);
  const io::Housing housing = to_housing(after, input.housing, sigmas);
  for (const auto& [name, port] : housing.ports) io::check_port(port, "The refined port " + name);
  pose::ColmapBundle without_targets = after;
  drop_targets(without_targets.bundle);
  io::ColmapModel model = to_model(without_targets, input.model, sigmas);
  io::leave(refined.frame, model);
  return write_results(
      options.output, [&](const fs::path& folder) { write_model(options, folder, model, housing); },
      results,
      [&] {
        log_info("Refined model in {}", options.output.string());
        model = {};
        pose::Uncertainty known = pose::uncertainty(after.bundle, results.options, context);
        write_sigmas(options, input, after, known);
        if (!results.options.poses_known)
          known.depth_sigma = pose::depth_sigma(after.bundle, results.options, context);
        if (options.control.any()) write_control(options, input, refined, results);
        return known;
      });
}

}  // namespace axial::apps
