// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/same_place.h"

#include <gmock/gmock.h>

#include <limits>

#include "axial/compare.h"
#include "support/error_of.h"
#include "two_surveys.h"

namespace axial::test {
namespace {

using namespace compare;
using testing::AllOf;
using testing::HasSubstr;

cv::Mat1f heights_of(const Height& height, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> error(0, noise);
  cv::Mat1f heights(120, 160);
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x)
      heights(y, x) = static_cast<float>(height(0.025 * x, 0.025 * y) + error(random));
  return heights;
}

double elsewhere(double x, double y) {
  return hills(1.3 * y + 3.1, 0.8 * x + 7.7);
}

double level(double, double) {
  return 0;
}

TEST(SamePlace, IsTheSameGroundInSpiteOfNoiseAndChanges) {
  for (const double noise : {1e-4, 0.002, 0.02}) {
    const PlaceAgreement agreement = agreement_of_places(heights_of(ground_before, noise, 1),
                                                         heights_of(ground_after, noise, 2));
    EXPECT_EQ(agreement.verdict, PlaceVerdict::same) << noise;
    EXPECT_GT(agreement.correlation, agreement.least + 0.1) << noise;
    // These hills repeat, so that chance is high, too.
    EXPECT_LT(agreement.chance, agreement.correlation - 0.15) << noise;
  }
}

TEST(SamePlace, IsNotOtherGround) {
  const PlaceAgreement agreement =
      agreement_of_places(heights_of(hills, 0.002, 1), heights_of(elsewhere, 0.002, 2));
  EXPECT_EQ(agreement.verdict, PlaceVerdict::different);
  EXPECT_LT(agreement.correlation, agreement.least - 0.2);
}

// A change that is much larger than the relief, over a quarter of the plot: the windows without it
// decide.
TEST(SamePlace, IsTheSameGroundBesideAChangeMuchLargerThanTheRelief) {
  const Height rough = [](double x, double y) { return 0.05 * elsewhere(4 * x, 4 * y); };
  const Height changed = [&](double x, double y) {
    return rough(x, y) + (x < 2 && y < 1.5 ? hills(3 * y, 4 * x) : 0);
  };
  const PlaceAgreement agreement =
      agreement_of_places(heights_of(rough, 1e-4, 1), heights_of(changed, 1e-4, 2));
  EXPECT_EQ(agreement.verdict, PlaceVerdict::same);
  EXPECT_GT(agreement.correlation, agreement.least + 0.2);
}

TEST(SamePlace, IsNotKnownOfLevelGroundAndOfFewPixels) {
  EXPECT_EQ(agreement_of_places(heights_of(level, 0.002, 1), heights_of(level, 0.002, 2)).verdict,
            PlaceVerdict::unknown);
  EXPECT_EQ(agreement_of_places(heights_of(level, 0, 1), heights_of(level, 0, 2)).verdict,
            PlaceVerdict::unknown);
  cv::Mat1f few = heights_of(elsewhere, 0.002, 1);
  few.rowRange(4, few.rows).setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(agreement_of_places(heights_of(hills, 0.002, 1), few).verdict, PlaceVerdict::unknown);
}

TEST(SamePlace, OthersAreRefusedUnlessTheyAreAllowed) {
  const Mesh before = surveyed({.high = {2, 2}, .spacing = 0.02}, hills);
  const Mesh after = surveyed({.high = {2, 2}, .spacing = 0.02, .seed = 2}, elsewhere);
  CompareOptions options;
  options.pixel = 0.02;
  for (const bool align : {false, true}) {
    options.align = align;
    options.allow_other_place = false;
    EXPECT_THAT(error_of([&] { compare_surveys(before, after, {}, options); }),
                AllOf(HasSubstr("the later survey: does not show the place of the earlier survey"),
                      HasSubstr("allow_other_place compares them all the same")));
    options.allow_other_place = true;
    EXPECT_EQ(compare_surveys(before, after, {}, options).place.verdict, PlaceVerdict::different);
  }
}

}  // namespace
}  // namespace axial::test
