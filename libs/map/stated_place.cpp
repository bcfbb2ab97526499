// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/stated_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/map_metadata.h"

namespace axial::map {
namespace {

constexpr const char* kAxes = "AXIALMVS_AXES";
constexpr const char* kOffset = "AXIALMVS_OFFSET";

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// The numbers of a metadata item; empty without the item.
std::vector<double> numbers_in(GDALDatasetH file, const char* item, std::size_t count,
                               const std::filesystem::path& path) {
  const char* text = GDALGetMetadataItem(file, item, nullptr);
  if (text == nullptr) return {};
  std::istringstream words(text);
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  if (!words.eof() || numbers.size() != count)
    fail_in(path, "{} {}: must be {} numbers", item, text, count);
  return numbers;
}

}  // namespace

void state_axes(GDALDatasetH file, const WorldAxes& axes) {
  const RowMajor rows = axes.axes;
  const auto text = [](const double* values, int count) {
    return fmt::format("{}", fmt::join(values, values + count, " "));
  };
  GDALSetMetadataItem(file, kAxes, text(rows.data(), 9).c_str(), nullptr);
  GDALSetMetadataItem(file, kOffset, text(axes.offset.data(), 3).c_str(), nullptr);
}

std::optional<WorldAxes> axes_in(GDALDatasetH file, const std::filesystem::path& path) {
  const std::vector<double> axes = numbers_in(file, kAxes, 9, path);
  const std::vector<double> offset = numbers_in(file, kOffset, 3, path);
  if (axes.empty() || offset.empty()) return {};
  WorldAxes result{Eigen::Map<const RowMajor>(axes.data()),
                   Eigen::Map<const Eigen::Vector3d>(offset.data())};
  if (!(is_rotation(result.axes) && result.offset.allFinite()))
    fail_in(path, "{}: is no rotation", kAxes);
  return result;
}

StatedPlace stated_place(const std::filesystem::path& path) {
  const GdalErrors errors;
  const DatasetPtr file = open_map(path, errors);
  return {axes_in(file.get(), path), GDALGetProjectionRef(file.get())};
}

}  // namespace axial::map
