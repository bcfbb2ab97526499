// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of numpy as arguments and as results. An argument that is already an array of the wanted
// type and order is used where it lies. Errors name the argument, its shape or its dtype.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace axial::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

// Whole numbers of a shape; kAny stands for any number.
inline constexpr py::ssize_t kAny = -1;
using Shape = std::vector<py::ssize_t>;

// "(3, 2)", and "(N, 2)" for kAny.
std::string shape_text(const Shape& shape);
Shape shape_of(const py::array& array);

// Throws a ValueError unless `array` has the shape `wanted`.
void require_shape(const py::array& array, const char* name, const Shape& wanted);

// `value` as an array of numpy. Throws a TypeError if it is no array, or not one of real numbers
// (`whole`: of whole numbers) that all are of the type `kind` without loss of their kind.
py::array numbers(const py::object& value, const char* name, bool whole);

// Throws a ValueError unless all numbers of `array` are from `low` to `high`.
void require_range(const py::array& array, const char* name, const py::int_& low,
                   const py::int_& high);

// The argument `name` as an array of T with the shape `wanted`. Real numbers may be of any type,
// and become T. Whole numbers must be of a type of whole numbers. Throws a TypeError or a
// ValueError.
template <class T>
Array<T> array_argument(const py::object& value, const char* name, const Shape& wanted) {
  const py::array given = numbers(value, name, std::is_integral_v<T>);
  require_shape(given, name, wanted);
  if constexpr (std::is_integral_v<T>)
    require_range(given, name, py::int_(std::numeric_limits<T>::min()),
                  py::int_(std::numeric_limits<T>::max()));
  return Array<T>(given);
}

// The same for one vector.
Eigen::Vector3d vector_argument(const py::object& value, const char* name);
Eigen::Matrix3d matrix_argument(const py::object& value, const char* name);

// Copies.
Array<double> to_array(const Eigen::Vector3d& vector);
Array<double> to_array(const Eigen::Matrix3d& matrix);

// The numbers of an item of a vector: its type, and how many.
template <class Item>
struct Numbers {
  using Type = Item;
  static constexpr py::ssize_t kCount = 0;  // a number itself
};
template <class T, int N>
struct Numbers<Eigen::Matrix<T, N, 1>> {
  using Type = T;
  static constexpr py::ssize_t kCount = N;
};
template <class T, std::size_t N>
struct Numbers<std::array<T, N>> {
  using Type = T;
  static constexpr py::ssize_t kCount = N;
};

template <class T, int N, std::size_t Count>
struct Numbers<std::array<Eigen::Matrix<T, N, 1>, Count>> {
  using Type = T;
  static constexpr py::ssize_t kCount = N * static_cast<py::ssize_t>(Count);
};

// The numbers of `items` as an array, which takes the memory of `items`: shape (size,) or
// (size, kCount).
template <class Item>
py::array to_array(std::vector<Item> items) {
  using Of = Numbers<Item>;
  auto kept = std::make_unique<std::vector<Item>>(std::move(items));
  Shape shape{static_cast<py::ssize_t>(kept->size())};
  if (Of::kCount > 0) shape.push_back(Of::kCount);
  const void* data = kept->data();
  const py::capsule owner(kept.release(),
                          [](void* of) { delete static_cast<std::vector<Item>*>(of); });
  return Array<typename Of::Type>(shape, static_cast<const typename Of::Type*>(data), owner);
}

// The items of the argument `name`, of the shape (size,) or (size, kCount). None: no items.
template <class Item>
std::vector<Item> items_argument(const py::object& value, const char* name) {
  using Of = Numbers<Item>;
  using T = typename Of::Type;
  if (value.is_none()) return {};
  const Array<T> array =
      array_argument<T>(value, name, Of::kCount > 0 ? Shape{kAny, Of::kCount} : Shape{kAny});
  std::vector<Item> items(static_cast<std::size_t>(array.shape(0)));
  std::copy_n(array.data(), array.size(), reinterpret_cast<T*>(items.data()));
  return items;
}

// The pixels of `image`, which share its memory: shape (rows, columns) or (rows, columns,
// channels). None for an empty image.
py::object to_array(const cv::Mat& image);

// A copy of the argument `name`: of the shape (rows, columns) for one channel, otherwise (rows,
// columns, channels). None: an empty image.
template <class Pixel>
cv::Mat_<Pixel> image_argument(const py::object& value, const char* name) {
  using T = typename cv::DataType<Pixel>::channel_type;
  constexpr int kChannels = cv::DataType<Pixel>::channels;
  if (value.is_none()) return {};
  Shape wanted{kAny, kAny};
  if (kChannels > 1) wanted.push_back(kChannels);
  const Array<T> array = array_argument<T>(value, name, wanted);
  cv::Mat_<Pixel> image(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)));
  std::copy_n(array.data(), array.size(), reinterpret_cast<T*>(image.data));
  return image;
}

}  // namespace axial::python
