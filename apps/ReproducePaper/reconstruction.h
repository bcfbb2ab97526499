// SPDX-License-Identifier: GPL-3.0-or-later
// Declarations for both the computation and the documents of the experiment `reconstruction`.
#pragma once

#include <array>
#include <vector>

#include "chained.h"

namespace axial {

struct Method {
  const char* name;
  const char* title;
  bool in_water;
  Words options;  // of DensifyPointCloud
  // Also evaluates depth maps on true poses, and completeness by the number of cameras.
  bool judged_closely;
};
const std::array<Method, 5>& reconstruction_methods();

// Completeness is also measured for places that at least so many cameras see.
inline constexpr std::array<std::size_t, 4> kCompletenessViews{2, 3, 4, 5};

// Names of parts.
std::string colmap_part(int seed);
std::string true_part(int seed);

std::vector<experiments::Document> reconstruction_documents(const Json& results,
                                                            const std::vector<int>& seeds);

}  // namespace axial
