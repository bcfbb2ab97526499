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

#include "bytes/private/only_for_io.h"
#include "ply/private/ply_header.h"
#include "scene/local_frame.h"
#include "scene/point_cloud.h"

namespace axial::io {

inline constexpr std::size_t kNoProperty = std::numeric_limits<std::size_t>::max();

// The index of the property with this name, or kNoProperty. `list`: whether the property is a list.
std::size_t find_property(const PlyElement& element, const std::string& name, bool list);

// The first element with this name, or null.
const PlyElement* find_element(const PlyHeader& header, const std::string& name);

// Reads the rows of an element, one after the other. The properties of interest are stored where
// the caller wants them, and the other properties are skipped.
class PlyRows {
 public:
  // `element` must outlive the object.
  explicit PlyRows(const PlyElement& element)
      : element_(element), targets_(element.properties.size()) {}

  // Stores the property `name`, a scalar or a list, of each row that is read from now on. Returns
  // false if the element has no such property. The target must outlive the object.
  bool store(const std::string& name, double& value);
  bool store(const std::string& name, std::vector<double>& values);

  void read(PlyBody& body) const;

 private:
  struct Target {
    double* value = nullptr;
    std::vector<double>* values = nullptr;
  };
  const PlyElement& element_;
  std::vector<Target> targets_;  // of each property; null: skipped
};

// Skips all rows of an element.
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
  VertexRows(const VertexRows&) = delete;  // `rows_` refers to the members

  // A cloud without points that has the arrays of the element's properties.
  PointCloud empty_cloud() const;

  // Reads the next row. Error that names the file and the row if a position or a normal is not
  // finite, or if there is not one weight for each view.
  void read(PlyBody& body);

  // Reads the next row and appends it to `cloud`, which empty_cloud() returned. Errors as for the
  // function above, also for numbers that are not finite as float and for views that are no
  // indices.
  void read(PlyBody& body, PointCloud& cloud);

  // Whether the rows have these properties; errors: both error and confidence.
  bool has_normals() const { return has(kNx); }
  bool has_colors() const { return has(kRed); }
  bool has_views() const { return has_views_; }
  bool has_errors() const { return has_[kError] && has_[kConfidence]; }

  // The values of the row that was read last, if the rows have these properties. Numbers are those
  // of the file, without the shift; colours are clamped to 0 to 255.
  Eigen::Vector3d stored_position() const { return numbers(kX); }
  Eigen::Vector3d stored_normal() const { return numbers(kNx); }
  Rgb color() const;
  std::size_t view_count() const { return indices_.size(); }
  double error() const { return values_[kError]; }
  double confidence() const { return values_[kConfidence]; }

 private:
  // The slots of a row that receive the values of properties.
  enum Slot : std::size_t {
    kX,
    kY,
    kZ,
    kNx,
    kNy,
    kNz,
    kRed,
    kGreen,
    kBlue,
    kError,
    kConfidence,
    kSlots
  };
  static constexpr std::array<const char*, kSlots> kNames{
      "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "error", "confidence"};

  bool has(Slot first) const { return has_[first] && has_[first + 1] && has_[first + 2]; }
  Eigen::Vector3d numbers(Slot first) const {
    return {values_[first], values_[first + 1], values_[first + 2]};
  }
  std::size_t row() const { return rows_read_ - 1; }  // index of the row that was read last
  void append_views(PointCloud& cloud) const;

  std::string file_;
  std::optional<Eigen::Vector3d> shift_;
  PlyRows rows_;
  std::array<bool, kSlots> has_{};
  std::array<double, kSlots> values_{};
  std::vector<double> indices_, weights_;  // lists of the last row
  bool has_views_ = false, has_weights_ = false;
  std::size_t rows_read_ = 0;
};

}  // namespace axial::io
