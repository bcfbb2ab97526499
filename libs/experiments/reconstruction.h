// SPDX-License-Identifier: GPL-3.0-or-later
// Declarations that the computation and the documents of the experiment `reconstruction` share.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/chained.h"

namespace axial::experiments {

// A way from photographs to a dense cloud.
struct Method {
  const char* name;   // name of the method's field in the results
  const char* title;  // title in tables and figures
  bool in_water;      // true: photographs through the port; false: photographs in air
  Words options;      // options of DensifyPointCloud, besides those of input and port
  // The clouds of every method are measured. True: the depth maps on true poses and, on COLMAP's
  // poses, the completeness for each of kCompletenessViews are measured, too.
  bool judged_closely;
};
// Returns all methods, in the order of the tables.
const std::array<Method, 5>& reconstruction_methods();

// Completeness is measured once for each of these numbers n, for the places that at least n cameras
// under water see. Numbers above the number of cameras are left out.
inline constexpr std::array<std::size_t, 4> kCompletenessViews{2, 3, 4, 5};

// Return the names of the two parts of a seed (Part::name). The part colmap_part() measures clouds
// on COLMAP's poses. The part true_part() measures clouds and depth maps on true poses.
std::string colmap_part(int seed);
std::string true_part(int seed);

// Returns all tables and figures of the experiment. `results`: results of the whole experiment, in
// the form that Experiment::documents takes. `seeds`: the seeds of the experiment, at least one.
std::vector<Document> reconstruction_documents(const Json& results, const std::vector<int>& seeds);

}  // namespace axial::experiments
