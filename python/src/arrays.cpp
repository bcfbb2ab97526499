// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/arrays.h"

#include <fmt/format.h>

namespace axial::python {
namespace {

// Whether an array of this kind of dtype (numpy's letter) has real or whole numbers.
bool is_number(char kind, bool whole) {
  return kind == 'i' || kind == 'u' || (!whole && kind == 'f');
}

}  // namespace

std::string shape_text(const Shape& shape) {
  std::string text;
  for (const py::ssize_t size : shape)
    text += (text.empty() ? "" : ", ") + (size == kAny ? "N" : std::to_string(size));
  return fmt::format("({}{})", text, shape.size() == 1 ? "," : "");
}

Shape shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

void require_shape(const py::array& array, const char* name, const Shape& wanted) {
  const Shape shape = shape_of(array);
  bool same = shape.size() == wanted.size();
  for (std::size_t k = 0; same && k < shape.size(); ++k)
    same = wanted[k] == kAny || shape[k] == wanted[k];
  if (!same)
    throw py::value_error(fmt::format("{}: has the shape {}, but must have {}", name,
                                      shape_text(shape), shape_text(wanted)));
}

py::array numbers(const py::object& value, const char* name, bool whole) {
  const py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(fmt::format("{}: is no array of numbers", name));
  }
  // An empty list has no dtype of its own.
  if (!is_number(array.dtype().kind(), whole) && array.size() > 0)
    throw py::type_error(fmt::format("{}: has the dtype {}, but must have {} numbers", name,
                                     py::str(array.dtype()).cast<std::string>(),
                                     whole ? "whole" : "real"));
  return array;
}

void require_range(const py::array& array, const char* name, const py::int_& low,
                   const py::int_& high) {
  if (array.size() == 0) return;
  const auto text = [](py::handle number) { return py::str(number).cast<std::string>(); };
  for (const char* end : {"min", "max"}) {
    const py::object value = array.attr(end)();
    if (value < low || value > high)
      throw py::value_error(
          fmt::format("{}: has the number {}, but must have numbers from {} to {}", name,
                      text(value), text(low), text(high)));
  }
}

Eigen::Vector3d vector_argument(const py::object& value, const char* name) {
  return Eigen::Map<const Eigen::Vector3d>(array_argument<double>(value, name, {3}).data());
}

Eigen::Matrix3d matrix_argument(const py::object& value, const char* name) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array_argument<double>(value, name, {3, 3}).data());
}

Array<double> to_array(const Eigen::Vector3d& vector) {
  return Array<double>(3, vector.data());
}

Array<double> to_array(const Eigen::Matrix3d& matrix) {
  Array<double> array({3, 3});
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(array.mutable_data()) = matrix;
  return array;
}

py::object to_array(const cv::Mat& image) {
  if (image.empty()) return py::none();
  auto kept = std::make_unique<cv::Mat>(image.isContinuous() ? image : image.clone());
  Shape shape{kept->rows, kept->cols};
  if (kept->channels() > 1) shape.push_back(kept->channels());
  const void* data = kept->data;
  const int depth = kept->depth();
  const py::capsule owner(kept.release(), [](void* of) { delete static_cast<cv::Mat*>(of); });
  switch (depth) {
    case CV_8U:
      return Array<std::uint8_t>(shape, static_cast<const std::uint8_t*>(data), owner);
    case CV_16U:
      return Array<std::uint16_t>(shape, static_cast<const std::uint16_t*>(data), owner);
    default:
      return Array<float>(shape, static_cast<const float*>(data), owner);
  }
}

}  // namespace axial::python
