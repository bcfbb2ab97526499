// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/completeness.h"

#include <gtest/gtest.h>

namespace axial::experiments {
namespace {

TEST(Completeness, ToleranceOfThePresetUnlessItIsGiven) {
  CompletenessOptions options;
  EXPECT_EQ(options.preset, "closeup");
  EXPECT_EQ(tolerance_of(options), 0.002);
  options.preset = "reef";
  options.poses = "colmap";
  EXPECT_EQ(tolerance_of(options), 0.005);
  options.tolerance = 0.007;
  EXPECT_EQ(tolerance_of(options), 0.007);
  EXPECT_EQ(completeness_name(options), "completeness_reef_water_colmap");
}

}  // namespace
}  // namespace axial::experiments
