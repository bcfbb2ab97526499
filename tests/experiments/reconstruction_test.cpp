// SPDX-License-Identifier: GPL-3.0-or-later
// Tables that combine the depth maps of several seeds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/reconstruction_maps.h"

namespace axial::experiments {
namespace {

using ::testing::HasSubstr;

const Seeds kSeeds{1, 2, 3};

Json ring(std::size_t pixels, double median) {
  Json one;
  one["inner"] = 0.25;
  one["outer"] = 0.5;
  one["count"] = pixels;
  one["median"] = median;
  return one;
}

Json place(const char* name, double pixels, double gross, double mean) {
  Json one;
  one["place"] = name;
  one["truths"] = 2 * pixels;
  one["pixels"] = pixels;
  one["gross"] = gross;
  one["mean"] = mean;
  one["median"] = mean / 2;
  return one;
}

// The maps of one method. `k` is the number of the seed, from 0.
Json maps(std::size_t k, double ring_shift) {
  Json one;
  const double medians[] = {0.001, 0.004, 0.002};
  one["pixels"] = 20000;
  one["median"] = medians[k];
  one["within"] = 0.75;
  one["gross"] = 0.02;
  one["mean"] = 0.003;
  one["completeness"] = 0.9;
  const double shifts[] = {1e-4, 5e-4, 2e-4};
  one["rings"].push_back(ring(9000, 1e-3 + ring_shift * shifts[k]));
  one["rings"].push_back(ring(k == 1 ? 4999 : 9000, 1e-3 + ring_shift * 7e-4));  // too few
  one["rings"].push_back(ring(9000, 1e-3 - ring_shift * 3e-4));
  one["places"].push_back(place("no texture", 4000, 0, 0.004));
  one["places"].push_back(place("all else", 12000, 3000, 0.002));
  return one;
}

// The rings of our method are shifted against those in air.
Json results() {
  Json all;
  for (std::size_t k = 0; k < kSeeds.size(); ++k) {
    Json& of_seed = all["parts"][true_part(kSeeds[k])]["result"]["maps"];
    of_seed["air"] = maps(k, 0);
    of_seed["ours"] = maps(k, 1);
    of_seed["papers"] = maps(k, -2);
  }
  return all;
}

TEST(Seeds, AreCombinedByMedianAndInTheirOrder) {
  EXPECT_EQ(median_over({4, 9, 5}, [](int seed) { return 2.0 * seed; }), 10);
  EXPECT_EQ(joined({4, 9, 5}, [](int seed) { return std::to_string(seed); }), "4, 9, 5");
}

TEST(Maps, ARowForEachMethodThatIsJudgedClosely) {
  const std::string table = maps_table(results(), kSeeds);
  for (const char* title : {"in air", "refracted, our method", "refracted, the paper's method"})
    EXPECT_THAT(table, HasSubstr("\n| " + std::string(title) +
                                 " | 20000 | 2.00 | 75.0 | 2.0 | 3.00 | 90.0 |"));
}

TEST(Rings, WithFewPixelsInAnyMapDoNotCount) {
  const std::string table = rings_table(results(), kSeeds);
  EXPECT_THAT(table, HasSubstr("| fewer than 5000 pixels | - | - | - |"));
  EXPECT_THAT(table, HasSubstr("| +10.00 | +12.00 | +2.00 | +1.00, +5.00, +2.00 |"));
  // The second ring, which is left out, has a difference of 7e-4.
  EXPECT_NEAR(largest_ring_difference(results(), kSeeds), 3e-4, 1e-12);
}

TEST(Places, SharesAreOfAllPlaces) {
  const std::string table = places_table(results(), kSeeds);
  EXPECT_THAT(table, HasSubstr("| in air | no texture | 25.0 | - | - | - | - | - |"));
  // The errors that are not gross: 9000 of 2 mm here, and 4000 of 4 mm at the other place.
  EXPECT_THAT(table, HasSubstr("| in air | all else | 75.0 | 50.0 | 1.00 | 25.0 | 2.00 | 52.9 |"));
}

}  // namespace
}  // namespace axial::experiments
