// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/textured/textured_mesh.h"
#include "textured/private/obj_materials.h"
#include "textured/private/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// How many items the lines of an OBJ declare. `faces` is an upper bound of the triangles.
struct ObjCounts {
  std::uint64_t vertices = 0, colors = 0, coordinates = 0, faces = 0;
};

std::uint64_t count_words(std::string_view line) {
  std::uint64_t words = 0;
  while (!take_token(line).empty()) ++words;
  return words;
}

ObjCounts count_obj_items(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  ObjCounts counts;
  bool face_goes_on = false;
  for (std::string line; std::getline(in, line);) {
    const std::string_view text = trimmed(line);
    std::string_view rest = text;
    const std::string_view key = take_token(rest);
    const bool is_face = key == "f" || key == "fo";
    counts.vertices += key == "v";
    counts.colors += key == "v" && counts.colors < counts.vertices && count_words(rest) > 3;
    counts.coordinates += key == "vt";
    if (is_face) counts.faces += std::max<std::uint64_t>(count_words(text), 3) - 3;
    if (!is_face && face_goes_on) counts.faces += count_words(text);
    face_goes_on = (is_face || face_goes_on) && text.ends_with('\\');
  }
  return counts;
}

class ObjReader {
 public:
  ObjReader(const fs::path& path, MeshParts parts)
      : path_(path),
        file_(path.string()),
        textured_(parts != MeshParts::shape),
        textures_(file_, parts == MeshParts::textured) {}

  TexturedMesh read(const std::optional<LocalFrame>& frame) {
    const std::string bytes = read_file(path_);
    make_room(count_obj_items(path_));
    read_points(bytes);
    read_faces(bytes);
    if (result_.mesh.faces.empty()) fail_in(file_, "the mesh has no faces");
    result_.mesh.vertices = placed_in(frame, positions_, offset_, file_);
    if (!textured_) result_.mesh.colors = vertex_colors();
    textures_.finish(result_);
    return std::move(result_);
  }

  const TextureSet& textures() const { return textures_; }

 private:
  struct Corner {
    std::uint32_t vertex = 0;
    std::optional<std::size_t> uv;
  };

  // A material, and its texture if a face or a picture needs it.
  struct UsedMaterial {
    ObjMaterial material;
    std::optional<std::uint32_t> texture;
  };

  void make_room(const ObjCounts& counts) {
    if (counts.vertices > 0xFFFFFFFFu) fail_in(file_, "has {} vertices", counts.vertices);
    positions_.reserve(counts.vertices);
    if (!textured_ && counts.colors == counts.vertices) colors_.reserve(counts.vertices);
    result_.mesh.faces.reserve(counts.faces);
    if (!textured_) return;
    uv_.reserve(counts.coordinates);
    result_.uv.reserve(counts.faces);
    result_.texture_of.reserve(counts.faces);
  }

  // Vertices, texture coordinates and materials: faces may refer to later lines.
  void read_points(const std::string& bytes) {
    ObjLines lines(bytes, file_);
    while (std::optional<TextLine> line = lines.next()) {
      const std::string_view key = line->word("key");
      if (key == "v") {
        read_vertex(lines.without_comment(*line));
      } else if (key == "#" && line->rest().starts_with("geo_offset ")) {
        line->word("geo_offset");
        offset_ = read_vector(*line);
      } else if (textured_ && key == "vt") {
        TextLine values = lines.without_comment(*line);
        const auto u = values.number<double>("u");
        uv_.emplace_back(u, values.empty() ? 0.0 : values.number<double>("v"));
      } else if (textured_ && key == "mtllib") {
        read_material_files(line->file_name());
      } else if (key == "surf" || key == "call") {
        fail_in(line->where(), "'{}' is not supported", key);
      }
    }
  }

  static Eigen::Vector3d read_vector(TextLine& line) {
    Eigen::Vector3d vector;
    for (int k = 0; k < 3; ++k) vector[k] = line.number<double>("a coordinate");
    return vector;
  }

  // x y z, then nothing, a weight, or red, green and blue.
  void read_vertex(TextLine line) {
    positions_.push_back(read_vector(line));
    if (textured_ || line.empty() || colors_.size() + 1 != positions_.size()) return;
    Eigen::Vector3f color;
    for (int k = 0; k < 3; ++k) {
      if (line.empty()) return;
      const auto value = parse_finite<float>(line.word("a colour"));
      if (!value) return;
      color[k] = *value;
    }
    colors_.push_back(color);
  }

  // Colours are from 0 to 1. A few programs write 0 to 255.
  std::vector<Rgb> vertex_colors() const {
    std::vector<Rgb> result;
    if (colors_.size() != positions_.size()) return result;
    float largest = 0;
    for (const Eigen::Vector3f& color : colors_) largest = std::max(largest, color.maxCoeff());
    const float scale = largest > 1 ? 1.0f : 255.0f;
    result.reserve(colors_.size());
    for (const Eigen::Vector3f& color : colors_) {
      Rgb& rgb = result.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        rgb[k] = static_cast<std::uint8_t>(
            std::lround(std::clamp(scale * color[static_cast<Eigen::Index>(k)], 0.0f, 255.0f)));
    }
    return result;
  }

  // Programs repeat the line for each object: a file of the same names is read once.
  void read_material_files(std::string_view names) {
    if (!material_lines_.emplace(names).second) return;
    for (const fs::path& mtl : material_files(path_.parent_path(), names)) add_materials(mtl);
  }

  void add_materials(const fs::path& mtl) {
    for (ObjMaterial& material : read_obj_materials(mtl)) {
      UsedMaterial used{std::move(material), {}};
      if (used.material.texture) used.texture = textures_.add(*used.material.texture);
      materials_[used.material.name] = std::move(used);
    }
  }

  void read_faces(const std::string& bytes) {
    ObjLines lines(bytes, file_);
    while (std::optional<TextLine> line = lines.next()) {
      const std::string_view key = line->word("key");
      vertices_ += key == "v";
      coordinates_ += key == "vt";
      if (key == "f" || key == "fo") read_face(lines.without_comment(*line));
      if (textured_ && key == "usemtl") use_material(*line);
    }
  }

  // The item of a list of `all` items that `word` names. Positive numbers count from 1. Negative
  // numbers count back from the last of the `so_far` items before the line.
  static std::size_t index(std::string_view word, std::size_t all, std::size_t so_far,
                           const TextLine& line, const char* list) {
    const auto number = parse_number<std::int64_t>(word);
    const std::int64_t at = !number       ? -1
                            : *number < 0 ? static_cast<std::int64_t>(so_far) + *number
                                          : *number - 1;
    if (at < 0 || static_cast<std::uint64_t>(at) >= all)
      fail_in(line.where(), "the {} '{}' does not exist; there are {}", list, word, all);
    return static_cast<std::size_t>(at);
  }

  // v, v/vt, v//vn or v/vt/vn.
  Corner read_corner(std::string_view word, const TextLine& line) const {
    const std::size_t slash = word.find('/');
    Corner corner;
    corner.vertex = static_cast<std::uint32_t>(
        index(word.substr(0, slash), positions_.size(), vertices_, line, "vertex"));
    if (!textured_ || slash == std::string_view::npos) return corner;
    const std::string_view rest = word.substr(slash + 1);
    const std::string_view uv = rest.substr(0, rest.find('/'));
    if (!uv.empty()) corner.uv = index(uv, uv_.size(), coordinates_, line, "texture coordinate");
    return corner;
  }

  void read_face(TextLine line) {
    const Corner first = read_corner(line.word("corner"), line);
    Corner second = read_corner(line.word("corner"), line);
    do {
      const Corner third = read_corner(line.word("corner"), line);
      result_.mesh.faces.push_back({first.vertex, second.vertex, third.vertex});
      if (textured_) add_uv({first, second, third}, line);
      second = third;
    } while (!line.empty());
  }

  void add_uv(const std::array<Corner, 3>& corners, const TextLine& line) {
    UsedMaterial& used = *material_;
    std::array<Eigen::Vector2d, 3> uv{{{0, 0}, {1, 0}, {0, 1}}};
    if (used.material.texture) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!corners[k].uv) fail_in(line.where(), "a corner has no texture coordinate");
        uv[k] = used.material.scale.cwiseProduct(uv_[*corners[k].uv]) + used.material.offset;
      }
    } else if (!used.texture) {
      used.texture = textures_.add({.color = used.material.color});
    }
    textures_.add_face(result_, *used.texture, uv, [&] { return line.where() + ": the face"; });
  }

  void use_material(const TextLine& line) {
    const std::string name(line.rest());
    if (name.empty()) {
      material_ = &white_;
      return;
    }
    const auto found = materials_.find(name);
    if (found == materials_.end())
      fail_in(line.where(), "there is no material '{}' in its MTL files", name);
    material_ = &found->second;
  }

  fs::path path_;
  std::string file_;
  bool textured_;
  TextureSet textures_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector3f> colors_;
  std::vector<Eigen::Vector2d> uv_;
  std::map<std::string, UsedMaterial> materials_;
  std::set<std::string, std::less<>> material_lines_;  // the names behind mtllib
  UsedMaterial white_;                                 // the format's material of faces without one
  UsedMaterial* material_ = &white_;                   // of the next faces
  std::size_t vertices_ = 0, coordinates_ = 0;         // before the line that is read
  std::optional<Eigen::Vector3d> offset_;
  TexturedMesh result_;
};

Mesh read_shape_obj(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return std::move(ObjReader(path, MeshParts::shape).read(frame).mesh);
}

std::uint64_t bytes_of_obj_textures(const fs::path& path, const Context&) {
  ObjReader reader(path, MeshParts::sizes);
  reader.read({});
  return reader.textures().bytes();
}

std::uint64_t bytes_to_read_obj(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t file = fs::file_size(path, error);
  if (error) return 0;
  const ObjCounts counts = count_obj_items(path);
  constexpr std::uint64_t kVertex =
      sizeof(Eigen::Vector3d) + 2 * sizeof(Eigen::Vector3f) + sizeof(Rgb);
  constexpr std::uint64_t kFace = 12 + sizeof(TexturedMesh::Corners) + 4;
  return file + kVertex * counts.vertices + sizeof(Eigen::Vector2d) * counts.coordinates +
         kFace * counts.faces;
}

// Calls use(key, line) for each line of the file.
template <class Use>
void for_each_line(const fs::path& path, Use use) {
  const std::string bytes = read_file(path);
  ObjLines lines(bytes, path.string());
  while (std::optional<TextLine> line = lines.next()) {
    const std::string_view key = line->word("key");
    use(key, *line);
  }
}

bool is_textured_obj(const fs::path& path) {
  bool coordinates = false, textures = false;
  for_each_line(path, [&](std::string_view key, const TextLine& line) {
    coordinates |= key == "vt";
    if (key != "mtllib") return;
    for (const fs::path& mtl : material_files(path.parent_path(), line.file_name()))
      for (const ObjMaterial& material : read_obj_materials(mtl))
        textures |= material.texture.has_value();
  });
  return coordinates && textures;
}

MeshPlace place_of_obj(const fs::path& path) {
  MeshPlace place;
  place.is_float = false;
  bool has_first = false;
  for_each_line(path, [&](std::string_view key, TextLine& line) {
    const bool is_offset = key == "#" && line.rest().starts_with("geo_offset ");
    if (!is_offset && (key != "v" || has_first)) return;
    if (is_offset) line.word("geo_offset");
    Eigen::Vector3d& vector = is_offset ? place.frame.origin : place.first_vertex;
    for (double& value : vector) value = line.number<double>("a coordinate");
    has_first |= !is_offset;
  });
  place.first_vertex += place.frame.origin;
  return place;
}

TextureFiles texture_files_of_obj(const fs::path& path) {
  TextureFiles files;
  for_each_line(path, [&](std::string_view key, const TextLine& line) {
    if (key != "mtllib") return;
    for (const fs::path& mtl : material_files(path.parent_path(), line.file_name())) {
      files.materials.push_back(mtl);
      std::error_code ignored;
      if (!fs::exists(mtl, ignored)) continue;
      for (const ObjMaterial& material : read_obj_materials(mtl))
        if (material.texture) files.textures.push_back(material.texture->file);
    }
  });
  return files;
}

}  // namespace

TexturedMesh read_textured_obj(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return ObjReader(path, MeshParts::textured).read(frame);
}

const MeshFormat kObjMeshes{[](const fs::path& path, const std::optional<LocalFrame>& frame,
                               const Context&) { return read_textured_obj(path, frame); },
                            read_shape_obj,
                            is_textured_obj,
                            texture_files_of_obj,
                            place_of_obj,
                            bytes_of_obj_textures,
                            bytes_to_read_obj};

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
      fail_in(file, "vertex {} is not finite or too large", positions.size() - 1);
  }
  return positions;
}

}  // namespace axial::io
