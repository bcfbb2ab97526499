// SPDX-License-Identifier: GPL-3.0-or-later
// What the stages say that they need, against the memory that they use.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/memory.h"
#include "cloud/fusion_map.h"
#include "densify/project.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "support/analytic_scene.h"
#include "support/empty_folder.h"
#include "survey/image_store.h"

namespace axial::densify {
namespace {

using survey::Channels;

std::uint64_t bytes_of(const std::vector<cv::Mat>& images) {
  std::uint64_t bytes = 0;
  for (const cv::Mat& image : images) bytes += image.total() * image.elemSize();
  return bytes;
}

TEST(StageMemory, OfImagesAndMapsIsExact) {
  const auto folder = test::empty_folder();
  Project project;
  io::write_png(folder / "image.png", cv::Mat3b(72, 96, cv::Vec3b(10, 20, 30)));
  io::write_png(folder / "mask.png", cv::Mat1b(72, 96, uchar{1}));
  project.options.ignore_mask_label = 0;
  project.views.resize(1);
  project.views[0].file = folder / "image.png";
  project.views[0].camera = test::dry_camera();
  project.views[0].header = io::read_image_header(folder / "image.png");
  for (const bool mask : {false, true})
    for (const bool color : {false, true}) {
      project.views[0].mask = mask ? folder / "mask.png" : std::filesystem::path();
      const auto image =
          survey::ImageStore(project, color ? Channels::both : Channels::grey, 1).get(0);
      EXPECT_EQ(survey::bytes_needed(survey::PixelsSize{72 * 96, mask, color}),
                bytes_of({image->grey, image->color, image->mask}));
    }
  const DepthMap map = test::exact_map({}, test::dry_camera(), {});
  EXPECT_EQ(bytes_of_depths(72 * 96), bytes_of({map.depth}));
  EXPECT_EQ(bytes_of_map(72 * 96), bytes_of({map.depth, map.normal, map.confidence}));
  for (const bool color : {false, true}) {
    const cv::Mat3b colors = color ? cv::Mat3b(72, 96) : cv::Mat3b();
    const cloud::FusionMap fused = cloud::make_fusion_map(map, colors);
    EXPECT_EQ(cloud::bytes_needed({72 * 96, 0, 1, color}),
              bytes_of({fused.depth, fused.normal, fused.weight, fused.color}));
  }
}

// A value of /proc/self/status [bytes].
std::uint64_t status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (std::uint64_t kilobytes = 0; word == name + ":" && file >> kilobytes)
      return 1024 * kilobytes;
  return 0;
}

// The largest number of bytes that were resident while `run` ran, besides those before. Empty if
// the system cannot forget an earlier peak.
template <class Run>
std::optional<std::uint64_t> peak_of(const Run& run) {
  return_freed_memory();
  std::ofstream("/proc/self/clear_refs") << 5;
  const std::uint64_t before = status("VmHWM");
  if (before > resident_memory() + (4u << 20)) return {};
  run();
  return status("VmHWM") - before;
}

// Threads, small blocks and what a call allocates once.
constexpr std::uint64_t kSmallBlocks = 12u << 20;

// `use`: the share of the bound that is used at least. A bound of much more than the use would make
// runs slow that have little memory.
template <class Run>
void expect_within(std::uint64_t bound, double use, const Run& run) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed blocks to itself";
#endif
  run();  // starts threads and loads code
  const auto peak = peak_of(run);
  if (!peak) GTEST_SKIP() << "the system does not measure the peak";
  EXPECT_LE(*peak, bound + kSmallBlocks);
  EXPECT_GE(static_cast<double>(*peak), use * static_cast<double>(bound));
}

CameraModel large_camera() {
  return test::dry_camera().resized(960, 720);
}

// Five photographs of a wall with a pattern.
class Matching : public testing::Test {
 protected:
  Matching() {
    const CameraModel camera = large_camera();
    const std::vector<Pose> poses = test::circle_of_poses(5);
    for (std::uint32_t i = 0; i < 5; ++i) {
      cv::Mat1b grey(camera.height, camera.width);
      cv::RNG(i).fill(grey, cv::RNG::UNIFORM, 0, 255);
      views_.push_back({i, camera, poses[i], grey});
    }
    for (std::size_t i = 1; i < 5; ++i) sources_.push_back(&views_[i]);
  }

  std::vector<depth::MatchImage> views_;
  std::vector<const depth::MatchImage*> sources_;
  const std::vector<Eigen::Vector3f> points_{{0, 0, 1}, {0.1f, 0, 0.9f}};
  const std::uint64_t pixels_ = 960 * 720;
};

TEST_F(Matching, MemoryIsWithinItsBound) {
  const depth::MatchInput input{&views_[0], sources_, points_};
  depth::PatchMatchOptions options;
  options.iterations = 1;
  DepthMap map;
  // The bound includes the copies of the filters, which this call does not make.
  expect_within(depth::bytes_needed(depth::MatchSize{pixels_, 4}), 0.35, [&] {
    map = DepthMap();
    map = depth::estimate_depth_map(input, options);
  });
}

TEST_F(Matching, AdjustingIsWithinItsBound) {
  std::vector<DepthMap> maps;
  for (const depth::MatchImage& view : views_)
    maps.push_back(test::exact_map({}, view.camera, view.pose));
  const std::vector<DepthMap> neighbours(maps.begin() + 1, maps.end());
  DepthMap adjusted;
  expect_within(depth::bytes_needed(depth::AdjustSize{pixels_, 4}), 0.5, [&] {
    adjusted = DepthMap();
    adjusted = depth::adjust_with_neighbours(maps[0], neighbours);
  });
}

TEST_F(Matching, FilesOfMapsAreWithinTheirBound) {
  const auto file = test::empty_folder() / "map.dmap";
  DepthMap map = test::exact_map({}, large_camera(), {});
  map.ids = {0};
  const std::uint64_t bound = io::dmap_bytes_needed(pixels_);
  expect_within(bound, 0.3, [&] { io::write_dmap(file, map, "print"); });
  map = DepthMap();
  expect_within(bound + bytes_of_map(pixels_), 0.3, [&] {
    map = DepthMap();
    map = io::read_dmap(file).map;
  });
}

}  // namespace
}  // namespace axial::densify
