// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/densify_options.h"

#include <numbers>

#include "src/survey_call.h"

namespace axial::python {
namespace {

constexpr double kHalfTurn = std::numbers::pi, kMany = 1e9;

void add_views(Keywords& keywords, densify::ViewOptions& options) {
  ViewSelectionOptions& selection = options.selection;
  keywords.add("point_cloud", options.point_cloud)
      .add("neighbour_lists", options.neighbour_lists)
      .add("number_views", options.number_views, 0, 32)
      .add("region", options.region,
           {{"off", RegionMode::off}, {"on", RegionMode::on}, {"adaptive", RegionMode::adaptive}})
      .add("roi_border", options.roi_border, -1e6, 1e6)
      .add("selection_optimal_angle", selection.optimal_angle, kHalfTurn / 1800, kHalfTurn)
      .add("selection_min_views", selection.min_views, 1, 1000)
      .add("selection_max_views", selection.max_views, 1, 1000)
      .add("selection_min_trusted_views", selection.min_trusted_views, 1, 1000)
      .add("selection_weight_outside_region", selection.weight_outside_region, 0, 1)
      .add("selection_min_score", selection.min_score, 0, kMany)
      .add("selection_min_score_ratio", selection.min_score_ratio, 0, 1)
      .add("selection_min_area", selection.min_area, 0, 1)
      .add("selection_min_angle", selection.min_angle, 0, kHalfTurn)
      .add("selection_max_angle", selection.max_angle, 0, kHalfTurn);
}

void add_matching(Keywords& keywords, densify::MatchOptions& options) {
  keywords.add("make_maps", options.make_maps)
      .add("projection", options.projection,
           {{"exact", ProjectionMethod::exact}, {"line_search", ProjectionMethod::line_search}})
      .add("warp", options.warp,
           {{"affine", depth::Warp::affine}, {"homography", depth::Warp::homography}})
      .add("sub_resolution_levels", options.sub_resolution_levels, 0, 8)
      .add("iterations", options.iterations, 1, 60)
      .add("geometric_iterations", options.geometric_iterations, 0, 20)
      .add("postprocess", options.postprocess, 0, 7)
      .add("overwrite_dmaps", options.overwrite_dmaps)
      .add("min_texture", options.min_texture, 0, 1)
      .add("keep_cost", options.keep_cost, 0, 2)
      .add("geometric_weight", options.geometric_weight, 0, 100)
      .add("speckles_min_pixels", options.speckles.min_pixels, 0, kMany)
      .add("speckles_max_difference", options.speckles.max_difference, 0, 1)
      .add("gaps_max_gap", options.gaps.max_gap, 0, 1e6)
      .add("gaps_max_difference", options.gaps.max_difference, 0, 1);
}

void add_fusion(Keywords& keywords, densify::FusionOptions& options) {
  keywords.add("fuse", options.fuse)
      .add("min_views", options.min_views, 0, 255)
      .add("two_if_undisputed", options.two_if_undisputed)
      .add("depth_threshold", options.depth_threshold, 1e-6, 1)
      .add("normal_threshold", options.normal_threshold, 0, kHalfTurn)
      .add("errors", options.errors)
      .add("tiles", options.tiles, 1, 1000)
      .add("estimate_colors", options.estimate_colors, 0, 2)
      .add("estimate_normals", options.estimate_normals, 0, 2)
      .add("crop_to_roi", options.crop_to_roi)
      .add("remove_dmaps", options.remove_dmaps);
}

}  // namespace

void add_keywords(Keywords& keywords, densify::Options& options) {
  add_survey_keywords(keywords, options.survey);
  add_views(keywords, options.views);
  add_matching(keywords, options.matching);
  add_fusion(keywords, options.fusion);
  keywords.add("double_precision", options.output.double_precision)
      .add("report", options.output.report)
      .add("pinhole_export", options.output.pinhole_export);
}

}  // namespace axial::python
