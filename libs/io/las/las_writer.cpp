// SPDX-License-Identifier: GPL-3.0-or-later
#include "las/private/las_writer.h"

#include <algorithm>
#include <span>

#include "base/error.h"

namespace axial::io {

LasWriter::LasWriter(const std::filesystem::path& path, const LasLayout& layout,
                     const LasGrid& grid, const std::string& crs)
    : stream_(path), header_{layout, grid, crs} {
  stream_.write(las_header(header_));
}

void LasWriter::add(const LasPoint& point) {
  constexpr std::size_t kBuffer = std::size_t{1} << 20;
  constexpr std::uint8_t kFirstOfOneReturn = 0x11;
  if (!header_.grid.holds(point.position))
    fail_in(stream_.name(), "has no room for the point {} {} {}: did its cloud change meanwhile?",
            point.position.x(), point.position.y(), point.position.z());
  const std::array<std::int32_t, 3> stored = header_.grid.stored(point.position);
  for (std::size_t k = 0; k < 3; ++k) {
    low_[k] = header_.points == 0 ? stored[k] : std::min(low_[k], stored[k]);
    high_[k] = header_.points == 0 ? stored[k] : std::max(high_[k], stored[k]);
  }
  ++header_.points;
  bytes_.write(std::span(stored));
  bytes_.write(std::uint16_t{0});  // intensity
  bytes_.write(kFirstOfOneReturn);
  bytes_.write(std::uint8_t{0});   // flags of the class and of the scanner
  bytes_.write(std::uint8_t{0});   // class: never classified
  bytes_.write(std::uint8_t{0});   // user data
  bytes_.write(std::int16_t{0});   // angle of the scanner
  bytes_.write(std::uint16_t{0});  // point source
  bytes_.write(double{0});         // GPS time
  if (header_.layout.colors)
    for (const std::uint8_t value : point.color)
      bytes_.write(static_cast<std::uint16_t>(value * 257));
  write_extras(point);
  if (bytes_.bytes().size() >= kBuffer) flush();
}

// In the order of the header.
void LasWriter::write_extras(const LasPoint& point) {
  if (header_.layout.normals) bytes_.write(std::span(point.normal.data(), 3));
  if (header_.layout.views) bytes_.write(point.views);
  if (!header_.layout.errors) return;
  bytes_.write(point.error);
  bytes_.write(point.confidence);
}

void LasWriter::flush() {
  stream_.write(bytes_.bytes());
  bytes_.clear();
}

LasHeader LasWriter::header() const {
  LasHeader header = header_;
  header.low = header.grid.world(low_);
  header.high = header.grid.world(high_);
  return header;
}

void LasWriter::finish() {
  flush();
  stream_.finish(las_header(header()));
}

}  // namespace axial::io
