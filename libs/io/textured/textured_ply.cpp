// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "io/images/image.h"
#include "private/bytes/byte_writer.h"
#include "private/ply/ply_header.h"
#include "private/textured/textured_readers.h"
#include "private/textured/textured_writers.h"

namespace axial::io {

std::string textured_ply(const TexturedMesh& textured, const std::vector<std::string>& textures,
                         const LocalFrame& frame) {
  const PlyPlacement placement{frame};
  const Mesh& mesh = textured.mesh;
  const bool numbered = textures.size() > 1;
  ByteWriter out;
  out.reserve(1000 + 12 * mesh.vertices.size() + (numbered ? 42 : 38) * mesh.faces.size());
  out.text("ply\nformat binary_little_endian 1.0\n");
  out.text(geo_comment(placement));
  for (const std::string& name : textures) out.text(fmt::format("comment TextureFile {}\n", name));
  out.text(
      fmt::format("element vertex {}\n{}element face {}\n"
                  "property list uint8 uint32 vertex_indices\n"
                  "property list uint8 float32 texcoord\n{}end_header\n",
                  mesh.vertices.size(), position_properties(placement), mesh.faces.size(),
                  numbered ? "property int32 texnumber\n" : ""));
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
  }
  return out.take();
}

namespace {

// The values of a row of faces that are of interest.
struct FaceRow {
  std::vector<double> corners, uv;
  double texture = 0;
};

void read_face_row(PlyBody& body, const PlyElement& element, FaceRow& row) {
  for (const PlyProperty& property : element.properties) {
    if (!property.is_list) {
      const double value = body.scalar(property.type, property.name);
      if (property.name == "texnumber") row.texture = value;
      continue;
    }
    std::vector<double> values(body.list_size(property));
    for (double& value : values) value = body.scalar(property.type, property.name);
    if (property.name == "vertex_indices" || property.name == "vertex_index")
      row.corners = std::move(values);
    else if (property.name == "texcoord")
      row.uv = std::move(values);
  }
}

void add_face(const FaceRow& row, std::size_t f, const std::string& file, TexturedMesh& result) {
  if (row.corners.size() != 3)
    fail("{}: face {} has {} corners, expected 3", file, f, row.corners.size());
  if (row.uv.size() != 6)
    fail("{}: face {} has {} numbers in texcoord, expected 6", file, f, row.uv.size());
  if (!(row.texture >= 0 && row.texture < static_cast<double>(result.textures.size())))
    fail("{}: face {} has texnumber {}, but there are {} textures", file, f, row.texture,
         result.textures.size());
  const auto texture = static_cast<std::uint32_t>(row.texture);
  const cv::Size size = result.textures[texture].size();
  TexturedMesh::Corners uv;
  for (std::size_t k = 0; k < 3; ++k) {
    uv[k] = pixel_of({row.uv[2 * k], row.uv[2 * k + 1]}, size);
    if (!uv[k].allFinite()) fail("{}: face {} has a texcoord that is not finite", file, f);
  }
  result.uv.push_back(uv);
  result.texture_of.push_back(texture);
}

// Reads the rows of the faces; the corners themselves are read by read_mesh_ply.
void read_texture_coordinates(const std::string& bytes, const PlyHeader& header,
                              const std::string& file, TexturedMesh& result) {
  PlyBody body(bytes, file, header);
  for (const PlyElement& element : header.elements) {
    body.require_rows(element);
    FaceRow row;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      row = {};
      read_face_row(body, element, row);
      if (element.name == "face") add_face(row, i, file, result);
    }
    if (element.name == "face") return;
  }
}

}  // namespace

TexturedMesh read_textured_ply(const std::filesystem::path& path,
                               const std::optional<LocalFrame>& frame) {
  const std::string file = path.string();
  TexturedMesh result;
  result.mesh = frame ? read_mesh_ply(path, *frame) : read_mesh_ply(path);
  const std::string bytes = read_file(path);
  const PlyHeader header = parse_ply_header(bytes, file);
  if (header.texture_files.empty()) fail("{}: has no comment TextureFile", file);
  for (const std::string& name : header.texture_files)
    result.textures.push_back(read_color_image(path.parent_path() / name));
  read_texture_coordinates(bytes, header, file, result);
  return result;
}

std::vector<std::string> textures_of_ply(const std::filesystem::path& path) {
  return parse_ply_header(read_file(path), path.string()).texture_files;
}

bool is_textured_mesh(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj" || extension == ".glb") return true;
  return !textures_of_ply(path).empty();
}

TextureFiles texture_files_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".glb") return {};
  if (extension == ".obj") return texture_files_of_obj(path);
  TextureFiles files;
  for (const std::string& texture : textures_of_ply(path))
    files.textures.push_back(path.parent_path() / texture);
  return files;
}

std::uint64_t bytes_to_read_textures(const std::filesystem::path& path) {
  std::vector<ImageHeader> headers;
  if (lower_extension(path) == ".glb")
    headers = color_headers_of_glb(path);
  else
    for (const std::filesystem::path& texture : texture_files_of(path).textures)
      headers.push_back(read_image_header(texture));
  std::uint64_t bytes = 0, largest = 0;
  for (const ImageHeader& header : headers) {
    bytes += std::uint64_t{3} * static_cast<std::uint64_t>(header.size.width) *
             static_cast<std::uint64_t>(header.size.height);
    largest = std::max(largest, bytes_needed(header));
  }
  return bytes + largest;
}

Mesh read_shape(const std::filesystem::path& path, const std::optional<LocalFrame>& frame) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_shape_obj(path, frame);
  if (extension == ".glb") return read_shape_glb(path, frame);
  return frame ? read_mesh_ply(path, *frame) : read_mesh_ply(path);
}

TexturedMesh read_textured_mesh(const std::filesystem::path& path,
                                const std::optional<LocalFrame>& frame) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_textured_obj(path, frame);
  if (extension == ".glb") return read_textured_glb(path, frame);
  return read_textured_ply(path, frame);
}

}  // namespace axial::io
