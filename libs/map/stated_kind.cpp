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

}  // namespace

std::string stated_kind(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  if (lower_extension(path) == ".geojson") return kind_of_lines(path);
  const GdalErrors errors;
  const DatasetPtr file(GDALOpen(path.c_str(), GA_ReadOnly));
  const char* kind = file ? GDALGetMetadataItem(file.get(), kKindItem, nullptr) : nullptr;
  return kind == nullptr ? std::string() : std::string(kind);
}

}  // namespace axial::map
