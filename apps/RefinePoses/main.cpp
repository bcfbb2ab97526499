// SPDX-License-Identifier: GPL-3.0-or-later
#include <spdlog/spdlog.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/colmap.h"
#include "io/housing.h"
#include "options.h"
#include "pose/colmap_bundle.h"
#include "report.h"
#include "scale_from.h"

namespace fs = std::filesystem;
using namespace axial;

namespace {

pose::ColmapBundle load(const Options& options, const io::ColmapModel& model,
                        const io::Housing& housing) {
  const auto lenses = io::read_colmap_cameras(options.lens);
  if (lenses.empty()) fail("{}: no camera", options.lens.string());
  try {
    return pose::to_bundle(model, lenses, housing);
  } catch (const Error& error) {
    fail("{}: {}", options.lens.string(), error.what());
  }
}

void write(const Options& options, const pose::ColmapBundle& refined, const io::ColmapModel& model,
           const io::Housing& measured, const std::string& report) {
  make_folder(options.output / "sparse");
  io::write_colmap_text(options.output / "sparse", to_model(refined, model));
  io::write_housing(options.output / "housing.json", to_housing(refined, measured));
  write_atomically(options.output / "report.json", report);
}

int run(int argc, char** argv) {
  Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const io::Housing housing = io::read_housing(options.housing);
  const fs::path folder = io::find_colmap_model(options.model);
  const io::ColmapModel model = io::read_colmap_model(folder);
  pose::ColmapBundle refined = load(options, model, housing);
  pose::AdjustOptions& adjust = options.refine.adjust;
  add_known(options.scale_from, options.scale_sigma, options.parsed.common.working_folder,
            refined.bundle, adjust);
  spdlog::info("{}: {} images, {} points, {} observations", folder.string(), model.images.size(),
               model.points.size(), refined.bundle.observations.size());
  if (refined.unseen > 0)
    spdlog::warn("{} observations lie where the lens in air images nothing", refined.unseen);

  pose::bring_to_metres(refined.bundle, adjust);
  spdlog::info("Begins with points {:.3g} m away, in the middle",
               pose::median_distance(refined.bundle));
  const pose::Bundle before = refined.bundle;
  const pose::RefineReport report = pose::refine(
      refined.bundle, options.refine, [](const std::string& line) { spdlog::info("{}", line); });
  const auto images = errors_by_image(before, refined.bundle);
  for (const std::string& line :
       report_lines(report, images, refined.bundle, refined.ports, adjust))
    spdlog::info("{}", line);
  write(options, refined, model, housing,
        report_json(report, images, refined.bundle, refined.ports, adjust));
  spdlog::info("Refined model in {}", options.output.string());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("RefinePoses", [&] { return run(argc, argv); });
}
