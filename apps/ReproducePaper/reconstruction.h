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
  Words options;     // of DensifyPointCloud
  bool maps_judged;  // its depth maps, on true poses
};
const std::array<Method, 5>& reconstruction_methods();

// Names of parts.
std::string colmap_part(int seed);
std::string true_part(int seed);

std::vector<experiments::Document> reconstruction_documents(const Json& results,
                                                            const std::vector<int>& seeds);

}  // namespace axial
