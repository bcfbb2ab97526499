// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/atlas/packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/error_of.h"

namespace axial::texture {
namespace {

std::vector<cv::Size> some_sizes(std::uint32_t seed, std::size_t count, int longest) {
  cv::RNG random(seed);
  std::vector<cv::Size> sizes;
  for (std::size_t i = 0; i < count; ++i)
    sizes.emplace_back(random.uniform(1, longest + 1), random.uniform(1, longest + 1));
  return sizes;
}

void expect_valid(const std::vector<cv::Size>& sizes, const PackingOptions& options) {
  const Packing packing = pack(sizes, options);
  ASSERT_EQ(packing.places.size(), sizes.size());
  std::vector<cv::Mat1i> owner;
  for (const cv::Size& size : packing.sizes) {
    if (options.max_size > 0) {
      EXPECT_LE(std::max(size.width, size.height), options.max_size);
    }
    owner.emplace_back(size, 0);
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Place& place = packing.places[i];
    ASSERT_LT(place.texture, owner.size());
    const cv::Rect rect(place.corner, size_at(place, sizes[i]));
    cv::Mat1i& texture = owner[place.texture];
    ASSERT_EQ(rect & cv::Rect({}, texture.size()), rect) << "rectangle " << i << " is outside";
    EXPECT_EQ(cv::countNonZero(texture(rect)), 0) << "rectangle " << i << " covers another";
    texture(rect) = static_cast<int>(i) + 1;
  }
  EXPECT_EQ(packing.places[0].corner, cv::Point(0, 0));
}

RC_GTEST_PROP(Packing, RectanglesAreDisjointAndInside, ()) {
  const auto seed = *rc::gen::inRange<std::uint32_t>(0, 1000);
  const auto count = *rc::gen::inRange<std::size_t>(1, 60);
  const auto multiple = *rc::gen::element(0, 1, 48);
  expect_valid(some_sizes(seed, count, 90), {256, multiple});
}

TEST(Packing, ManyTexturesAreUsedWhereOneIsTooSmall) {
  const std::vector<cv::Size> sizes = some_sizes(1, 200, 60);
  EXPECT_GT(pack(sizes, {128, 0}).sizes.size(), 5u);
  expect_valid(sizes, {128, 0});
}

// The packer is not asked for a place of each rectangle in each texture, and still fills textures.
TEST(Packing, ThousandsOfTexturesAreWellFilled) {
  const std::vector<cv::Size> sizes = some_sizes(2, 40'000, 24);
  double area = 0;
  for (const cv::Size& size : sizes) area += size.area();
  const Packing packing = pack(sizes, {64, 0});
  EXPECT_GT(packing.sizes.size(), 1000u);
  double used = 0;
  for (const cv::Size& size : packing.sizes) used += size.area();
  EXPECT_GT(area, 0.8 * used);
  expect_valid(sizes, {64, 0});
}

// After a texture that is too small the next larger size is tried, and not the largest.
TEST(Packing, TexturesAreNotLargerThanNeeded) {
  const std::vector<cv::Size> sizes(90, cv::Size(30, 34));  // 91,800 px: 87 % of 324 x 324
  const Packing packing = pack(sizes, {8192, 0});
  ASSERT_EQ(packing.sizes.size(), 1u);
  EXPECT_EQ(packing.sizes[0], cv::Size(512, 256));
  const cv::Size multiple = pack(sizes, {8192, 100}).sizes[0];
  EXPECT_EQ(multiple.width % 100, 0);
  EXPECT_EQ(multiple.height % 100, 0);
  EXPECT_LT(multiple.area(), 2 * 91'800);
}

TEST(Packing, ALargeRectangleIsScaledDown) {
  const std::vector<cv::Size> sizes{{5, 5}, {1000, 300}, {20, 20}};
  const Packing packing = pack(sizes, {100, 0});
  EXPECT_EQ(packing.scaled_down, 1u);
  EXPECT_EQ(size_at(packing.places[1], sizes[1]), cv::Size(100, 30));
  expect_valid(sizes, {100, 0});
}

TEST(Packing, WrongOptionsAreRefused) {
  const std::vector<cv::Size> sizes{{5, 5}};
  EXPECT_THAT(test::error_of([&] {
                pack(sizes, {3, 0});
              }),
              testing::HasSubstr("max_texture_size 3"));
  EXPECT_THAT(test::error_of([&] {
                pack(sizes, {64, -1});
              }),
              testing::HasSubstr("texture_size_multiple -1"));
}

}  // namespace
}  // namespace axial::texture
