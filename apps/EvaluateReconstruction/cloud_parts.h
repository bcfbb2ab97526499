// SPDX-License-Identifier: GPL-3.0-or-later
// Further parts of the evaluation of a cloud or mesh. A part is left out if the files do not
// contain the data that it needs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluate/cloud_evaluation.h"
#include "evaluate/point_uncertainty.h"
#include "options.h"
#include "scene/point_cloud.h"

namespace axial::apps {

// Returns the properties of the points of `cloud`: the numbers of views, and the vertex properties
// `error` and `confidence` of the file `path` from which the cloud was read. An array stays empty
// if the file has no such data.
evaluate::PointUncertainty read_uncertainty(const std::filesystem::path& path,
                                            const PointCloud& cloud);

struct Evaluated {
  std::span<const Eigen::Vector3f> points;
  const evaluate::PointUncertainty& uncertainty;  // of `points`
  const Mesh& truth;
  const geometry::Surface& surface;  // made from `truth`
  std::span<const evaluate::View> views;
  const evaluate::CloudEvaluation& whole;  // the evaluation of all points
};

// Prints up to four tables, and returns their numbers for the JSON file: recall by the vertex
// property `thickness` of the truth, errors by the points' numbers of views, the comparison of
// expected with true errors, and the density along the strip of cameras.
nlohmann::ordered_json report_parts(const Options& options, const Evaluated& evaluated);

}  // namespace axial::apps
