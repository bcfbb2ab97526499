// SPDX-License-Identifier: GPL-3.0-or-later
// What is told of a cloud or mesh beside its evaluation as a whole, where the files know enough.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "evaluate/cloud_evaluation.h"
#include "evaluate/point_worth.h"
#include "options.h"
#include "scene/point_cloud.h"

// Of the cloud in `path`: numbers of views from its view lists, and the vertex properties `error`
// and `confidence`.
axial::evaluate::PointWorth read_worth(const std::filesystem::path& path,
                                       const axial::PointCloud& cloud);

struct Evaluated {
  std::span<const Eigen::Vector3f> points;
  const axial::evaluate::PointWorth& worth;  // of these points
  const axial::Mesh& truth;
  const axial::evaluate::Surface& surface;
  std::span<const axial::evaluate::View> views;
  const axial::evaluate::CloudEvaluation& whole;
};

// Prints the tables and returns them for the JSON file: recall by the truth's vertex property
// `thickness`, errors by the points' numbers of views, whether expected errors are right, density
// along the strip.
nlohmann::ordered_json report_parts(const Options& options, const Evaluated& evaluated);
