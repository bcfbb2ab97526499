// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/dmap.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <tuple>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "io/artifacts/artifact.h"
#include "openmvs/private/dmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Reads the beginning of a file, which is long enough for every header.
std::string read_beginning(const fs::path& path) {
  constexpr std::streamsize kLongestHeader = 1 << 18;  // names have at most 65535 bytes
  std::error_code ignored;
  // To open a pipe would wait for its writer.
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored))
    fail_in(path, "is not a regular file");
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kLongestHeader, '\0');
  in.read(bytes.data(), kLongestHeader);
  if (in.bad() || (in.fail() && !in.eof())) fail_in(path, "cannot be read");
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

void use_side_file(const DmapSideFile& side, const std::string& file, StoredDepthMap& stored) {
  const CameraModel& in_file = stored.map.camera;
  if (side.camera.width != in_file.width || side.camera.height != in_file.height)
    fail_in(file, "is for {}x{} pixels, but the depth map has {}x{}", side.camera.width,
            side.camera.height, in_file.width, in_file.height);
  const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-3; };
  if (differ(side.camera.lens.fx, in_file.lens.fx) ||
      differ(side.camera.lens.fy, in_file.lens.fy) ||
      differ(side.camera.lens.cx, in_file.lens.cx) || differ(side.camera.lens.cy, in_file.lens.cy))
    fail_in(file, "its lens is not the K of the depth map");
  stored.map.camera = side.camera;
  stored.made_from = side.made_from;
}

std::string fingerprint_of(const std::string& bytes) {
  return Fingerprint().add(bytes).hex();
}

void check_map(const DepthMap& map, const std::string& file) {
  const cv::Size size = map.depth.size();
  if (map.depth.empty()) fail_in(file, "the depth map is empty");
  if (size != cv::Size(map.camera.width, map.camera.height))
    fail_in(file, "the depth map is {}x{}, but its camera is {}x{}", size.width, size.height,
            map.camera.width, map.camera.height);
  if ((!map.normal.empty() && map.normal.size() != size) ||
      (!map.confidence.empty() && map.confidence.size() != size))
    fail_in(file, "normals or confidences have another size than the depths");
  if (map.ids.empty()) fail_in(file, "the depth map has no ids");
}

// The image's path relative to the folder of the .dmap, as OpenMVS stores it.
std::string relative_image(const std::string& image, const fs::path& dmap) {
  const fs::path relative =
      fs::absolute(image).lexically_proximate(fs::absolute(dmap).parent_path());
  const std::string name = relative.generic_string();
  if (name.size() > std::numeric_limits<std::uint16_t>::max())
    fail_in(dmap, "the image name has {} bytes, at most 65535 are possible", name.size());
  return name;
}

// Converts the depth range of the header from z-depth to lambda.
std::pair<float, float> range_along_ray(const DepthMap& map, const std::string& file) {
  const DepthAlongRay ray = centre_ray(map.camera);
  const auto low = static_cast<float>(ray.lambda(static_cast<double>(map.min_depth)));
  const auto high = static_cast<float>(ray.lambda(static_cast<double>(map.max_depth)));
  if (!std::isfinite(low) || !std::isfinite(high))
    fail_in(file, "the depth range is {} to {} along the ray of the image centre", low, high);
  return {low, high};
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

StoredDepthMap read_dmap(const fs::path& path, DmapSide use, const Context& context) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  ByteReader in(bytes, file);
  StoredDepthMap stored{parse_dmap(in), {}};
  DepthMap& map = stored.map;
  const auto side = use == DmapSide::used ? read_dmap_side_file(path, context) : std::nullopt;
  if (side) {
    if (side->content != fingerprint_of(bytes))
      fail_in(file, "is not the depth map to which {} belongs", side_file(path).string());
    use_side_file(*side, side_file(path).string(), stored);
  }
  map.image_path = resolved_image(map.image_path, path);
  map.depth = lambda_of(map.depth, map.camera, file);
  if (side) {
    map.min_depth = side->min_depth;
    map.max_depth = side->max_depth;
  } else {
    const auto [low, high] = range_along_ray(map, file);
    std::tie(map.min_depth, map.max_depth) =
        enclosing(static_cast<double>(low), static_cast<double>(high), map.depth);
  }
  return stored;
}

DepthMap read_dmap_header(const fs::path& path, DmapSide use, const Context& context) {
  const std::string file = path.string();
  const std::string bytes = read_beginning(path);
  ByteReader in(bytes, file);
  DmapHeader header = parse_dmap_header(in);
  std::error_code error;
  const std::uint64_t wanted = in.position() + header.bytes_of_pixels();
  if (const std::uint64_t found = fs::file_size(path, error); error || found != wanted)
    fail_in(file, "has {} bytes, but needs {} according to its header", found, wanted);
  StoredDepthMap stored{std::move(header.map), {}};
  if (use == DmapSide::used)
    if (const auto side = read_dmap_side_file(path, context))
      use_side_file(*side, side_file(path).string(), stored);
  DepthMap& map = stored.map;
  map.image_path = resolved_image(map.image_path, path);
  std::tie(map.min_depth, map.max_depth) = range_along_ray(map, file);
  return std::move(stored.map);
}

void write_dmap(const fs::path& path, const DepthMap& map, const std::string& made_from) {
  const std::string file = path.string();
  check_map(map, file);
  const cv::Mat1f z_depth = z_depth_of(map.depth, map.camera, file);
  const DepthAlongRay ray = centre_ray(map.camera);
  const auto range = enclosing(ray.z(static_cast<double>(map.min_depth)),
                               ray.z(static_cast<double>(map.max_depth)), z_depth);
  const ByteWriter out = format_dmap(map, z_depth, range, relative_image(map.image_path, path));
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

DmapStatus dmap_status(const fs::path& path, const Context& context) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  if (!fs::is_regular_file(path, ignored) || !fs::exists(side_file(path), ignored))
    return {DmapOrigin::foreign, {}};
  try {
    const std::string bytes = read_file(path);
    const auto side = read_dmap_side_file(path, context);
    if (side && side->content == fingerprint_of(bytes)) return {DmapOrigin::ours, side->made_from};
    return {side && is_whole(bytes, path.string()) ? DmapOrigin::foreign : DmapOrigin::damaged, {}};
  } catch (const Error&) {
    return {DmapOrigin::damaged, {}};
  }
}

}  // namespace axial::io
