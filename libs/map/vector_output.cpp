// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/vector_output.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>

#include "base/error.h"

namespace axial::map {
namespace {

// Error if the file, without blanks, does not end in `words`: GDAL does not notice every failed
// write.
void require_end(const std::filesystem::path& file, std::string_view words) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(in.tellg());
  std::string end(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, 16)), '\0');
  in.seekg(size - static_cast<std::streamoff>(end.size()));
  in.read(end.data(), static_cast<std::streamsize>(end.size()));
  std::erase_if(end, [](unsigned char c) { return std::isspace(c) != 0; });
  if (!in || !end.ends_with(words))
    fail_in(file, "cannot be written: only a part of it was written: is the disk full?");
}

}  // namespace

DatasetPtr make_vector_file(const char* driver, const std::filesystem::path& file,
                            const GdalErrors& errors) {
  DatasetPtr data(
      GDALCreate(GDALGetDriverByName(driver), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  errors.require_written(data != nullptr, file);
  return data;
}

void write_drawing(const std::filesystem::path& package, const char* layer,
                   const std::filesystem::path& file) {
  const GdalErrors errors;
  const DatasetPtr lines = open_vectors(package, errors);
  const OGRLayerH from = GDALDatasetGetLayer(lines.get(), 0);
  // GDAL keeps the lines in a file until it closes the drawing, and removes the file then.
  const std::string folder = file.parent_path().string();
  const GdalSetting beside("CPL_TMPDIR", folder.empty() ? "." : folder.c_str());
  DatasetPtr drawing = make_vector_file("DXF", file, errors);
  const OGRLayerH to =
      GDALDatasetCreateLayer(drawing.get(), "entities", nullptr, wkbUnknown, nullptr);
  errors.require_written(to != nullptr, file);
  const int name = OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(to), "Layer");
  bool works = name >= 0;
  OGR_L_ResetReading(from);
  while (const Feature line{OGR_L_GetNextFeature(from)}) {
    if (OGR_F_GetGeometryRef(line.get()) == nullptr) continue;
    const Feature drawn(OGR_F_Create(OGR_L_GetLayerDefn(to)));
    OGR_F_SetFieldString(drawn.get(), name, layer);
    works =
        works && OGR_F_SetGeometry(drawn.get(), OGR_F_GetGeometryRef(line.get())) == OGRERR_NONE;
    works = works && OGR_L_CreateFeature(to, drawn.get()) == OGRERR_NONE;
  }
  drawing.reset();
  errors.require_written(works, file);
  require_end(file, "EOF");
}

void require_complete_geojson(const std::filesystem::path& file) {
  require_end(file, "]}");
}

}  // namespace axial::map
