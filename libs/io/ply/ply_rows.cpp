// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply/private/ply_rows.h"

#include <cmath>

#include "base/error.h"

namespace axial::io {
namespace {

template <class Vector>
void require_finite(const Vector& v, const char* field, std::size_t row, const std::string& file) {
  if (!v.allFinite()) fail_in(file, "vertex {} has a {} that is not finite", row, field);
}

}  // namespace

std::size_t find_property(const PlyElement& element, const std::string& name, bool list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name && element.properties[i].is_list == list) return i;
  return kNoProperty;
}

const PlyElement* find_element(const PlyHeader& header, const std::string& name) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

bool PlyRows::store(const std::string& name, double& value) {
  const std::size_t at = find_property(element_, name, false);
  if (at != kNoProperty) targets_[at].value = &value;
  return at != kNoProperty;
}

bool PlyRows::store(const std::string& name, std::vector<double>& values) {
  const std::size_t at = find_property(element_, name, true);
  if (at != kNoProperty) targets_[at].values = &values;
  return at != kNoProperty;
}

void PlyRows::read(PlyBody& body) const {
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const PlyProperty& property = element_.properties[i];
    const auto& [to, list] = targets_[i];
    const std::size_t values = property.is_list ? body.list_size(property) : 1;
    if (list) list->clear();
    for (std::size_t k = 0; k < values; ++k) {
      const double value = body.scalar(property.type, property.name);
      if (to) *to = value;
      if (list) list->push_back(value);
    }
  }
}

void skip_rows(PlyBody& body, const PlyElement& element) {
  body.require_rows(element);
  const PlyRows rows(element);
  for (std::uint64_t i = 0; i < element.count; ++i) rows.read(body);
}

std::uint32_t as_index(double value, const char* field, std::size_t row, const std::string& file) {
  if (!(value >= 0 && value <= 4294967295.0) || value != std::trunc(value))
    fail_in(file, "{} of row {} contains {}, which is not an index", field, row, value);
  return static_cast<std::uint32_t>(value);
}

std::optional<Eigen::Vector3d> shift_into(const LocalFrame* frame, const PlyHeader& header) {
  if (!frame) return {};
  const Eigen::Vector3d shift = header.geo_offset.value_or(Eigen::Vector3d::Zero()) - frame->origin;
  if (shift.isZero(0)) return {};
  return shift;
}

VertexRows::VertexRows(const PlyElement& element, std::string file,
                       const std::optional<Eigen::Vector3d>& shift)
    : file_(std::move(file)), shift_(shift), rows_(element) {
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    const std::string name = kNames[slot];
    has_[slot] = rows_.store(name, values_[slot]) ||
                 (slot >= kRed && slot <= kBlue && rows_.store("diffuse_" + name, values_[slot]));
  }
  has_views_ = rows_.store("view_indices", indices_);
  has_weights_ = rows_.store("view_weights", weights_);
  if (!has(kX)) fail_in(file_, "element vertex has no x, y or z");
}

PointCloud VertexRows::empty_cloud() const {
  PointCloud cloud;
  if (has_views_) cloud.view_begin.push_back(0);
  return cloud;
}

// Integer colours are in 0..255; some writers store floats in [0, 255]. Values outside are clamped.
Rgb VertexRows::color() const {
  Rgb rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = values_[kRed + c];
    rgb[c] = static_cast<std::uint8_t>(value >= 0 && value <= 255 ? value : value > 255 ? 255 : 0);
  }
  return rgb;
}

void VertexRows::append_views(PointCloud& cloud) const {
  for (const double value : indices_)
    cloud.view_images.push_back(as_index(value, "view_indices", row(), file_));
  if (has_weights_)
    for (const double value : weights_) cloud.view_weights.push_back(static_cast<float>(value));
  cloud.view_begin.push_back(cloud.view_images.size());
}

void VertexRows::read(PlyBody& body) {
  rows_.read(body);
  ++rows_read_;
  require_finite(stored_position(), "position", row(), file_);
  if (has_normals()) require_finite(stored_normal(), "normal", row(), file_);
  if (has_views_ && has_weights_ && weights_.size() != indices_.size())
    fail_in(file_, "vertex {} has {} view_indices but {} view_weights", row(), indices_.size(),
            weights_.size());
}

void VertexRows::read(PlyBody& body, PointCloud& cloud) {
  read(body);
  cloud.positions.push_back((shift_ ? (numbers(kX) + *shift_).eval() : numbers(kX)).cast<float>());
  require_finite(cloud.positions.back(), "position", row(), file_);
  if (has_normals()) {
    cloud.normals.emplace_back(stored_normal().cast<float>());
    require_finite(cloud.normals.back(), "normal", row(), file_);
  }
  if (has_colors()) cloud.colors.push_back(color());
  if (has_views_) append_views(cloud);
}

}  // namespace axial::io
