// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the materials and the lines of OBJ files.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "bytes/private/text_reader.h"
#include "textured/private/texture_set.h"

namespace axial::io {

// The lines of an OBJ or MTL file. A line that ends with '\' goes on in the next line.
class ObjLines {
 public:
  ObjLines(std::string_view text, const std::string& file) : file_(file), reader_(text, file) {}

  // The next line that is not empty; nothing at the end of the file. The line is valid until the
  // next call.
  std::optional<TextLine> next();

  // The rest of the line without a comment at its end.
  TextLine without_comment(const TextLine& line) const {
    return {line.rest().substr(0, line.rest().find('#')), file_, number_};
  }

 private:
  std::string file_, joined_;
  TextReader reader_;
  std::size_t number_ = 0;  // of the last line
};

// A material of an MTL file.
struct ObjMaterial {
  std::string name;
  std::optional<TextureSource> texture;       // map_Kd
  Eigen::Vector2d scale{1, 1}, offset{0, 0};  // of texture coordinates: scale * (u, v) + offset
  Rgb color{255, 255, 255};                   // Kd
};

// Reads the materials of an MTL file in their order. Pictures are not opened. Error that names the
// file and the line for a malformed option of map_Kd.
std::vector<ObjMaterial> read_obj_materials(const std::filesystem::path& mtl);

// The MTL files that the rest of a line mtllib names, for an OBJ in `folder`. The names are
// separated by blanks, and may contain blanks themselves where such a file exists.
std::vector<std::filesystem::path> material_files(const std::filesystem::path& folder,
                                                  std::string_view names);

}  // namespace axial::io
