// SPDX-License-Identifier: GPL-3.0-or-later
// What the computation and the documents of the experiment `reconstruction` have in common.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/chained.h"

namespace axial::experiments {

// A way from photographs to a dense cloud.
struct Method {
  const char* name;   // field of the results
  const char* title;  // in tables and figures
  bool in_water;      // photographs through the port; else in air
  Words options;      // of DensifyPointCloud
  // Also evaluates depth maps on true poses, and completeness by the number of cameras.
  bool judged_closely;
};
// In the order of the tables.
const std::array<Method, 5>& reconstruction_methods();

// Completeness is also measured for places that at least so many cameras see.
inline constexpr std::array<std::size_t, 4> kCompletenessViews{2, 3, 4, 5};

// Names of the parts of a seed: clouds on COLMAP's poses, and depth maps on true poses.
std::string colmap_part(int seed);
std::string true_part(int seed);

// All tables and figures. `results`: of the whole experiment (experiment.h), with these seeds.
std::vector<Document> reconstruction_documents(const Json& results, const std::vector<int>& seeds);

}  // namespace axial::experiments
