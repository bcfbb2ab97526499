// SPDX-License-Identifier: GPL-3.0-or-later
// What the experiment `reconstruction` computes and what it shows have in common.
#pragma once

#include <array>
#include <vector>

#include "chained.h"

namespace axial {

struct Method {
  const char* name;
  const char* title;
  bool in_water;
  Words options;        // of DensifyPointCloud
  bool judged_closely;  // its depth maps, on true poses, and its completeness by numbers of cameras
};
const std::array<Method, 5>& reconstruction_methods();

// Completeness is also asked of what at least so many cameras see.
inline constexpr std::array<std::size_t, 4> kCompletenessViews{2, 3, 4, 5};

// Names of parts.
std::string colmap_part(int seed);
std::string true_part(int seed);

std::vector<experiments::Document> reconstruction_documents(const Json& results,
                                                            const std::vector<int>& seeds);

}  // namespace axial
