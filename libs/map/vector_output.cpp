// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/vector_output.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>

#include "base/error.h"

namespace axial::map {

DatasetPtr make_vector_file(const char* driver, const std::filesystem::path& file,
                            const GdalErrors& errors) {
  DatasetPtr data(
      GDALCreate(GDALGetDriverByName(driver), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  errors.require_written(data != nullptr, file);
  return data;
}

void require_complete_geojson(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  std::string end(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, 16)), '\0');
  in.seekg(size - static_cast<std::streamoff>(end.size()));
  in.read(end.data(), static_cast<std::streamsize>(end.size()));
  std::erase_if(end, [](unsigned char c) { return std::isspace(c) != 0; });
  if (!in || !end.ends_with("]}"))
    fail_in(file, "cannot be written: only a part of it was written: is the disk full?");
}

}  // namespace axial::map
