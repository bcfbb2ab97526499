// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/stated_kind.h"

#include <fstream>
#include <system_error>

#include "base/file_extension.h"
#include "private/gdal_calls.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

// GDAL writes the description before the first line. The rest of the file may be large.
std::string kind_of_lines(const fs::path& path) {
  constexpr std::size_t kBegin = 4096;
  std::string begin(kBegin, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(begin.data(), kBegin);
  begin.resize(static_cast<std::size_t>(in.gcount()));
  const std::string mark = std::string("\"description\": \"") + kKindItem + " ";
  const std::size_t at = begin.find(mark);
  if (at == std::string::npos) return {};
  const std::size_t from = at + mark.size();
  return begin.substr(from, begin.find('"', from) - from);
}

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

// The description of the first layer.
std::string kind_of_package(const fs::path& path) {
  const GdalErrors errors;
  const DatasetPtr file(
      GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!file || GDALDatasetGetLayerCount(file.get()) == 0) return {};
  const std::string found =
      text_of(GDALGetMetadataItem(GDALDatasetGetLayer(file.get(), 0), "DESCRIPTION", nullptr));
  const std::string mark = std::string(kKindItem) + " ";
  return found.starts_with(mark) ? found.substr(mark.size()) : std::string();
}

std::string item_of(const fs::path& path, const char* item) {
  const GdalErrors errors;
  const DatasetPtr file(GDALOpen(path.c_str(), GA_ReadOnly));
  return file ? text_of(GDALGetMetadataItem(file.get(), item, nullptr)) : std::string();
}

}  // namespace

std::string stated_kind(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  if (lower_extension(path) == ".geojson") return kind_of_lines(path);
  if (lower_extension(path) == ".gpkg") return kind_of_package(path);
  return item_of(path, kKindItem);
}

std::string stated_source(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? item_of(path, kCopyItem) : std::string();
}

}  // namespace axial::map
