// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: writes a LAS 1.4 file of any size, point by point.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "axial/scene.h"
#include "bytes/private/atomic_stream.h"
#include "bytes/private/byte_writer.h"
#include "bytes/private/only_for_io.h"
#include "las/private/las_header.h"

namespace axial::io {

// The fields that the layout of the file lacks are not written.
struct LasPoint {
  Eigen::Vector3d position;  // [world]
  Rgb color{};
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::uint16_t views = 0;
  float error = 0, confidence = 0;
};

// The point data record format is 7, or 6 without colours. Every point is the only return of its
// pulse, has no class and the time 0. Colours are multiplied by 257, so that 255 becomes 65535.
class LasWriter {
 public:
  // Opens a temporary file. Error if it cannot be written. `crs`: WKT, at most LasHeader::kMostCrs
  // bytes; empty: none.
  LasWriter(const std::filesystem::path& path, const LasLayout& layout, const LasGrid& grid,
            const std::string& crs);

  // Error if the position does not fit the grid, and if the file cannot be written.
  void add(const LasPoint& point);

  // Writes the number of points and the box of their stored positions into the header, and renames
  // the file. Call it once. Error if the file cannot be written.
  void finish();

  // As finish() writes it; without points, the box is the offset.
  LasHeader header() const;

 private:
  void write_extras(const LasPoint& point);
  void flush();

  AtomicStream stream_;
  LasHeader header_;
  std::array<std::int32_t, 3> low_{}, high_{};
  ByteWriter bytes_;
};

}  // namespace axial::io
