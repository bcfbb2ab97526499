// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the parts of the reader and the writer of depth maps (docs/formats.md): the
// depths, the bytes of a .dmap file, and the file beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>

#include "bytes/private/byte_reader.h"
#include "bytes/private/byte_writer.h"
#include "bytes/private/only_for_io.h"
#include "scene/camera_model.h"
#include "scene/depth_map.h"

namespace axial::io {

// Z-depth is the depth in .dmap files. Lambda is the distance along the ray of a pixel (DepthMap).

// One ray in the camera frame: z = o_z + lambda d_z.
struct DepthAlongRay {
  double origin_z, direction_z;

  double z(double lambda) const { return origin_z + lambda * direction_z; }
  double lambda(double z_depth) const { return (z_depth - origin_z) / direction_z; }
};

// The ray of the image centre.
DepthAlongRay centre_ray(const CameraModel& camera);

// z_depth_of converts a map of lambda to z-depth. lambda_of converts a map of z-depth to lambda.
// The value 0 means no depth and stays 0. Error that starts with `file` if another value or its
// result is not finite or not positive.
cv::Mat1f z_depth_of(const cv::Mat1f& lambda, const CameraModel& camera, const std::string& file);
cv::Mat1f lambda_of(const cv::Mat1f& z_depth, const CameraModel& camera, const std::string& file);

// Returns the range [low, high], extended so that it contains all positive values of `depth`.
std::pair<float, float> enclosing(double low, double high, const cv::Mat1f& depth);

// In the maps that the functions below read, depths are z-depths, the camera has no port, and
// `image_path` is the name that the file stores.
struct DmapHeader {
  DepthMap map;              // without pixels; the camera is at the depth map's resolution
  std::uint8_t content = 0;  // flags of the pixel arrays that follow the header

  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(map.camera.width) *
           static_cast<std::uint64_t>(map.camera.height);
  }
  std::uint64_t bytes_of_pixels() const;
};

// Parses the header. Error that names the file for a truncated or malformed header.
DmapHeader parse_dmap_header(ByteReader& in);

// Parses a whole file. Errors as for parse_dmap_header, and an Error for pixels that are not
// finite, too few bytes, or too many bytes.
DepthMap parse_dmap(ByteReader& in);

// Returns the bytes of a file. `map` gives the normals, confidences, ids, lens and pose. `z_depth`
// gives the depths and `range` their smallest and largest value. `image` is the name of the image
// to store. The caller must check that `image` has at most 65535 bytes.
ByteWriter format_dmap(const DepthMap& map, const cv::Mat1f& z_depth,
                       const std::pair<float, float>& range, const std::string& image);

struct DmapSideFile {
  CameraModel camera;                  // at the depth map's resolution
  float min_depth = 0, max_depth = 0;  // lambda [m]
  std::string made_from;
  std::string content;  // Fingerprint of the .dmap's bytes
};

// Reads the side file of the depth map `dmap`. Returns nothing if there is no side file. Error if
// the side file is malformed.
std::optional<DmapSideFile> read_dmap_side_file(const std::filesystem::path& dmap,
                                                const Context& context);

void write_dmap_side_file(const std::filesystem::path& dmap, const DmapSideFile& side);

}  // namespace axial::io
