// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the rows of the elements of a PLY file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "private/only_for_io.h"
#include "private/ply/ply_header.h"
#include "scene/local_frame.h"
#include "scene/point_cloud.h"

namespace axial::io {

inline constexpr std::size_t kNoProperty = std::numeric_limits<std::size_t>::max();

// The index of the property with this name, or kNoProperty. `list`: whether the property is a list.
std::size_t find_property(const PlyElement& element, const std::string& name, bool list);

// The first element with this name, or null.
const PlyElement* find_element(const PlyHeader& header, const std::string& name);

// Reads a list. `into`: receives the values; null: the list is skipped.
void read_list(PlyBody& body, const PlyProperty& property, std::vector<double>* into);

// Skips one row, or all rows of an element.
void skip_row(PlyBody& body, const PlyElement& element);
void skip_rows(PlyBody& body, const PlyElement& element);

// `value` as an index. Error that names the file, the field and the row if it is none.
std::uint32_t as_index(double value, const char* field, std::size_t row, const std::string& file);

// The shift of the stored positions into `frame`. Nothing if `frame` is null, or if the positions
// stay as stored.
std::optional<Eigen::Vector3d> shift_into(const LocalFrame* frame, const PlyHeader& header);

// Reads the rows of the element vertex into clouds.
class VertexRows {
 public:
  // `shift` is added to all positions. Error that names the file if x, y or z is missing.
  VertexRows(const PlyElement& element, std::string file,
             const std::optional<Eigen::Vector3d>& shift);

  // A cloud without points that has the arrays of the element's properties.
  PointCloud empty_cloud() const;

  // Reads the next row and appends it to `cloud`, which empty_cloud() returned. Error that names
  // the file and the row if a position or a normal is not finite, or if the views are malformed.
  void read(PlyBody& body, PointCloud& cloud);

  // The position in the row that was read last, as stored.
  Eigen::Vector3d stored_position() const { return numbers(kX); }

 private:
  // The slots of a row that receive the values of properties.
  enum Slot : std::size_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kSlots };
  static constexpr std::array<const char*, kSlots> kNames{"x",  "y",   "z",     "nx",  "ny",
                                                          "nz", "red", "green", "blue"};

  bool has(Slot first) const { return has_[first] && has_[first + 1] && has_[first + 2]; }
  bool has_views() const { return indices_at_ != kNoProperty; }
  bool has_weights() const { return weights_at_ != kNoProperty; }
  Eigen::Vector3d numbers(Slot first) const {
    return {values_[first], values_[first + 1], values_[first + 2]};
  }
  void read_values(PlyBody& body);
  Rgb color() const;
  void append_views(PointCloud& cloud) const;

  const PlyElement& element_;
  std::string file_;
  std::optional<Eigen::Vector3d> shift_;
  std::vector<std::size_t> slot_of_;  // indexed by property
  std::array<bool, kSlots> has_{};
  std::array<double, kSlots> values_{};
  std::size_t indices_at_ = kNoProperty, weights_at_ = kNoProperty;
  std::vector<double> indices_, weights_;  // lists of the last row
  std::size_t row_ = 0;                    // number of rows read
};

}  // namespace axial::io
