// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <map>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "private/bytes/text_reader.h"
#include "private/textured/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Calls visit(material, file) for each texture of an MTL file.
template <class Visit>
void for_each_texture(const fs::path& mtl, const Visit& visit) {
  const std::string bytes = read_file(mtl);
  TextReader reader(bytes, mtl.string());
  std::string material;
  while (std::optional<TextLine> line = reader.line()) {
    if (line->empty()) continue;
    const std::string_view key = line->word("key");
    if (key == "newmtl") material = line->rest();
    if (key == "map_Kd") visit(material, mtl.parent_path() / line->rest());
  }
}

class ObjReader {
 public:
  // `textured`: false to read vertices and faces only.
  ObjReader(const fs::path& path, bool textured) : path_(path), textured_(textured) {}

  TexturedMesh read(const std::optional<LocalFrame>& frame) {
    const std::string bytes = read_file(path_);
    TextReader reader(bytes, path_.string());
    while (std::optional<TextLine> line = reader.line()) read_line(*line);
    if (result_.mesh.faces.empty()) fail("{}: the mesh has no faces", path_.string());
    result_.mesh.vertices = placed_in(frame, positions_, offset_, path_.string());
    return std::move(result_);
  }

 private:
  struct Corner {
    std::uint32_t vertex = 0;
    Eigen::Vector2d uv{0, 0};
  };

  void read_line(TextLine line) {
    if (line.empty()) return;
    const std::string_view key = line.word("key");
    if (key == "v") {
      positions_.push_back(read_vector(line));
    } else if (key == "f") {
      read_face(line);
    } else if (key == "#" && line.rest().starts_with("geo_offset ")) {
      line.word("geo_offset");
      offset_ = read_vector(line);
    } else if (textured_) {
      read_texture_line(key, line);
    }
  }

  void read_texture_line(std::string_view key, TextLine& line) {
    if (key == "vt") {
      const auto u = line.number<double>("u");
      uv_.emplace_back(u, line.number<double>("v"));
    } else if (key == "usemtl") {
      texture_ = texture_of(line);
    } else if (key == "mtllib") {
      read_materials(path_.parent_path() / line.rest());
    }
  }

  static Eigen::Vector3d read_vector(TextLine& line) {
    Eigen::Vector3d vector;
    for (int k = 0; k < 3; ++k) vector[k] = line.number<double>("a coordinate");
    return vector;
  }

  // The item of a list of `count` items that `word` names by its number, which counts from 1.
  static std::size_t index(std::string_view word, std::size_t count, const TextLine& line,
                           const char* list) {
    const auto number = parse_number<std::size_t>(word);
    if (!number || *number < 1 || *number > count)
      fail("{}: the {} '{}' does not exist; there are {} so far", line.where(), list, word, count);
    return *number - 1;
  }

  Corner read_corner(std::string_view word, const TextLine& line) const {
    const std::size_t slash = word.find('/');
    Corner corner;
    corner.vertex =
        static_cast<std::uint32_t>(index(word.substr(0, slash), positions_.size(), line, "vertex"));
    if (!textured_) return corner;
    if (slash == std::string_view::npos)
      fail("{}: the corner '{}' has no texture coordinate", line.where(), word);
    const std::string_view rest = word.substr(slash + 1);
    corner.uv = uv_[index(rest.substr(0, rest.find('/')), uv_.size(), line, "texture coordinate")];
    return corner;
  }

  void read_face(TextLine& line) {
    if (textured_ && !texture_) fail("{}: the face has no material with a texture", line.where());
    const Corner first = read_corner(line.word("corner"), line);
    Corner second = read_corner(line.word("corner"), line);
    do {
      const Corner third = read_corner(line.word("corner"), line);
      result_.mesh.faces.push_back({first.vertex, second.vertex, third.vertex});
      if (textured_) add_uv({first.uv, second.uv, third.uv}, line);
      second = third;
    } while (!line.empty());
  }

  void add_uv(const std::array<Eigen::Vector2d, 3>& corners, const TextLine& line) {
    const cv::Size size = result_.textures[*texture_].size();
    const auto& uv = result_.uv.emplace_back(TexturedMesh::Corners{
        pixel_of(corners[0], size), pixel_of(corners[1], size), pixel_of(corners[2], size)});
    for (const Eigen::Vector2f& corner : uv)
      if (!corner.allFinite()) fail("{}: a texture coordinate is too large", line.where());
    result_.texture_of.push_back(*texture_);
  }

  std::uint32_t texture_of(const TextLine& line) const {
    const auto material = materials_.find(std::string(line.rest()));
    if (material == materials_.end())
      fail("{}: there is no material '{}' with a texture", line.where(), line.rest());
    return material->second;
  }

  void read_materials(const fs::path& path) {
    for_each_texture(path, [&](const std::string& material, const fs::path& texture) {
      materials_[material] = static_cast<std::uint32_t>(result_.textures.size());
      result_.textures.push_back(read_color_image(texture));
    });
  }

  fs::path path_;
  bool textured_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector2d> uv_;
  std::map<std::string, std::uint32_t> materials_;  // the texture of each material that has one
  std::optional<std::uint32_t> texture_;            // of the next faces
  std::optional<Eigen::Vector3d> offset_;
  TexturedMesh result_;
};

}  // namespace

TexturedMesh read_textured_obj(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return ObjReader(path, true).read(frame);
}

Mesh read_shape_obj(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return std::move(ObjReader(path, false).read(frame).mesh);
}

TextureFiles texture_files_of_obj(const fs::path& path) {
  const std::string bytes = read_file(path);
  TextReader reader(bytes, path.string());
  TextureFiles files;
  while (std::optional<TextLine> line = reader.line()) {
    if (line->empty() || line->word("key") != "mtllib") continue;
    files.materials.push_back(path.parent_path() / line->rest());
    for_each_texture(files.materials.back(), [&](const std::string&, const fs::path& texture) {
      files.textures.push_back(texture);
    });
  }
  return files;
}

std::vector<Eigen::Vector3f> placed_in(const std::optional<LocalFrame>& frame,
                                       std::span<const Eigen::Vector3d> stored,
                                       const std::optional<Eigen::Vector3d>& offset,
                                       const std::string& file) {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (frame) shift = offset.value_or(Eigen::Vector3d::Zero()) - frame->origin;
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(stored.size());
  for (const Eigen::Vector3d& position : stored) {
    positions.push_back((position + shift).cast<float>());
    if (!positions.back().allFinite())
      fail("{}: vertex {} is not finite or too large", file, positions.size() - 1);
  }
  return positions;
}

}  // namespace axial::io
