// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/experiment.h"

#include <gtest/gtest.h>

#include <set>

namespace axial::experiments {
namespace {

TEST(Variations, EachChangesItsOwnParameterAndTheDefaultIsOnePart) {
  const std::vector<Series> series{{"n_glass", {1.49, 1.52}}, {"n_water", {1.333, 1.34}}};
  const std::vector<Variation> all = variations(series, 2);
  std::set<std::string> names;
  for (const Variation& one : all) names.insert(part_name(one.series, one.value, 2));
  EXPECT_EQ(names, (std::set<std::string>{"setup2_default", "setup2_n_glass_1.49",
                                          "setup2_n_water_1.34"}));
  EXPECT_EQ(vary("n_glass", 1.49).setup.camera.n_glass, 1.49);
  EXPECT_EQ(vary("n_water", 1.34).setup.camera.n_water, 1.34);
  EXPECT_EQ(vary("n_water", 1.34).setup.camera.n_glass, CameraSetup().n_glass);
}

}  // namespace
}  // namespace axial::experiments
