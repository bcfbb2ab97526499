// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/textured/textured_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "io/images/image.h"
#include "textured/private/textured_writers.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

// A format: its name, which is also its extension, the extension of the second file, and the name
// of a texture around its number. Formats share no names of textures: each format may be written by
// a run of its own, with other textures.
struct FormatNames {
  TexturedFormat format;
  const char *name, *second, *texture_begin, *texture_end;
};
constexpr std::array<FormatNames, 4> kFormats{
    {{TexturedFormat::ply, "ply", nullptr, "", ".png"},
     {TexturedFormat::obj, "obj", ".mtl", "_material_", "_map_Kd.png"},
     {TexturedFormat::glb, "glb", nullptr, nullptr, nullptr},
     {TexturedFormat::gltf, "gltf", ".bin", "_gltf", ".png"}}};

const FormatNames& format_names(TexturedFormat format) {
  return *std::ranges::find(kFormats, format, &FormatNames::format);
}

void check(const TexturedMesh& mesh, const std::string& file) {
  const std::size_t faces = mesh.mesh.faces.size();
  if (mesh.uv.size() != faces || mesh.texture_of.size() != faces)
    fail_in(file, "the mesh has {} faces, {} texture coordinates and {} texture numbers", faces,
            mesh.uv.size(), mesh.texture_of.size());
  if (!mesh.mesh.unseen.empty() && mesh.mesh.unseen.size() != faces)
    fail_in(file, "the mesh has {} faces, but {} marks of unseen faces", faces,
            mesh.mesh.unseen.size());
  for (std::size_t f = 0; f < faces; ++f) {
    if (mesh.texture_of[f] >= mesh.textures.size())
      fail_in(file, "face {} has texture {}, but there are {}", f, mesh.texture_of[f],
              mesh.textures.size());
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.mesh.faces[f][k] >= mesh.mesh.vertices.size())
        fail_in(file, "face {} refers to vertex {}, but there are {}", f, mesh.mesh.faces[f][k],
                mesh.mesh.vertices.size());
      if (!mesh.uv[f][k].allFinite())
        fail_in(file, "face {} has a texture coordinate that is not finite", f);
    }
  }
  for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v)
    if (!mesh.mesh.vertices[v].allFinite()) fail_in(file, "vertex {} is not finite", v);
}

void write_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::ofstream stream(path, std::ios::binary);
  write(stream);
  stream.close();
  if (!stream) fail_in(path, "cannot be written");
}

template <class Container>
void write_bytes(const fs::path& path, const Container& bytes) {
  write_file(path, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  });
}

std::vector<std::string> names_of(std::span<const fs::path> files) {
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.filename().string());
  return names;
}

}  // namespace

std::optional<TexturedFormat> textured_format(std::string_view name) {
  for (const FormatNames& known : kFormats)
    if (known.name == lower_case(std::string(name))) return known.format;
  return {};
}

std::vector<fs::path> textured_files(const fs::path& path, TexturedFormat format,
                                     std::size_t textures) {
  const auto beside = [&](const std::string& end) {
    return path.parent_path() / (path.stem().string() + end);
  };
  const FormatNames& names = format_names(format);
  std::vector<fs::path> files{beside(fmt::format(".{}", names.name))};
  if (names.second) files.push_back(beside(names.second));
  if (!names.texture_begin) return files;
  for (std::size_t k = 0; k < textures; ++k)
    files.push_back(beside(fmt::format("{}{}{}", names.texture_begin, k, names.texture_end)));
  return files;
}

std::uint64_t bytes_to_write_textured(TexturedFormat format, std::uint64_t vertices,
                                      std::uint64_t faces, std::span<const cv::Size> textures) {
  std::uint64_t all = 0, largest = 0;
  for (const cv::Size& size : textures) {
    const auto bytes = 3 * static_cast<std::uint64_t>(size.area());
    all += bytes;
    largest = std::max(largest, bytes);
  }
  // A PNG is hardly larger than its pixels. It grows while it is made, and is then in memory twice.
  const std::uint64_t png = 2 * largest;
  switch (format) {
    case TexturedFormat::ply:
      return std::max(png, 12 * vertices + 42 * faces);
    case TexturedFormat::obj:  // a text that grows, with a copy; numbers of usual lengths
      return std::max(png, 3 * (35 * vertices + 80 * faces));
    case TexturedFormat::gltf:
      return std::max(png, 2 * 72 * faces);
    case TexturedFormat::glb:
      break;
  }
  return 2 * (all + 72 * faces);  // the buffer and the writer's copy
}

void write_textured_mesh(const fs::path& path, const TexturedMesh& mesh, TexturedFormat format,
                         const LocalFrame& frame) {
  const std::vector<fs::path> files = textured_files(path, format, mesh.textures.size());
  write_together(files, [&](const std::vector<fs::path>& temporaries) {
    write_textured_as(temporaries, path, mesh, format, frame);
  });
}

void write_textured_as(std::span<const fs::path> temporaries, const fs::path& path,
                       const TexturedMesh& mesh, TexturedFormat format, const LocalFrame& frame) {
  const std::vector<fs::path> files = textured_files(path, format, mesh.textures.size());
  const std::string file = files.front().string();
  check(mesh, file);
  const std::size_t before = format_names(format).second ? 2 : 1;
  const std::vector<std::string> textures = names_of(std::span(files).subspan(before));
  for (std::size_t k = before; k < files.size(); ++k)
    write_bytes(temporaries[k], png_bytes(mesh.textures[k - before], file));
  if (format == TexturedFormat::ply)
    return write_bytes(temporaries[0], textured_ply(mesh, textures, frame));
  if (format == TexturedFormat::obj) {
    write_bytes(temporaries[1], textured_mtl(textures));
    return write_bytes(temporaries[0], textured_obj(mesh, files[1].filename().string(), frame));
  }
  if (format == TexturedFormat::gltf) {
    const GltfFiles gltf = textured_gltf(mesh, textures, files[1].filename().string(), frame);
    write_bytes(temporaries[1], gltf.buffer);
    return write_bytes(temporaries[0], gltf.json);
  }
  std::vector<Bytes> pngs;
  for (const cv::Mat3b& texture : mesh.textures) pngs.push_back(png_bytes(texture, file));
  write_file(temporaries[0],
             [&](std::ostream& out) { write_textured_glb(out, mesh, std::move(pngs), frame); });
}

namespace {

constexpr std::uint32_t kNoCorner = 0xFFFFFFFFu;

}  // namespace

CornerUnifier::CornerUnifier(const TexturedMesh& mesh)
    : mesh_(mesh), faces_(mesh.textures.size()), first_(mesh.mesh.vertices.size(), kNoCorner) {
  for (std::uint32_t f = 0; f < mesh.mesh.faces.size(); ++f)
    faces_[mesh.texture_of[f]].push_back(f);
}

UnifiedCorners CornerUnifier::corners_of(std::uint32_t texture) {
  UnifiedCorners result;
  std::vector<std::uint32_t> next;  // corner of the same vertex, of each corner
  for (const std::uint32_t f : faces_[texture]) {
    std::array<std::uint32_t, 3>& corners = result.faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh_.mesh.faces[f][k];
      std::uint32_t i = first_[vertex];
      while (i != kNoCorner && result.uv[i] != mesh_.uv[f][k]) i = next[i];
      if (i == kNoCorner) {
        i = static_cast<std::uint32_t>(result.vertex.size());
        result.vertex.push_back(vertex);
        result.uv.push_back(mesh_.uv[f][k]);
        next.push_back(std::exchange(first_[vertex], i));
      }
      corners[k] = i;
    }
  }
  for (const std::uint32_t vertex : result.vertex) first_[vertex] = kNoCorner;
  return result;
}

Eigen::Vector2f relative(const Eigen::Vector2f& uv, const cv::Size& texture) {
  return {(uv.x() + 0.5f) / static_cast<float>(texture.width),
          (uv.y() + 0.5f) / static_cast<float>(texture.height)};
}

}  // namespace axial::io
