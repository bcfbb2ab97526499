// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the bytes of a .dmap file, without its side file (docs/formats.md). Depths
// here are z-depths as in the file, the camera has no port, and the image's name is that in the
// file.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "private/bytes/byte_reader.h"
#include "private/bytes/byte_writer.h"
#include "private/only_for_io.h"
#include "scene/depth_map.h"

namespace axial::io {

struct DmapHeader {
  DepthMap map;              // without pixels; the camera has the depth map's resolution
  std::uint8_t content = 0;  // which images follow

  std::uint64_t pixels() const {
    return static_cast<std::uint64_t>(map.camera.width) *
           static_cast<std::uint64_t>(map.camera.height);
  }
  std::uint64_t bytes_of_pixels() const;
};

// Error that names the file for a truncated or malformed header.
DmapHeader parse_dmap_header(ByteReader& in);

// Parses a whole file. Errors as for parse_dmap_header, and for pixels that are not finite or too
// few or too many bytes.
DepthMap parse_dmap(ByteReader& in);

// Returns the bytes of a file with the normals, confidences, ids, lens and pose of `map`. `image`
// is the name in the file, at most 65535 bytes, and `range` that of the z-depths.
ByteWriter format_dmap(const DepthMap& map, const cv::Mat1f& z_depth,
                       const std::pair<float, float>& range, const std::string& image);

}  // namespace axial::io
