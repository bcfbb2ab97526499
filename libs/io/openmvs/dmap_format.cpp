// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.h"
#include "cameras/private/checked_rotation.h"
#include "openmvs/private/dmap_parts.h"
#include "openmvs/private/mvs_format.h"

namespace axial::io {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

enum Content : std::uint8_t { kHasDepth = 1, kHasNormals = 2, kHasConfidence = 4, kHasViews = 8 };

template <class Pixel>
void read_pixels(ByteReader& in, cv::Mat_<Pixel>& image, const char* field) {
  const auto values = image.total() * sizeof(Pixel) / sizeof(float);
  const std::span<float> flat(reinterpret_cast<float*>(image.data), values);
  in.read(flat, field);
  const auto bad = std::ranges::find_if_not(flat, [](float x) { return std::isfinite(x); });
  if (bad != flat.end())
    fail_in(in.file(), "{} at pixel {} is {}", field,
            static_cast<std::size_t>(bad - flat.begin()) * sizeof(float) / sizeof(Pixel), *bad);
}

cv::Size read_size(ByteReader& in, const char* field) {
  constexpr std::uint32_t kLargestSide = 1'000'000;
  const auto width = in.read<std::uint32_t>(field);
  const auto height = in.read<std::uint32_t>(field);
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
    fail_in(in.file(), "{} is {}x{}", field, width, height);
  return {static_cast<int>(width), static_cast<int>(height)};
}

CameraModel read_camera(ByteReader& in, cv::Size image_size) {
  RowMajor k;
  in.read(std::span(k.data(), 9), "K");
  if (!k.allFinite() || !(k(0, 0) > 0) || !(k(1, 1) > 0) || k(0, 1) != 0 || k(1, 0) != 0 ||
      k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1)
    fail_in(in.file(), "K is not a calibration matrix without skew: {} {} {} {} {} {} {} {} {}",
            k(0, 0), k(0, 1), k(0, 2), k(1, 0), k(1, 1), k(1, 2), k(2, 0), k(2, 1), k(2, 2));
  CameraModel camera;
  camera.width = image_size.width;
  camera.height = image_size.height;
  camera.lens = {k(0, 0), k(1, 1), k(0, 2), k(1, 2)};
  return camera;
}

Pose read_map_pose(ByteReader& in) {
  RowMajor r;
  Pose pose;
  in.read(std::span(r.data(), 9), "R");
  in.read(std::span(pose.centre.data(), 3), "C");
  if (!pose.centre.allFinite()) fail_in(in.file(), "C is not finite");
  pose.rotation = checked_rotation(r, in.file() + ": R");
  return pose;
}

template <class Pixel>
void write_pixels(ByteWriter& out, const cv::Mat_<Pixel>& image) {
  for (int row = 0; row < image.rows; ++row)
    out.write(std::span(reinterpret_cast<const float*>(image[row]),
                        static_cast<std::size_t>(image.cols) * sizeof(Pixel) / sizeof(float)));
}

void write_header(ByteWriter& out, const DepthMap& map, const std::pair<float, float>& range,
                  const std::string& image) {
  unsigned content = kHasDepth;
  if (!map.normal.empty()) content |= kHasNormals;
  if (!map.confidence.empty()) content |= kHasConfidence;
  out.text("DR");
  out.write(static_cast<std::uint8_t>(content));
  out.write(std::uint8_t{0});
  for (int i = 0; i < 2; ++i) {
    out.write(static_cast<std::uint32_t>(map.width()));
    out.write(static_cast<std::uint32_t>(map.height()));
  }
  out.write(range.first);
  out.write(range.second);
  out.write(static_cast<std::uint16_t>(image.size()));
  out.text(image);
  out.write(static_cast<std::uint32_t>(map.ids.size()));
  out.write(std::span(map.ids));
  RowMajor k;
  k << map.camera.lens.fx, 0, map.camera.lens.cx, 0, map.camera.lens.fy, map.camera.lens.cy, 0, 0,
      1;
  const RowMajor r = map.pose.rotation;
  out.write(std::span(k.data(), 9));
  out.write(std::span(r.data(), 9));
  out.write(std::span(map.pose.centre.data(), 3));
}

}  // namespace

std::uint64_t DmapHeader::bytes_of_pixels() const {
  const std::uint64_t floats =
      1 + (content & kHasNormals ? 3 : 0) + (content & kHasConfidence ? 1 : 0);
  return pixels() * (floats * sizeof(float) + (content & kHasViews ? 4 : 0));
}

DmapHeader parse_dmap_header(ByteReader& in) {
  if (in.take(2, "magic") != "DR")
    fail_in(in.file(), "is not a .dmap file: it does not start with DR");
  const auto content = in.read<std::uint8_t>("content flags");
  if (!(content & kHasDepth) || content > (kHasDepth | kHasNormals | kHasConfidence | kHasViews))
    fail_in(in.file(), "content flags are {}", content);
  in.read<std::uint8_t>("padding");
  const cv::Size image_size = read_size(in, "image size");
  const cv::Size size = read_size(in, "depth map size");
  if (size.width > image_size.width || size.height > image_size.height)
    fail_in(in.file(), "the depth map ({}x{}) is larger than the image ({}x{})", size.width,
            size.height, image_size.width, image_size.height);
  DmapHeader header;
  header.content = content;
  DepthMap& map = header.map;
  map.min_depth = in.read<float>("dMin");
  map.max_depth = in.read<float>("dMax");
  if (!std::isfinite(map.min_depth) || !std::isfinite(map.max_depth))
    fail_in(in.file(), "the depth range is {} to {}", map.min_depth, map.max_depth);
  map.image_path = in.take(in.read<std::uint16_t>("length of the image name"), "image name");
  const auto ids = in.read<std::uint32_t>("number of ids");
  in.require_room(ids, sizeof(std::uint32_t), "ids");
  if (ids < 1) fail_in(in.file(), "has no ids");
  map.ids.resize(ids);
  in.read(std::span(map.ids), "ids");
  map.camera = read_camera(in, image_size);
  if (image_size != size) map.camera = map.camera.resized(size.width, size.height);
  map.pose = read_map_pose(in);
  return header;
}

DepthMap parse_dmap(ByteReader& in) {
  DmapHeader header = parse_dmap_header(in);
  DepthMap& map = header.map;
  const auto content = header.content;
  const std::uint64_t pixels = header.pixels();
  const cv::Size size(map.camera.width, map.camera.height);
  in.require_room(pixels, sizeof(float), "depth");
  map.depth.create(size);
  read_pixels(in, map.depth, "depth");
  if (content & kHasNormals) {
    in.require_room(pixels, 3 * sizeof(float), "normals");
    map.normal.create(size);
    read_pixels(in, map.normal, "normal");
  } else {
    map.normal = cv::Mat3f(size, cv::Vec3f(0, 0, 0));
  }
  if (content & kHasConfidence) {
    in.require_room(pixels, sizeof(float), "confidence");
    map.confidence.create(size);
    read_pixels(in, map.confidence, "confidence");
  }
  if (content & kHasViews) in.take(4 * pixels, "views");
  in.require_end();
  return std::move(header.map);
}

ByteWriter format_dmap(const DepthMap& map, const cv::Mat1f& z_depth,
                       const std::pair<float, float>& range, const std::string& image) {
  ByteWriter out;
  constexpr std::size_t kHeader = 4096;  // more than enough
  out.reserve(kHeader + map.depth.total() * 5 * sizeof(float));
  write_header(out, map, range, image);
  write_pixels(out, z_depth);
  write_pixels(out, map.normal);
  write_pixels(out, map.confidence);
  return out;
}

}  // namespace axial::io
