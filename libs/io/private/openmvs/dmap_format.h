// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads and makes the bytes of a .dmap file, without the side file
// (docs/formats.md). In the maps that the functions below read, depths are z-depths, the camera has
// no port, and `image_path` is the name that the file stores.
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

}  // namespace axial::io
