// SPDX-License-Identifier: GPL-3.0-or-later
#include "las/private/las_header.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "bytes/private/byte_writer.h"

namespace axial::io {
namespace {

constexpr double kMostSteps = std::numeric_limits<std::int32_t>::max();
constexpr std::uint16_t kHeaderBytes = 375, kExtraBytes = 192;
constexpr std::uint8_t kFormatWithoutColors = 6, kFormatWithColors = 7;
constexpr std::uint16_t kPointBytes = 30, kColorBytes = 6;
constexpr std::uint16_t kCrsIsWkt = 1 << 4;  // of the global encoding; formats 6 to 10 demand it
constexpr std::uint16_t kCrsRecord = 2112, kExtraBytesRecord = 4;

// The types of extra bytes that are written: their numbers and their sizes.
enum class ExtraType : std::uint8_t { uint16 = 3, float32 = 9 };

struct Extra {
  const char* name;
  const char* description;
  ExtraType type;
  bool zero_is_unknown = false;

  std::size_t bytes() const { return type == ExtraType::uint16 ? 2 : 4; }
};

// The extra bytes of a point, in their order.
std::vector<Extra> extras_of(const LasLayout& layout) {
  std::vector<Extra> extras;
  if (layout.normals)
    for (const char* name : {"NormalX", "NormalY", "NormalZ"})
      extras.push_back({name, "unit normal of the surface", ExtraType::float32});
  if (layout.views) extras.push_back({"Views", "number of photographs", ExtraType::uint16});
  if (!layout.errors) return extras;
  extras.push_back({"Error", "expected error, 1 sigma [m]", ExtraType::float32, true});
  extras.push_back({"Confidence", "probability of error < 3 sigma", ExtraType::float32, true});
  return extras;
}

// A text in a field of `bytes` bytes, filled with zeros. One zero at least ends the text, because
// not all readers stop at the end of a field.
void write_text(ByteWriter& out, std::string_view text, std::size_t bytes) {
  assert(text.size() < bytes);
  std::string field(text);
  field.resize(bytes, '\0');
  out.text(field);
}

void write_zeros(ByteWriter& out, std::size_t bytes) {
  out.text(std::string(bytes, '\0'));
}

void write_record_header(ByteWriter& out, const char* user, std::uint16_t record,
                         std::size_t content, const char* description) {
  write_zeros(out, 2);
  write_text(out, user, 16);
  out.write(record);
  out.write(static_cast<std::uint16_t>(content));
  write_text(out, description, 32);
}

void write_extra(ByteWriter& out, const Extra& extra) {
  const std::uint8_t no_data_is_valid = extra.zero_is_unknown ? 1 : 0;
  write_zeros(out, 2);
  out.write(static_cast<std::uint8_t>(extra.type));
  out.write(no_data_is_valid);
  write_text(out, extra.name, 32);
  write_zeros(out, 4 + 24);  // no_data is 0, as the double that stands for a float
  write_zeros(out, 4 * 24);  // no minimum, maximum, scale and offset are stated
  write_text(out, extra.description, 32);
}

std::string records_of(const LasHeader& header) {
  ByteWriter out;
  if (!header.crs.empty()) {
    write_record_header(out, "LASF_Projection", kCrsRecord, header.crs.size() + 1, "WKT");
    out.text(header.crs);
    write_zeros(out, 1);
  }
  const std::vector<Extra> extras = extras_of(header.layout);
  if (extras.empty()) return out.take();
  write_record_header(out, "LASF_Spec", kExtraBytesRecord, extras.size() * kExtraBytes,
                      "Extra bytes");
  for (const Extra& extra : extras) write_extra(out, extra);
  return out.take();
}

std::uint32_t record_count(const LasHeader& header) {
  return (header.crs.empty() ? 0u : 1u) + (extras_of(header.layout).empty() ? 0u : 1u);
}

// What the file is, and who wrote it.
void write_identity(ByteWriter& out) {
  out.text("LASF");
  write_zeros(out, 2);  // file source
  out.write(kCrsIsWkt);
  write_zeros(out, 16);  // project
  out.write(std::uint8_t{1});
  out.write(std::uint8_t{4});  // LAS 1.4
  write_text(out, "PHOTOGRAMMETRY", 32);
  write_text(out, "AxialMVS", 32);
  write_zeros(out, 4);  // day and year
}

void write_box(ByteWriter& out, const LasHeader& header) {
  for (int repeat = 0; repeat < 3; ++repeat) out.write(header.grid.scale);
  for (Eigen::Index k = 0; k < 3; ++k) out.write(header.grid.offset(k));
  for (Eigen::Index k = 0; k < 3; ++k) {
    out.write(header.high(k));
    out.write(header.low(k));
  }
}

// The counts of older versions are 0, as the formats 6 to 10 demand. All points are first returns.
void write_counts(ByteWriter& out, std::uint64_t points) {
  out.write(points);
  out.write(points);
  write_zeros(out, 14 * 8);
}

}  // namespace

bool LasGrid::holds(const Eigen::Vector3d& x) const {
  // Rounding moves a value by half a step.
  return x.allFinite() && ((x - offset) / scale).cwiseAbs().maxCoeff() + 1 <= kMostSteps;
}

std::array<std::int32_t, 3> LasGrid::stored(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d steps = (x - offset) / scale;
  return {static_cast<std::int32_t>(std::llround(steps.x())),
          static_cast<std::int32_t>(std::llround(steps.y())),
          static_cast<std::int32_t>(std::llround(steps.z()))};
}

Eigen::Vector3d LasGrid::world(const std::array<std::int32_t, 3>& stored) const {
  return Eigen::Vector3d(stored[0], stored[1], stored[2]) * scale + offset;
}

std::optional<LasGrid> las_grid(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  if (!low.allFinite() || !high.allFinite()) return {};
  const Eigen::Vector3d offset = (low / 2 + high / 2).array().round();
  for (const double scale : {1e-6, 1e-5, 1e-4, 1e-3})
    if (const LasGrid grid{offset, scale}; grid.holds(low) && grid.holds(high)) return grid;
  return {};
}

std::size_t bytes_of_point(const LasLayout& layout) {
  std::size_t bytes = kPointBytes + (layout.colors ? kColorBytes : 0);
  for (const Extra& extra : extras_of(layout)) bytes += extra.bytes();
  return bytes;
}

std::string las_header(const LasHeader& header) {
  const std::string records = records_of(header);
  ByteWriter out;
  write_identity(out);
  out.write(kHeaderBytes);
  out.write(static_cast<std::uint32_t>(kHeaderBytes + records.size()));  // where points begin
  out.write(record_count(header));
  out.write(header.layout.colors ? kFormatWithColors : kFormatWithoutColors);
  out.write(static_cast<std::uint16_t>(bytes_of_point(header.layout)));
  write_zeros(out, 4 + 5 * 4);  // counts of older versions
  write_box(out, header);
  write_zeros(out, 8 + 8 + 4);  // no waveforms, and no records behind the points
  write_counts(out, header.points);
  out.text(records);
  return out.take();
}

}  // namespace axial::io
