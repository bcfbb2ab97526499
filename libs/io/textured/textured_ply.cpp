// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "base/atomic_file.h"
#include "base/error.h"
#include "bytes/private/byte_writer.h"
#include "ply/private/ply_rows.h"
#include "ply/private/ply_stream.h"
#include "textured/private/file_names.h"
#include "textured/private/texture_set.h"
#include "textured/private/textured_readers.h"
#include "textured/private/textured_writers.h"

namespace axial::io {

std::string textured_ply(const TexturedMesh& textured, const std::vector<std::string>& textures,
                         const LocalFrame& frame) {
  const PlyPlacement placement{frame};
  const Mesh& mesh = textured.mesh;
  const bool numbered = textures.size() > 1;
  ByteWriter out;
  out.reserve(1000 + 12 * mesh.vertices.size() + (numbered ? 43 : 39) * mesh.faces.size());
  out.text("ply\nformat binary_little_endian 1.0\n");
  out.text(geo_comment(placement));
  for (const std::string& name : textures) out.text(fmt::format("comment TextureFile {}\n", name));
  out.text(
      fmt::format("element vertex {}\n{}element face {}\n"
                  "property list uint8 uint32 vertex_indices\n"
                  "property list uint8 float32 texcoord\n{}{}end_header\n",
                  mesh.vertices.size(), position_properties(placement), mesh.faces.size(),
                  numbered ? "property int32 texnumber\n" : "",
                  mesh.unseen.empty() ? "" : "property uint8 unseen\n"));
  for (const Eigen::Vector3f& vertex : mesh.vertices) out.write(std::span(vertex.data(), 3));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::uint32_t texture = textured.texture_of[f];
    out.write(std::uint8_t{3});
    out.write(std::span(mesh.faces[f]));
    out.write(std::uint8_t{6});
    for (const Eigen::Vector2f& corner : textured.uv[f]) {
      const Eigen::Vector2f uv = relative(corner, textured.textures[texture].size());
      out.write(uv.x());
      out.write(1 - uv.y());
    }
    if (numbered) out.write(static_cast<std::int32_t>(texture));
    if (!mesh.unseen.empty()) out.write(mesh.unseen[f]);
  }
  return out.take();
}

namespace {

namespace fs = std::filesystem;

// The texture coordinates at the vertices of a PLY, as MeshLab and Blender write them.
struct VertexCoordinates {
  std::vector<Eigen::Vector2d> uv;
  std::vector<double> texture;  // texnumber; empty without this property
};

// The properties of texture coordinates at vertices: the first pair of names that exists.
std::optional<std::array<const char*, 2>> vertex_coordinates(const PlyElement& vertex) {
  constexpr std::array<std::array<const char*, 2>, 4> kNames{
      {{"texture_u", "texture_v"}, {"u", "v"}, {"s", "t"}, {"texture_s", "texture_t"}}};
  for (const auto& names : kNames)
    if (find_property(vertex, names[0], false) != kNoProperty &&
        find_property(vertex, names[1], false) != kNoProperty)
      return names;
  return {};
}

bool has_face_coordinates(const PlyHeader& header) {
  const PlyElement* face = find_element(header, "face");
  return face && find_property(*face, "texcoord", true) != kNoProperty;
}

bool has_vertex_coordinates(const PlyHeader& header) {
  const PlyElement* vertex = find_element(header, "vertex");
  return vertex && vertex_coordinates(*vertex);
}

// The values of a row of faces that are of interest.
struct FaceRow {
  std::vector<double> corners, uv;
  double texture = 0;
};

class TexturedPlyReader {
 public:
  TexturedPlyReader(const fs::path& path, const PlyHeader& header)
      : file_(path.string()), header_(header), textures_(file_, true) {
    for (const std::string& name : header.texture_files)
      textures_.add({.file = path_beside(path.parent_path(), name)});
  }

  TexturedMesh read(const std::string& bytes, Mesh mesh) {
    result_.mesh = std::move(mesh);
    result_.uv.reserve(result_.mesh.faces.size());
    result_.texture_of.reserve(result_.mesh.faces.size());
    if (has_face_coordinates(header_) || !has_vertex_coordinates(header_))
      read_faces(bytes);
    else
      use_vertices(bytes);
    if (result_.uv.size() != result_.mesh.faces.size())
      fail_in(file_, "has {} triangles, but texture coordinates of {}", result_.mesh.faces.size(),
              result_.uv.size());
    textures_.finish(result_);
    return std::move(result_);
  }

 private:
  // `kind` and `f`: the face's name in messages.
  void add(const std::array<Eigen::Vector2d, 3>& uv, double texture, const char* kind,
           std::uint64_t f) {
    const auto textures = header_.texture_files.size();
    if (!(texture >= 0 && texture < static_cast<double>(textures)))
      fail_in(file_, "{} {} has texnumber {}, but there are {} textures", kind, f, texture,
              textures);
    for (const Eigen::Vector2d& corner : uv)
      if (!corner.allFinite()) fail_in(file_, "{} {} has a texcoord that is not finite", kind, f);
    textures_.add_face(result_, static_cast<std::uint32_t>(texture), uv,
                       [&] { return fmt::format("{}: {} {}", file_, kind, f); });
  }

  // The triangles of a polygon are a fan, as in read_mesh_ply().
  void add_face(const FaceRow& row, std::uint64_t f) {
    const std::size_t corners = row.corners.size();
    if (row.uv.size() != 2 * corners)
      fail_in(file_, "face {} has {} numbers in texcoord, expected {}", f, row.uv.size(),
              2 * corners);
    const auto at = [&](std::size_t k) {
      return Eigen::Vector2d(row.uv[2 * k], row.uv[2 * k + 1]);
    };
    for (std::size_t k = 2; k < corners; ++k)
      add({at(0), at(k - 1), at(k)}, row.texture, "face", f);
  }

  // The corners themselves are read by read_mesh_ply.
  void read_faces(const std::string& bytes) {
    PlyBody body(bytes, file_, header_);
    for (const PlyElement& element : header_.elements) {
      if (element.name != "face") {
        skip_rows(body, element);
        continue;
      }
      body.require_rows(element);
      PlyRows rows(element);
      FaceRow row;
      if (!rows.store("vertex_indices", row.corners)) rows.store("vertex_index", row.corners);
      rows.store("texcoord", row.uv);
      rows.store("texnumber", row.texture);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        rows.read(body);
        add_face(row, i);
      }
      return;
    }
  }

  VertexCoordinates read_vertices(const std::string& bytes) const {
    PlyBody body(bytes, file_, header_);
    VertexCoordinates result;
    const PlyElement* vertices = find_element(header_, "vertex");
    for (const PlyElement& element : header_.elements) {
      if (&element == vertices) break;
      skip_rows(body, element);
    }
    const auto names = *vertex_coordinates(*vertices);
    PlyRows rows(*vertices);
    Eigen::Vector2d uv;
    double texture = 0;
    rows.store(names[0], uv.x());
    rows.store(names[1], uv.y());
    const bool numbered = rows.store("texnumber", texture);
    body.require_rows(*vertices);
    result.uv.reserve(vertices->count);
    if (numbered) result.texture.reserve(vertices->count);
    for (std::size_t i = 0; i < vertices->count; ++i) {
      rows.read(body);
      result.uv.push_back(uv);
      if (numbered) result.texture.push_back(texture);
    }
    return result;
  }

  // Corners of a face have the coordinates of their vertices, and the texture of the first vertex.
  void use_vertices(const std::string& bytes) {
    const VertexCoordinates at = read_vertices(bytes);
    for (std::size_t f = 0; f < result_.mesh.faces.size(); ++f) {
      const auto& [a, b, c] = result_.mesh.faces[f];
      add({at.uv[a], at.uv[b], at.uv[c]}, at.texture.empty() ? 0.0 : at.texture[a], "triangle", f);
    }
  }

  std::string file_;
  const PlyHeader& header_;
  TextureSet textures_;
  TexturedMesh result_;
};

}  // namespace

TexturedMesh read_textured_ply(const fs::path& path, const std::optional<LocalFrame>& frame) {
  const std::string file = path.string();
  Mesh mesh = frame ? read_mesh_ply(path, *frame) : read_mesh_ply(path);
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  if (header.texture_files.empty()) fail_in(file, "has no comment TextureFile");
  return TexturedPlyReader(path, header).read(bytes, std::move(mesh));
}

std::vector<std::string> textures_of_ply(const fs::path& path) {
  return PlyStream(path).header().texture_files;
}

namespace {

bool is_textured_ply(const fs::path& path) {
  const PlyStream stream(path);
  const PlyHeader& header = stream.header();
  return !header.texture_files.empty() &&
         (has_face_coordinates(header) || has_vertex_coordinates(header));
}

TextureFiles texture_files_of_ply(const fs::path& path) {
  TextureFiles files;
  for (const std::string& name : textures_of_ply(path))
    files.textures.push_back(path_beside(path.parent_path(), name));
  return files;
}

std::uint64_t bytes_of_ply_textures(const fs::path& path, const Context&) {
  TextureSet textures(path.string(), false);
  for (const fs::path& texture : texture_files_of_ply(path).textures)
    textures.add({.file = texture});
  return textures.bytes();
}

std::uint64_t bytes_to_read_ply(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t file = fs::file_size(path, error);
  if (error) return 0;
  // A mesh is at most as large as its binary file, and at most twice as large as its text. Texture
  // coordinates at vertices are multiplied: each of a vertex's faces has a copy in memory.
  // An index in a strip becomes a triangle.
  std::uint64_t factor = 3;
  try {
    const PlyStream stream(path);
    const PlyHeader& header = stream.header();
    if (!header.texture_files.empty() && !has_face_coordinates(header) &&
        has_vertex_coordinates(header))
      factor = 8;
    if (find_element(header, "tristrips")) factor += 12;
  } catch (const Error&) {  // the reader of the mesh says what is wrong
  }
  return factor * file;
}

Mesh read_shape_ply(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return frame ? read_mesh_ply(path, *frame) : read_mesh_ply(path);
}

}  // namespace

const MeshFormat kPlyMeshes{[](const fs::path& path, const std::optional<LocalFrame>& frame,
                               const Context&) { return read_textured_ply(path, frame); },
                            read_shape_ply,
                            is_textured_ply,
                            texture_files_of_ply,
                            ply_place,
                            bytes_of_ply_textures,
                            bytes_to_read_ply};

}  // namespace axial::io
