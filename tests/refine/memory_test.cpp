// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/memory.h"

#include <gtest/gtest.h>

namespace axial::refine {
namespace {

TEST(Memory, MoreMemoryKeepsMoreViews) {
  const Sizes sizes{200'000, 400'000, 12, 800'000};
  Options options;
  EXPECT_EQ(views_to_keep(sizes, options), 12u);
  options.max_bytes = bytes_needed(sizes, 2);
  EXPECT_EQ(views_to_keep(sizes, options), 2u);
  options.max_bytes = bytes_needed(sizes, 5);
  EXPECT_EQ(views_to_keep(sizes, options), 5u);
  // The mesh of a scene of 12 images of 1024 x 768 pixels.
  EXPECT_LT(bytes_needed(sizes, 12), 300'000'000u);
}

}  // namespace
}  // namespace axial::refine
