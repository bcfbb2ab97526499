// SPDX-License-Identifier: GPL-3.0-or-later
// Reports comparisons of rendered meshes with photographs, as text for people and as JSON for
// programs (fields: docs/evaluate.md).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluate/render_mesh.h"

namespace axial::evaluate {

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

}  // namespace axial::evaluate
