// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/cloud_data.h"

#include <gmock/gmock.h>

#include <numeric>

#include "support/error_of.h"
#include "view/byte_source.h"
#include "view/random_cloud.h"

namespace axial::view {
namespace {

using test::error_of;
using testing::ByteSource;
using ::testing::HasSubstr;
using testing::random_cloud;

PointChunk all_of(const PointCloud& cloud) {
  PointChunk chunk;
  chunk.points.resize(cloud.size());
  std::iota(chunk.points.begin(), chunk.points.end(), 0u);
  return chunk;
}

const std::vector<std::uint32_t> kCameras{10, 11, 12, 13, 65535};

TEST(ChunkData, HoldsPositionsViewsAndColors) {
  const PointCloud cloud = random_cloud(500);
  const ChunkData data = chunk_data(cloud, all_of(cloud), kCameras);
  ByteSource source(data.bytes);
  for (const Eigen::Vector3f& position : cloud.positions)
    for (int k = 0; k < 3; ++k) {
      const double value = data.low[k] + data.size[k] * source.take<std::uint16_t>() / 65535.0;
      EXPECT_NEAR(value, position[k], 0.51 * data.size[k] / 65535);
    }
  std::vector<std::uint16_t> numbers;
  for (std::size_t i = 0; i < cloud.size(); ++i) numbers.push_back(source.take<std::uint16_t>());
  std::vector<std::vector<std::uint32_t>> lists(data.lists);
  for (auto& list : lists) {
    list.resize(source.take<std::uint16_t>());
    for (std::uint32_t& camera : list) camera = source.take<std::uint16_t>();
  }
  EXPECT_LT(lists.size(), 40u);  // points share lists
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::vector<std::uint32_t> expected;
    for (const std::uint32_t image : cloud.views_of(i)) expected.push_back(kCameras[image]);
    EXPECT_EQ(lists.at(numbers[i]), expected);
  }
  for (const Rgb& color : cloud.colors)
    for (const std::uint8_t value : color) EXPECT_EQ(source.take<std::uint8_t>(), value);
  EXPECT_TRUE(source.at_end());
}

TEST(ChunkData, OfABarePointIsGrey) {
  PointCloud cloud;
  cloud.positions = {{1, 2, 3}};
  const ChunkData data = chunk_data(cloud, all_of(cloud), {});
  EXPECT_EQ(data.low, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(data.size, Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(data.lists, 0u);
  EXPECT_EQ(data.bytes, std::string("\0\0\0\0\0\0\xa0\xa0\xa0", 9));
}

TEST(ChunkData, HoldsErrorsBeforeTheColors) {
  const PointCloud cloud = random_cloud(50);
  std::vector<float> distances(50);
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = 0.001f * static_cast<float>(i);
  distances[7] = 1e6;  // beyond 200 times the median
  const PointErrors errors{distances, error_step(distances)};
  const ChunkData without = chunk_data(cloud, all_of(cloud), kCameras);
  const ChunkData data = chunk_data(cloud, all_of(cloud), kCameras, errors);
  ASSERT_EQ(data.bytes.size(), without.bytes.size() + 100);
  ByteSource source(data.bytes.substr(data.bytes.size() - 250));
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double expected = i == 7 ? 65535 * errors.step : distances[i];
    EXPECT_NEAR(source.take<std::uint16_t>() * errors.step, expected, 0.51 * errors.step);
  }
  EXPECT_LT(errors.step, 1e-4);
  EXPECT_EQ(error_step({}), 0);
}

TEST(ChunkData, RefusesViewsWithoutACamera) {
  PointCloud cloud = random_cloud(2);
  cloud.view_begin = {0, 1, 2};
  cloud.view_images = {0, 5};
  EXPECT_THAT(error_of([&] { chunk_data(cloud, all_of(cloud), kCameras); }),
              HasSubstr("view_indices has image 5, but the scene has 5 images"));
  cloud.view_images = {0, 1};
  const std::vector<std::uint32_t> cameras{0, kNoId};
  EXPECT_THAT(error_of([&] { chunk_data(cloud, all_of(cloud), cameras); }),
              HasSubstr("view_indices has image 1, which is not calibrated"));
}

TEST(ChunkData, RefusesTooManyPoints) {
  PointCloud cloud;
  cloud.positions.resize(kMostChunkPoints + 1, {0, 0, 0});
  EXPECT_THAT(error_of([&] { chunk_data(cloud, all_of(cloud), {}); }), HasSubstr("65537 points"));
}

}  // namespace
}  // namespace axial::view
