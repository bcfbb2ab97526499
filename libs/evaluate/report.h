// SPDX-License-Identifier: GPL-3.0-or-later
// Reports evaluations as text for people and as JSON for programs (fields: docs/evaluate.md).
// Lengths are metres in the JSON and millimetres in the text, except that a thickness is in pixels;
// angles are degrees. Each line of text ends with a line break.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluate/alignment.h"
#include "evaluate/cloud_evaluation.h"
#include "evaluate/depth_evaluation.h"
#include "evaluate/mesh_evaluation.h"
#include "evaluate/places.h"
#include "evaluate/point_uncertainty.h"
#include "evaluate/render_mesh.h"
#include "evaluate/strip.h"

namespace axial::evaluate {

// Return an object of statistics, without the values of single points and pixels.
nlohmann::ordered_json to_json(const CloudEvaluation& evaluation);
nlohmann::ordered_json to_json(const DepthEvaluation& evaluation);

// Returns the homogeneous 4 x 4 matrix as a list of four rows.
nlohmann::ordered_json to_json(const Similarity& similarity);

// Return the main statistics as lines of text.
std::string table(const CloudEvaluation& evaluation);
std::string table(const DepthEvaluation& evaluation);

// Returns an object with the fields "normals", "seen", "unseen" and "topology". The fields "seen"
// and "unseen" are absent if the evaluation has none, which means that there were no views. The
// median of normals without angles is null.
nlohmann::ordered_json to_json(const MeshEvaluation& evaluation);
std::string table(const MeshEvaluation& evaluation);

// The parts of an evaluation. Classes keep their order and become a list of objects. A Calibration
// and a Strip become an object. Null stands for:
// - "most" of a class without an upper limit, and "least" of the class that is not thin
// - the recall of a class without places
// - the mean, median, RMS and shares of a class without points, except that "share" (of all points)
//   and "within_1_2_3" are 0
// - "ratio" of a strip (`most` / `least`) if `least` is 0
nlohmann::ordered_json to_json(std::span<const RecallOfViews> classes);
nlohmann::ordered_json to_json(std::span<const RecallOfThickness> classes);
nlohmann::ordered_json to_json(std::span<const ErrorsOfViews> classes);
nlohmann::ordered_json to_json(const Calibration& calibration);
nlohmann::ordered_json to_json(const Strip& strip);

// `tolerances` [m]: the tolerances from which the classes were made, in the same order.
std::string table(std::span<const RecallOfViews> classes, std::span<const double> tolerances);
std::string table(std::span<const RecallOfThickness> classes, std::span<const double> tolerances);
std::string table(std::span<const ErrorsOfViews> classes, std::span<const double> tolerances);
std::string table(const Calibration& calibration);
std::string table(const Strip& strip);

// One view into which a mesh was rendered.
struct ViewReport {
  std::string view;                             // name of the image
  std::vector<std::string> pictures;            // files that were written
  std::string photograph;                       // file that was compared; empty: none
  double covered = 0;                           // share of the pixels that the mesh covers
  std::optional<double> truth_covered;          // share of the pixels that the truth covers
  double compared = 0;                          // share of the pixels that were compared
  std::optional<PictureDifference> difference;  // nothing without photograph
};

// Returns an object with the field "views", a list of one object for each view, and, if there are
// photographs, the fields "psnr" and "mean_difference" of the pixels of all views together. A PSNR
// that is infinite or not a number is null.
nlohmann::ordered_json to_json(std::span<const ViewReport> views);

// A row for each view. If several views have a photograph, the last row is of their pixels
// together.
std::string table(std::span<const ViewReport> views);

// The parts that the reports have in common. Returns an object. Its field "percentiles" is an
// object with the percentiles as keys: "50".
nlohmann::ordered_json to_json(const DistanceStatistics& statistics);

// Returns a list with one object for each score, in the order of `scores`.
nlohmann::ordered_json to_json(const std::vector<Score>& scores);

// statistics_header() returns a line with the names of the columns. The first name is `title`.
// statistics_row() returns a line with `name` and the numbers in these columns. Columns stay
// aligned if `title` and `name` have at most 22 characters.
std::string statistics_header(const char* title);
std::string statistics_row(const char* name, const DistanceStatistics& statistics);

// Returns a line with the names of the columns, and one line for each score, in the order of
// `scores`.
std::string score_rows(const std::vector<Score>& scores);

}  // namespace axial::evaluate
