// SPDX-License-Identifier: GPL-3.0-or-later
// Further parts of the evaluation of a cloud or mesh, where the files have the necessary data.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluate/cloud_evaluation.h"
#include "evaluate/point_uncertainty.h"
#include "options.h"
#include "scene/point_cloud.h"

namespace axial::apps {

// The properties of the points of the cloud in `path`: numbers of views from its view lists, and
// the vertex properties `error` and `confidence`.
evaluate::PointUncertainty read_uncertainty(const std::filesystem::path& path,
                                            const PointCloud& cloud);

struct Evaluated {
  std::span<const Eigen::Vector3f> points;
  const evaluate::PointUncertainty& uncertainty;  // of these points
  const Mesh& truth;
  const evaluate::Surface& surface;
  std::span<const evaluate::View> views;
  const evaluate::CloudEvaluation& whole;
};

// Prints the tables and returns them for the JSON file: recall by the truth's vertex property
// `thickness`, errors by the points' numbers of views, a comparison of expected and actual errors,
// density along the strip of cameras.
nlohmann::ordered_json report_parts(const Options& options, const Evaluated& evaluated);

}  // namespace axial::apps
