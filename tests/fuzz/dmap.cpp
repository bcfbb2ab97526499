// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS's depth maps and the files beside them.
#include "io/openmvs/dmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "reader.h"

namespace axial::fuzz {
namespace {

DepthMap small_map(bool with_port) {
  DepthMap map;
  map.image_path = "/images/a.png";
  map.ids = {4, 7};
  map.camera = {4, 3, {5, 5, 1.5, 1}, std::nullopt};
  if (with_port)
    map.camera.port = refractive::FlatPort<double>{{0, 0.6, 0.8}, 0.02, 0.01, 1, 1.5, 1.33};
  if (with_port) map.camera.distortion.emplace().above[1] = -0.01;
  map.pose.centre = {1, 2, 3};
  map.min_depth = 1;
  map.max_depth = 9;
  map.depth = cv::Mat1f(3, 4, 2.5f);
  map.depth(1, 2) = 0;
  map.normal = cv::Mat3f(3, 4, cv::Vec3f(0, 0, -1));
  map.confidence = cv::Mat1f(3, 4, 0.5f);
  return map;
}

fs::path beside(const fs::path& map) {
  return map.string() + ".json";
}

// Depths are converted to z-depth and back in float.
bool close(const cv::Mat1f& a, const cv::Mat1f& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return std::abs(x - y) <= 1e-5f * std::abs(x); });
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         (a.empty() || std::equal(a.datastart, a.dataend, b.datastart, b.dataend));
}

bool same_header(const DepthMap& a, const DepthMap& b) {
  return a.image_path == b.image_path && a.ids == b.ids && a.camera.width == b.camera.width &&
         a.camera.height == b.camera.height && a.camera.lens.fx == b.camera.lens.fx &&
         a.camera.lens.cy == b.camera.lens.cy && a.pose.centre == b.pose.centre &&
         a.pose.rotation.isApprox(b.pose.rotation, 1e-9);
}

// Depths near the smallest floats lose their digits or become zero as z-depths.
bool has_tiny_depth(const cv::Mat1f& depth) {
  return std::any_of(depth.begin(), depth.end(), [](float x) { return x != 0 && x < 1e-30f; });
}

void expect_same_copy(const io::StoredDepthMap& stored, const fs::path& file) {
  if (has_tiny_depth(stored.map.depth)) return;
  const io::StoredDepthMap again = read_copy(
      stored, file, [](const fs::path& path) { return io::read_dmap(path); },
      [](const fs::path& path, const io::StoredDepthMap& value) {
        io::write_dmap(path, value.map, value.made_from);
      });
  require(same_header(again.map, stored.map), "the copy has another header");
  require(again.made_from == stored.made_from, "the copy has another made_from");
  require(close(again.map.depth, stored.map.depth), "the copy has other depths");
  require(same_bytes(again.map.normal, stored.map.normal), "the copy has other normals");
  require(same_bytes(again.map.confidence, stored.map.confidence),
          "the copy has other confidences");
}

void read_map(const fs::path& file) {
  const io::StoredDepthMap stored = io::read_dmap(file);
  const DepthMap header = without_error([&] { return io::read_dmap_header(file); });
  require(same_header(header, stored.map), "the header is read as another one");
  expect_same_copy(stored, file);
}

// The bytes are those of a header, whose pixels are missing.
void read_header(const fs::path& file) {
  io::read_dmap_header(file);
}

void read_side_file(const fs::path& file) {
  const fs::path map = file.parent_path() / "map.dmap";
  if (!fs::exists(map)) {
    const std::string bytes = read_file(file);
    io::write_dmap(map, small_map(false), "options");
    write_atomically(file, bytes);
  }
  io::read_dmap_header(map);
  const io::StoredDepthMap stored = io::read_dmap(map, io::DmapSide::used, dropping_lines());
  require(io::dmap_status(map).is_ours_from(stored.made_from), "the map is not found to be ours");
  expect_same_copy(stored, map);
}

bool write_map_seed(const fs::path& file, int variant) {
  DepthMap map = small_map(false);
  if (variant == 1) map.confidence.release();
  io::write_dmap(file, map, "options");
  fs::remove(beside(file));
  return variant < 2;
}

bool write_side_seed(const fs::path& file, int variant) {
  const fs::path map = file.parent_path() / "map.dmap";
  io::write_dmap(map, small_map(variant == 1), "options");
  return variant < 2;
}

}  // namespace

std::span<const Reader> dmap_readers() {
  static constexpr std::array kReaders{
      Reader{"dmap", "map.dmap", read_map, write_map_seed},
      Reader{"dmap-header", "map.dmap", read_header, write_map_seed},
      Reader{"dmap-side", "map.dmap.json", read_side_file, write_side_seed}};
  return kReaders;
}

}  // namespace axial::fuzz
