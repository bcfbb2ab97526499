// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/dmap.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "private/bytes/byte_reader.h"
#include "private/bytes/byte_writer.h"
#include "private/openmvs/dmap_side_file.h"
#include "private/openmvs/rotation.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

enum Content : std::uint8_t { kDepth = 1, kNormals = 2, kConfidence = 4, kViews = 8 };

// Converts between z-depth in the camera frame and lambda, the distance along the pixel's ray: z =
// o_z + lambda d_z.
struct DepthAlongRay {
  double origin_z, direction_z;

  double z(double lambda) const { return origin_z + lambda * direction_z; }
  double lambda(double z_depth) const { return (z_depth - origin_z) / direction_z; }
};

template <class Camera>
DepthAlongRay depth_along_ray(const Camera& camera, double u, double v) {
  const auto ray = camera.ray({u, v});
  return {ray.origin.z(), ray.direction.z()};
}

DepthAlongRay centre_ray(const CameraModel& model) {
  return std::visit(
      [&](const auto& camera) {
        return depth_along_ray(camera, (model.width - 1) / 2.0, (model.height - 1) / 2.0);
      },
      make_camera<double>(model));
}

// Returns `depth` with every valid value replaced by convert(ray, value). Error if a value or a
// result is not finite or not positive.
template <class Convert>
cv::Mat1f converted(const cv::Mat1f& depth, const CameraModel& model, const std::string& file,
                    Convert convert) {
  cv::Mat1f result(depth.size(), 0.0f);
  const auto convert_all = [&](const auto& camera) {
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u) {
        const float value = depth(v, u);
        if (value == 0) continue;
        const DepthAlongRay ray = depth_along_ray(camera, u, v);
        const auto other = static_cast<float>(convert(ray, static_cast<double>(value)));
        if (!(value > 0 && std::isfinite(value) && other > 0 && std::isfinite(other)))
          fail("{}: depth at pixel ({}, {}) is {}, which is not a valid depth for this camera",
               file, u, v, value);
        result(v, u) = other;
      }
  };
  std::visit(convert_all, make_camera<double>(model));
  return result;
}

// The range [low, high], extended to contain all valid depths.
std::pair<float, float> enclosing(double low, double high, const cv::Mat1f& depth) {
  auto lowest = static_cast<float>(low);
  auto highest = static_cast<float>(high);
  for (const float value : depth)
    if (value > 0) {
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
  return {lowest, highest};
}

template <class Pixel>
void read_pixels(ByteReader& in, cv::Mat_<Pixel>& image, const char* field) {
  const auto values = image.total() * sizeof(Pixel) / sizeof(float);
  const std::span<float> flat(reinterpret_cast<float*>(image.data), values);
  in.read(flat, field);
  const auto bad = std::ranges::find_if_not(flat, [](float x) { return std::isfinite(x); });
  if (bad != flat.end())
    fail("{}: {} at pixel {} is {}", in.file(), field,
         static_cast<std::size_t>(bad - flat.begin()) * sizeof(float) / sizeof(Pixel), *bad);
}

cv::Size read_size(ByteReader& in, const char* field) {
  constexpr std::uint32_t kLargestSide = 1'000'000;
  const auto width = in.read<std::uint32_t>(field);
  const auto height = in.read<std::uint32_t>(field);
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
    fail("{}: {} is {}x{}", in.file(), field, width, height);
  return {static_cast<int>(width), static_cast<int>(height)};
}

CameraModel read_camera(ByteReader& in, cv::Size image_size) {
  RowMajor k;
  in.read(std::span(k.data(), 9), "K");
  if (!k.allFinite() || !(k(0, 0) > 0) || !(k(1, 1) > 0) || k(0, 1) != 0 || k(1, 0) != 0 ||
      k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1)
    fail("{}: K is not a calibration matrix without skew: {} {} {} {} {} {} {} {} {}", in.file(),
         k(0, 0), k(0, 1), k(0, 2), k(1, 0), k(1, 1), k(1, 2), k(2, 0), k(2, 1), k(2, 2));
  CameraModel camera;
  camera.width = image_size.width;
  camera.height = image_size.height;
  camera.lens = {k(0, 0), k(1, 1), k(0, 2), k(1, 2)};
  return camera;
}

Pose read_pose(ByteReader& in) {
  RowMajor r;
  Pose pose;
  in.read(std::span(r.data(), 9), "R");
  in.read(std::span(pose.centre.data(), 3), "C");
  if (!pose.centre.allFinite()) fail("{}: C is not finite", in.file());
  pose.rotation = checked_rotation(r, in.file() + ": R");
  return pose;
}

struct Header {
  DepthMap map;  // without pixels; the camera has the depth map's resolution
  std::uint8_t content = 0;

  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(map.camera.width) *
           static_cast<std::uint64_t>(map.camera.height);
  }

  std::uint64_t bytes_of_pixels() const {
    const std::uint64_t floats = 1 + (content & kNormals ? 3 : 0) + (content & kConfidence ? 1 : 0);
    return pixels() * (floats * sizeof(float) + (content & kViews ? 4 : 0));
  }
};

// The header of the .dmap file alone: z-depth, a camera without a port.
Header parse_header(ByteReader& in) {
  if (in.take(2, "magic") != "DR")
    fail("{}: is not a .dmap file: it does not start with DR", in.file());
  const auto content = in.read<std::uint8_t>("content flags");
  if (!(content & kDepth) || content > (kDepth | kNormals | kConfidence | kViews))
    fail("{}: content flags are {}", in.file(), content);
  in.read<std::uint8_t>("padding");
  const cv::Size image_size = read_size(in, "image size");
  const cv::Size size = read_size(in, "depth map size");
  if (size.width > image_size.width || size.height > image_size.height)
    fail("{}: the depth map ({}x{}) is larger than the image ({}x{})", in.file(), size.width,
         size.height, image_size.width, image_size.height);
  Header header;
  header.content = content;
  DepthMap& map = header.map;
  map.min_depth = in.read<float>("dMin");
  map.max_depth = in.read<float>("dMax");
  if (!std::isfinite(map.min_depth) || !std::isfinite(map.max_depth))
    fail("{}: the depth range is {} to {}", in.file(), map.min_depth, map.max_depth);
  map.image_path = in.take(in.read<std::uint16_t>("length of the image name"), "image name");
  const auto ids = in.read<std::uint32_t>("number of ids");
  in.require_room(ids, sizeof(std::uint32_t), "ids");
  if (ids < 1) fail("{}: has no ids", in.file());
  map.ids.resize(ids);
  in.read(std::span(map.ids), "ids");
  map.camera = read_camera(in, image_size);
  if (image_size != size) map.camera = map.camera.resized(size.width, size.height);
  map.pose = read_pose(in);
  return header;
}

DepthMap parse_dmap(ByteReader& in) {
  Header header = parse_header(in);
  DepthMap& map = header.map;
  const auto content = header.content;
  const std::uint64_t pixels = header.pixels();
  const cv::Size size(map.camera.width, map.camera.height);
  in.require_room(pixels, sizeof(float), "depth");
  map.depth.create(size);
  read_pixels(in, map.depth, "depth");
  if (content & kNormals) {
    in.require_room(pixels, 3 * sizeof(float), "normals");
    map.normal.create(size);
    read_pixels(in, map.normal, "normal");
  } else {
    map.normal = cv::Mat3f(size, cv::Vec3f(0, 0, 0));
  }
  if (content & kConfidence) {
    in.require_room(pixels, sizeof(float), "confidence");
    map.confidence.create(size);
    read_pixels(in, map.confidence, "confidence");
  }
  if (content & kViews) in.take(4 * pixels, "views");
  in.require_end();
  return std::move(header.map);
}

// Reads the beginning of a file, which is long enough for every header.
std::string read_beginning(const fs::path& path) {
  constexpr std::streamsize kLongestHeader = 1 << 18;  // names have at most 65535 bytes
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kLongestHeader, '\0');
  in.read(bytes.data(), kLongestHeader);
  if (in.bad() || (in.fail() && !in.eof())) fail("{}: cannot be read", path.string());
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

void use_side_file(const DmapSideFile& side, const std::string& file, StoredDepthMap& stored) {
  const CameraModel& in_file = stored.map.camera;
  if (side.camera.width != in_file.width || side.camera.height != in_file.height)
    fail("{}: is for {}x{} pixels, but the depth map has {}x{}", file, side.camera.width,
         side.camera.height, in_file.width, in_file.height);
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-3; };
  if (differ(side.camera.lens.fx, in_file.lens.fx) ||
      differ(side.camera.lens.fy, in_file.lens.fy) ||
      differ(side.camera.lens.cx, in_file.lens.cx) || differ(side.camera.lens.cy, in_file.lens.cy))
    fail("{}: its lens is not the K of the depth map", file);
  stored.map.camera = side.camera;
  stored.made_from = side.made_from;
}

std::string fingerprint_of(const std::string& bytes) {
  return Fingerprint().add(bytes).hex();
}

void check_map(const DepthMap& map, const std::string& file) {
  const cv::Size size = map.depth.size();
  if (map.depth.empty()) fail("{}: the depth map is empty", file);
  if (size != cv::Size(map.camera.width, map.camera.height))
    fail("{}: the depth map is {}x{}, but its camera is {}x{}", file, size.width, size.height,
         map.camera.width, map.camera.height);
  if ((!map.normal.empty() && map.normal.size() != size) ||
      (!map.confidence.empty() && map.confidence.size() != size))
    fail("{}: normals or confidences have another size than the depths", file);
  if (map.ids.empty()) fail("{}: the depth map has no ids", file);
}

template <class Pixel>
void write_pixels(ByteWriter& out, const cv::Mat_<Pixel>& image) {
  for (int row = 0; row < image.rows; ++row)
    out.write(std::span(reinterpret_cast<const float*>(image[row]),
                        static_cast<std::size_t>(image.cols) * sizeof(Pixel) / sizeof(float)));
}

// The image's path relative to the folder of the .dmap, as OpenMVS stores it.
std::string relative_image(const std::string& image, const fs::path& dmap) {
  const fs::path relative =
      fs::absolute(image).lexically_proximate(fs::absolute(dmap).parent_path());
  const std::string name = relative.generic_string();
  if (name.size() > std::numeric_limits<std::uint16_t>::max())
    fail("{}: the image name has {} bytes, at most 65535 are possible", dmap.string(), name.size());
  return name;
}

void write_header(ByteWriter& out, const fs::path& path, const DepthMap& map,
                  const cv::Mat1f& z_depth) {
  unsigned content = kDepth;
  if (!map.normal.empty()) content |= kNormals;
  if (!map.confidence.empty()) content |= kConfidence;
  out.text("DR");
  out.write(static_cast<std::uint8_t>(content));
  out.write(std::uint8_t{0});
  for (int i = 0; i < 2; ++i) {
    out.write(static_cast<std::uint32_t>(map.width()));
    out.write(static_cast<std::uint32_t>(map.height()));
  }
  const DepthAlongRay ray = centre_ray(map.camera);
  const auto [lowest, highest] = enclosing(ray.z(static_cast<double>(map.min_depth)),
                                           ray.z(static_cast<double>(map.max_depth)), z_depth);
  out.write(lowest);
  out.write(highest);
  const std::string image = relative_image(map.image_path, path);
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

// The counterpart of relative_image.
std::string resolved_image(const std::string& name, const fs::path& dmap) {
  return (fs::absolute(dmap).parent_path() / name).lexically_normal().string();
}

bool is_whole(const std::string& bytes, const std::string& file) {
  try {
    ByteReader in(bytes, file);
    parse_dmap(in);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

StoredDepthMap read_dmap(const fs::path& path, DmapSide use) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  ByteReader in(bytes, file);
  StoredDepthMap stored{parse_dmap(in), {}};
  DepthMap& map = stored.map;
  const auto side = use == DmapSide::used ? read_dmap_side_file(path) : std::nullopt;
  if (side) {
    if (side->content != fingerprint_of(bytes))
      fail("{}: is not the depth map to which {} belongs", file, dmap_side_path(path).string());
    use_side_file(*side, dmap_side_path(path).string(), stored);
  }
  map.image_path = resolved_image(map.image_path, path);
  map.depth = converted(map.depth, map.camera, file,
                        [](const DepthAlongRay& ray, double z) { return ray.lambda(z); });
  if (side) {
    map.min_depth = side->min_depth;
    map.max_depth = side->max_depth;
  } else {
    const DepthAlongRay ray = centre_ray(map.camera);
    std::tie(map.min_depth, map.max_depth) =
        enclosing(ray.lambda(static_cast<double>(map.min_depth)),
                  ray.lambda(static_cast<double>(map.max_depth)), map.depth);
  }
  return stored;
}

DepthMap read_dmap_header(const fs::path& path, DmapSide use) {
  const std::string file = path.string();
  const std::string bytes = read_beginning(path);
  ByteReader in(bytes, file);
  Header header = parse_header(in);
  std::error_code error;
  const std::uint64_t wanted = in.position() + header.bytes_of_pixels();
  if (const std::uint64_t found = fs::file_size(path, error); error || found != wanted)
    fail("{}: has {} bytes, but needs {} according to its header", file, found, wanted);
  StoredDepthMap stored{std::move(header.map), {}};
  if (use == DmapSide::used)
    if (const auto side = read_dmap_side_file(path))
      use_side_file(*side, dmap_side_path(path).string(), stored);
  DepthMap& map = stored.map;
  map.image_path = resolved_image(map.image_path, path);
  const DepthAlongRay ray = centre_ray(map.camera);
  map.min_depth = static_cast<float>(ray.lambda(static_cast<double>(map.min_depth)));
  map.max_depth = static_cast<float>(ray.lambda(static_cast<double>(map.max_depth)));
  return std::move(stored.map);
}

void write_dmap(const fs::path& path, const DepthMap& map, const std::string& made_from) {
  const std::string file = path.string();
  check_map(map, file);
  const cv::Mat1f z_depth =
      converted(map.depth, map.camera, file,
                [](const DepthAlongRay& ray, double lambda) { return ray.z(lambda); });
  ByteWriter out;
  constexpr std::size_t kHeader = 4096;  // more than enough
  out.reserve(kHeader + map.depth.total() * 5 * sizeof(float));
  write_header(out, path, map, z_depth);
  write_pixels(out, z_depth);
  write_pixels(out, map.normal);
  write_pixels(out, map.confidence);
  const DmapSideFile side{map.camera, map.min_depth, map.max_depth, made_from,
                          fingerprint_of(out.bytes())};
  // In this order an interruption never leaves one of our maps beside the side file of another. A
  // map that does not match its side file was therefore written by another program.
  write_atomically(path, [&](const fs::path& temporary) {
    write_atomically(temporary, out.bytes());
    std::error_code ignored;
    fs::remove(path, ignored);
    write_dmap_side_file(path, side);
  });
}

DmapStatus dmap_status(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  if (!fs::is_regular_file(path, ignored) || !fs::exists(dmap_side_path(path), ignored))
    return {DmapOrigin::foreign, {}};
  try {
    const std::string bytes = read_file(path);
    const auto side = read_dmap_side_file(path);
    if (side && side->content == fingerprint_of(bytes)) return {DmapOrigin::ours, side->made_from};
    return {side && is_whole(bytes, path.string()) ? DmapOrigin::foreign : DmapOrigin::damaged, {}};
  } catch (const Error&) {
    return {DmapOrigin::damaged, {}};
  }
}

std::optional<std::string> dmap_made_from(const fs::path& path) {
  const DmapStatus status = dmap_status(path);
  if (status.origin != DmapOrigin::ours) return {};
  return status.made_from;
}

}  // namespace axial::io
