// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/cloud_sample.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "view/random_cloud.h"

namespace axial::view {
namespace {

using testing::random_cloud;

PointCloud part(const PointCloud& cloud, std::size_t begin, std::size_t end) {
  PointCloud portion;
  portion.view_begin = {0};
  for (std::size_t i = begin; i < end; ++i) {
    portion.positions.push_back(cloud.positions[i]);
    portion.colors.push_back(cloud.colors[i]);
    for (const std::uint32_t view : cloud.views_of(i)) portion.view_images.push_back(view);
    portion.view_begin.push_back(portion.view_images.size());
  }
  return portion;
}

PointCloud sample_of(const PointCloud& cloud, std::size_t most, std::size_t portion) {
  CloudSample sample(most);
  for (std::size_t i = 0; i < cloud.size(); i += portion)
    sample.add(part(cloud, i, std::min(i + portion, cloud.size())), cloud.size());
  EXPECT_EQ(sample.added(), cloud.size());
  return sample.take();
}

void expect_equal(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.view_begin, b.view_begin);
  EXPECT_EQ(a.view_images, b.view_images);
}

TEST(CloudSample, KeepsASmallCloud) {
  const PointCloud cloud = random_cloud(1000);
  expect_equal(sample_of(cloud, 1000, 300), cloud);
}

TEST(CloudSample, HasAPointOfEveryCloud) {
  for (std::size_t points = 2; points < 40; ++points)
    EXPECT_GE(sample_of(random_cloud(points), 1, 7).size(), 1u);
}

TEST(CloudSample, DoesNotDependOnThePortions) {
  const PointCloud cloud = random_cloud(5000);
  expect_equal(sample_of(cloud, 700, 5000), sample_of(cloud, 700, 113));
}

TEST(CloudSample, HasAboutTheWantedSizeAndPointsOfTheCloud) {
  const PointCloud cloud = random_cloud(20000);
  const PointCloud sample = sample_of(cloud, 5000, 20000);
  // Five standard deviations of a binomial distribution.
  EXPECT_NEAR(static_cast<double>(sample.size()), 5000, 5 * std::sqrt(5000 * 0.75));
  std::size_t at = 0;
  for (std::size_t i = 0; i < sample.size(); ++i, ++at) {
    while (at < cloud.size() && cloud.positions[at] != sample.positions[i]) ++at;
    ASSERT_LT(at, cloud.size());
    EXPECT_EQ(sample.colors[i], cloud.colors[at]);
    const auto a = sample.views_of(i), b = cloud.views_of(at);
    EXPECT_TRUE(std::ranges::equal(a, b));
  }
}

TEST(Chunks, HoldEachPointOnce) {
  const PointCloud cloud = random_cloud(10000);
  std::vector<int> times(cloud.size());
  std::size_t level = 0;
  for (const PointChunk& chunk : divide_into_chunks(cloud, 100)) {
    EXPECT_GE(chunk.level, level);
    level = chunk.level;
    EXPECT_LE(chunk.points.size(), 100u);
    EXPECT_FALSE(chunk.points.empty());
    for (const std::uint32_t i : chunk.points) ++times[i];
  }
  EXPECT_EQ(times, std::vector<int>(cloud.size(), 1));
}

TEST(Chunks, GrowFourTimesFromLevelToLevel) {
  const PointCloud cloud = random_cloud(10000);
  std::map<std::size_t, std::size_t> points;
  for (const PointChunk& chunk : divide_into_chunks(cloud, 100))
    points[chunk.level] += chunk.points.size();
  EXPECT_EQ(points, (std::map<std::size_t, std::size_t>{
                        {0, 100}, {1, 300}, {2, 1200}, {3, 4800}, {4, 3600}}));
}

// The first points of a file often show one place, so a prefix of the file is no even sample.
TEST(Chunks, OfTheFirstLevelsAreAnEvenSample) {
  const PointCloud cloud = random_cloud(20000);
  for (std::size_t last = 1; last < 4; ++last) {
    double early = 0, all = 0;
    for (const PointChunk& chunk : divide_into_chunks(cloud, 100)) {
      if (chunk.level > last) continue;
      all += static_cast<double>(chunk.points.size());
      for (const std::uint32_t i : chunk.points) early += i < cloud.size() / 4;
    }
    EXPECT_NEAR(early, all / 4, 5 * std::sqrt(all * 0.25 * 0.75)) << last;
  }
}

TEST(Chunks, HaveTheirPointsInRandomOrder) {
  const PointCloud cloud = random_cloud(20000);
  double early = 0, all = 0;
  for (const PointChunk& chunk : divide_into_chunks(cloud, 100)) {
    std::vector<std::uint32_t> sorted = chunk.points;
    std::ranges::sort(sorted);
    const std::uint32_t quarter = sorted[sorted.size() / 4];
    for (std::size_t k = 0; k < chunk.points.size() / 2; ++k, ++all)
      early += chunk.points[k] < quarter;
  }
  EXPECT_NEAR(early, all / 4, 5 * std::sqrt(all * 0.25 * 0.75));
}

// Every chunk of a level has its own part of space, so their boxes fill the box of the cloud once.
TEST(Chunks, OfALevelHaveTheirOwnSpace) {
  const PointCloud cloud = random_cloud(10000);
  std::map<std::size_t, double> volumes;
  for (const PointChunk& chunk : divide_into_chunks(cloud, 100)) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t i : chunk.points) box.extend(cloud.positions[i].cast<double>());
    volumes[chunk.level] += box.volume();
  }
  for (const auto& [level, volume] : volumes) EXPECT_LE(volume, 1.0) << level;
}

}  // namespace
}  // namespace axial::view
