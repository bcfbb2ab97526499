// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "base/error.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "textured/private/gltf_file.h"
#include "textured/private/gltf_scene.h"
#include "textured/private/texture_set.h"
#include "textured/private/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

class GltfReader {
 public:
  GltfReader(const fs::path& path, MeshParts parts)
      : file_(path),
        scene_(scene_of(file_)),
        textured_(parts != MeshParts::shape),
        textures_(file_.name(), parts == MeshParts::textured) {}

  TexturedMesh read(const std::optional<LocalFrame>& frame, const Context& context) {
    make_room();
    for (const GltfInstance& instance : scene_.instances)
      for (const GltfPrimitive& primitive : instance.primitives) add(primitive, instance, context);
    if (result_.mesh.faces.empty()) fail_in(file_.name(), "the mesh has no faces");
    result_.mesh.vertices = placed_in(frame, positions_, scene_.geo_offset, file_.name());
    textures_.finish(result_);
    return std::move(result_);
  }

  const TextureSet& textures() const { return textures_; }

 private:
  void make_room() {
    const GltfCounts counts = count_items(file_, scene_);
    if (counts.vertices > 0xFFFFFFFFu) fail_in(file_.name(), "has {} vertices", counts.vertices);
    // The counts of a damaged file may be huge. What follows is checked when it is read.
    const std::uint64_t bound = file_.buffer_bytes() + file_.json_bytes();
    if (counts.vertices > bound || counts.faces > bound) return;
    positions_.reserve(counts.vertices);
    result_.mesh.faces.reserve(counts.faces);
    if (!textured_ && scene_.colored) result_.mesh.colors.reserve(counts.vertices);
    if (!textured_) return;
    result_.uv.reserve(counts.faces);
    result_.texture_of.reserve(counts.faces);
  }

  void add(const GltfPrimitive& primitive, const GltfInstance& instance, const Context& context) {
    const std::size_t before = positions_.size();
    const GltfValues positions = file_.values(primitive.positions, "VEC3", {5126});
    if (positions.count > 0xFFFFFFFFu - before) fail_in(file_.name(), "has too many vertices");
    const std::vector<std::array<std::uint32_t, 3>> faces =
        triangles_of(file_, primitive, positions.count);
    for (std::size_t i = 0; i < positions.count; ++i) {
      const Eigen::Vector3d at(positions.at(i, 0), positions.at(i, 1), positions.at(i, 2));
      positions_.push_back(
          instance.is_moved ? (instance.placement * at.homogeneous()).head<3>().eval() : at);
    }
    const auto first = static_cast<std::uint32_t>(before);
    const bool mirrored = instance.placement.topLeftCorner<3, 3>().determinant() < 0;
    if (textured_) add_uv(primitive, positions.count, faces, mirrored, context);
    if (!textured_ && scene_.colored) add_colors(primitive, positions.count);
    for (const std::array<std::uint32_t, 3>& face : faces)
      result_.mesh.faces.push_back(
          {first + face[0], first + face[mirrored ? 2 : 1], first + face[mirrored ? 1 : 2]});
  }

  void add_colors(const GltfPrimitive& primitive, std::size_t vertices) {
    const GltfMaterial material = material_of(file_, primitive);
    std::optional<GltfValues> colors;
    if (primitive.colors) colors = colors_of(file_, *primitive.colors, vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      Rgb& rgb = result_.mesh.colors.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        rgb[k] = srgb_of(material.factor[static_cast<Eigen::Index>(k)] *
                         (colors ? colors->at(i, k) : 1.0));
    }
  }

  // The texture of a material; the same number for the same picture, wrapping and factor.
  std::uint32_t texture_of(const GltfMaterial& material) {
    const auto key = std::make_tuple(material.image, material.wrap, material.factor.x(),
                                     material.factor.y(), material.factor.z());
    const auto known = numbers_.find(key);
    if (known != numbers_.end()) return known->second;
    TextureSource source;
    if (material.image) {
      source = picture_of(file_, *material.image);
      source.factor = material.factor;
      source.wrap = material.wrap;
    } else {
      for (std::size_t k = 0; k < 3; ++k)
        source.color[k] = srgb_of(material.factor[static_cast<Eigen::Index>(k)]);
    }
    return numbers_[key] = textures_.add(source);
  }

  void add_uv(const GltfPrimitive& primitive, std::size_t vertices,
              const std::vector<std::array<std::uint32_t, 3>>& faces, bool mirrored,
              const Context& context) {
    const GltfMaterial material = material_of(file_, primitive);
    const std::uint32_t texture = texture_of(material);
    if (primitive.colors && !warned_) {
      context.warning("{}: colours of vertices (COLOR_0) have no effect on textures", file_.name());
      warned_ = true;
    }
    std::vector<Eigen::Vector2d> uv;  // from the upper edge
    if (material.image) uv = coordinates_of(file_, primitive, material, vertices);
    for (const std::array<std::uint32_t, 3>& face : faces) {
      std::array<Eigen::Vector2d, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
      for (std::size_t k = 0; k < 3 && material.image; ++k) {
        const Eigen::Vector2d& at = uv[face[mirrored ? (3 - k) % 3 : k]];
        corners[k] = {at.x(), 1 - at.y()};
      }
      textures_.add_face(result_, texture, corners, [&] {
        return fmt::format("{}: a face of {}", file_.name(), primitive.name);
      });
    }
  }

  using TextureKey =
      std::tuple<std::optional<std::size_t>, std::array<Wrap, 2>, double, double, double>;

  GltfFile file_;
  GltfScene scene_;
  bool textured_, warned_ = false;
  TextureSet textures_;
  std::map<TextureKey, std::uint32_t> numbers_;  // of the textures
  std::vector<Eigen::Vector3d> positions_;
  TexturedMesh result_;
};

Mesh read_shape_gltf(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return std::move(GltfReader(path, MeshParts::shape).read(frame, {}).mesh);
}

std::uint64_t bytes_of_gltf_textures(const fs::path& path, const Context& context) {
  GltfReader reader(path, MeshParts::sizes);
  reader.read({}, context);
  return reader.textures().bytes();
}

std::uint64_t bytes_to_read_gltf(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return 0;
  const GltfFile file(path);
  const GltfCounts counts = count_items(file, scene_of(file));
  constexpr std::uint64_t kVertex =
      sizeof(Eigen::Vector3d) + sizeof(Eigen::Vector3f) + sizeof(Rgb) + sizeof(Eigen::Vector2d);
  constexpr std::uint64_t kFace = 3 * 12 + sizeof(TexturedMesh::Corners) + 4;
  return file.json_bytes() + file.buffer_bytes() + kVertex * counts.vertices +
         kFace * counts.faces + counts.described_bytes;
}

bool is_textured_gltf(const fs::path& path) {
  const GltfFile file(path);
  return scene_of(file).textured;
}

MeshPlace place_of_gltf(const fs::path& path) {
  GltfFile file(path);
  const GltfScene scene = scene_of(file);
  MeshPlace place;
  if (scene.geo_offset) place.frame.origin = *scene.geo_offset;
  for (const GltfInstance& instance : scene.instances)
    for (const GltfPrimitive& primitive : instance.primitives) {
      const GltfValues positions = file.values(primitive.positions, "VEC3", {5126});
      if (positions.count == 0) continue;
      const Eigen::Vector4d at(positions.at(0, 0), positions.at(0, 1), positions.at(0, 2), 1);
      place.first_vertex = place.frame.to_world((instance.placement * at).head<3>());
      place.is_float = !instance.is_moved;
      if (!place.first_vertex.allFinite()) fail_in(file.name(), "vertex 0 is not finite");
      return place;
    }
  return place;
}

TextureFiles texture_files_of_gltf(const fs::path& path) {
  const GltfFile file(path);
  TextureFiles files;
  files.materials = file.buffer_files();
  for (std::size_t i = 0; i < file.size("images"); ++i) {
    const GltfObject image = file.item("images", i);
    const auto uri = image.text("uri");
    if (uri && !uri->starts_with("data:")) files.textures.push_back(file.data_of(*uri, image).path);
  }
  return files;
}

}  // namespace

TexturedMesh read_textured_gltf(const fs::path& path, const std::optional<LocalFrame>& frame,
                                const Context& context) {
  return GltfReader(path, MeshParts::textured).read(frame, context);
}

const MeshFormat kGltfMeshes{read_textured_gltf,    read_shape_gltf, is_textured_gltf,
                             texture_files_of_gltf, place_of_gltf,   bytes_of_gltf_textures,
                             bytes_to_read_gltf};

}  // namespace axial::io
