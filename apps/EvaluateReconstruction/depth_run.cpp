// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "evaluate/depth_evaluation.h"
#include "evaluate/pictures.h"
#include "evaluate/report.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "runs.h"

namespace axial::apps {
namespace {

void check_depth_run(const Options& options) {
  if (options.align != "none")
    fail("--align {}: a depth map has the coordinates of its own camera and cannot be aligned",
         options.align);
  const std::pair<const char*, bool> meaningless[] = {
      {"--render", !options.rendered_views.empty()},
      {"--framed-only", options.framed_only},
      {"--strip", options.strip},
      {"--cameras", !options.cameras.empty()},
      {"--estimated", !options.estimated.empty()},
      {"--error-cloud", !options.error_cloud.empty()},
      {"--error-mesh", !options.error_mesh.empty()},
      {"--aligned", !options.aligned.empty()},
      {"--transform-out", !options.transform.empty()}};
  for (const auto& [name, given] : meaningless)
    if (given) fail("{} is for clouds and meshes, not for a depth map", name);
}

}  // namespace

nlohmann::ordered_json run_depth_map(const Options& options, const Context& context) {
  check_depth_run(options);
  const DepthMap map = io::read_dmap(options.input, io::DmapSide::used, context).map;
  const cv::Mat1f truth = io::read_float_tiff(options.truth);
  if (truth.size() != map.depth.size())
    log_info("The truth is {} x {} and is sampled at the map's {} x {} pixel centres", truth.cols,
             truth.rows, map.width(), map.height());
  evaluate::DepthOptions settings;
  settings.tolerances = options.tolerances;
  const evaluate::DepthEvaluation result =
      naming(options.input, [&] { return evaluate::evaluate_depth(map.depth, truth, settings); });
  fmt::print("{}", evaluate::table(result));
  if (!options.picture.empty())
    io::write_png(options.picture,
                  evaluate::draw_depth_comparison(map.depth, result, options.color_max));
  nlohmann::ordered_json report{{"kind", "depth_map"}};
  report.update(evaluate::to_json(result));
  return report;
}

}  // namespace axial::apps
