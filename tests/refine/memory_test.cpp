// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/memory.h"

#include <gtest/gtest.h>

namespace axial::refine {
namespace {

TEST(Memory, MoreMemoryKeepsMoreViews) {
  const Sizes sizes{200'000, 400'000, 12, 800'000};
  EXPECT_EQ(views_to_keep(sizes, {}, {}), 12u);
  for (const unsigned views : {2u, 5u})
    EXPECT_EQ(views_to_keep(sizes, {}, MemoryBudget::of_bytes(bytes_needed(sizes, views))), views);
  // The mesh of a scene of 12 images of 1024 x 768 pixels.
  EXPECT_LT(bytes_needed(sizes, 12), 300'000'000u);
}

}  // namespace
}  // namespace axial::refine
