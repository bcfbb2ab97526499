// SPDX-License-Identifier: GPL-3.0-or-later
#include "textured/private/gltf_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parse_number.h"

namespace axial::io {
namespace {

Eigen::Matrix4d moved_by_parts(const GltfObject& node) {
  const std::vector<double> t = node.numbers("translation", 3), r = node.numbers("rotation", 4),
                            s = node.numbers("scale", 3);
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  if (!t.empty()) result.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  if (!r.empty()) {
    Eigen::Quaterniond q(r[3], r[0], r[1], r[2]);  // stored as x, y, z, w
    if (!(q.norm() > 1e-6)) node.refuse("has a rotation of length 0");
    result.rotate(q.normalized());
  }
  if (!s.empty()) result.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  return result.matrix();
}

// The transformation of a node: a matrix, column by column, or translation * rotation * scale.
Eigen::Matrix4d transformation_of(const GltfObject& node) {
  const std::vector<double> m = node.numbers("matrix", 16);
  if (m.empty()) return moved_by_parts(node);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i % 4, i / 4) = m[static_cast<std::size_t>(i)];
  const Eigen::RowVector4d last = matrix.row(3);
  if (!last.isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6))
    node.refuse("has a matrix that is not affine");
  return matrix;
}

void read_geo_offset(const GltfObject& node, GltfScene& scene) {
  const auto extras = node.extras();
  if (!extras) return;
  const std::vector<double> offset = extras->numbers("geo_offset", 3);
  if (offset.empty()) return;
  const Eigen::Vector3d origin(offset[0], offset[1], offset[2]);
  if (scene.geo_offset && *scene.geo_offset != origin)
    node.refuse("has another geo_offset than a node before it");
  scene.geo_offset = origin;
}

void refuse_morphs(const GltfObject& primitive, const GltfObject& mesh, const GltfObject& node) {
  if (primitive.objects("targets").empty()) return;
  std::vector<double> weights = node.numbers("weights", 0);
  if (weights.empty()) weights = mesh.numbers("weights", 0);
  if (std::ranges::any_of(weights, [](double weight) { return weight != 0; }))
    node.refuse("has a mesh with morph targets, which are not supported");
}

GltfPrimitive primitive_of(const GltfObject& object) {
  GltfPrimitive primitive;
  primitive.name = object.name();
  primitive.mode = object.index("mode").value_or(4);
  primitive.indices = object.index("indices");
  primitive.material = object.index("material");
  const auto attributes = object.object("attributes");
  if (!attributes || !attributes->index("POSITION")) object.refuse("has no POSITION");
  primitive.positions = *attributes->index("POSITION");
  primitive.colors = attributes->index("COLOR_0");
  constexpr std::string_view kSet = "TEXCOORD_";
  for (const std::string& key : attributes->keys())
    if (const auto set = parse_number<std::size_t>(key.substr(std::min(key.size(), kSet.size())));
        key.starts_with(kSet) && set)
      primitive.coordinates.emplace_back(*set, attributes->needed_index(key.c_str()));
  return primitive;
}

// Values that are compressed alone have no buffer view, and would count as zeros.
void refuse_compressed(const GltfFile& file, const GltfObject& object,
                       const GltfPrimitive& primitive) {
  constexpr const char* kDraco = "KHR_draco_mesh_compression";
  if (object.extension(kDraco) && !file.item("accessors", primitive.positions).index("bufferView"))
    object.refuse(fmt::format("is compressed by {}, which is not supported", kDraco));
}

std::vector<GltfPrimitive> primitives_of(const GltfFile& file, const GltfObject& node) {
  const GltfObject mesh = file.item("meshes", *node.index("mesh"));
  std::vector<GltfPrimitive> primitives;
  for (const GltfObject& object : mesh.objects("primitives")) {
    const std::size_t mode = object.index("mode").value_or(4);
    if (mode > 6) object.refuse(fmt::format("has the mode {}", mode));
    if (mode < 4) continue;  // points and lines
    refuse_morphs(object, mesh, node);
    primitives.push_back(primitive_of(object));
    refuse_compressed(file, object, primitives.back());
  }
  return primitives;
}

// The nodes that are not the child of a node.
std::vector<std::size_t> roots_of(const GltfFile& file) {
  std::vector<bool> is_child(file.size("nodes"));
  for (std::size_t i = 0; i < is_child.size(); ++i)
    for (const std::size_t child : file.item("nodes", i).indices("children"))
      if (child < is_child.size()) is_child[child] = true;
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  return roots;
}

std::vector<std::size_t> roots_of_default_scene(const GltfFile& file) {
  const auto named = file.root().index("scene");
  if (!named && file.size("scenes") == 0) return roots_of(file);
  return file.item("scenes", named.value_or(0)).indices("nodes");
}

// A small file can show a mesh of many primitives by many nodes, so that the product exhausts the
// memory.
constexpr std::size_t kMostPrimitives = 250'000;

struct PlacedNode {
  std::size_t node;
  Eigen::Matrix4d parent;
};

void add_node(const GltfFile& file, const GltfObject& node, const Eigen::Matrix4d& placement,
              GltfScene& scene) {
  if (!node.index("mesh")) return;
  if (node.index("skin")) node.refuse("has a skin, which is not supported");
  GltfInstance instance{placement, !placement.isIdentity(0), primitives_of(file, node)};
  scene.primitives += instance.primitives.size();
  if (scene.primitives > kMostPrimitives)
    node.refuse(
        fmt::format("exceeds the {} primitives that the nodes may have together", kMostPrimitives));
  for (const GltfPrimitive& primitive : instance.primitives) {
    const GltfMaterial material = material_of(file, primitive);
    scene.textured |= material.image.has_value();
    scene.colored |= primitive.colors || material.factor != Eigen::Vector3d::Ones();
  }
  scene.instances.push_back(std::move(instance));
}

}  // namespace

GltfScene scene_of(const GltfFile& file) {
  GltfScene scene;
  std::vector<bool> visited(file.size("nodes"));
  std::vector<PlacedNode> waiting;
  const auto add = [&](const std::vector<std::size_t>& nodes, const Eigen::Matrix4d& parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
      waiting.push_back({*node, parent});
  };
  add(roots_of_default_scene(file), Eigen::Matrix4d::Identity());
  while (!waiting.empty()) {
    const PlacedNode next = waiting.back();
    waiting.pop_back();
    const GltfObject node = file.item("nodes", next.node);
    if (visited[next.node]) node.refuse("occurs twice in the scene");
    visited[next.node] = true;
    const Eigen::Matrix4d placement = next.parent * transformation_of(node);
    if (!placement.allFinite()) node.refuse("has a transformation that is not finite");
    read_geo_offset(node, scene);
    add_node(file, node, placement, scene);
    add(node.indices("children"), placement);
  }
  return scene;
}

GltfCounts count_items(const GltfFile& file, const GltfScene& scene) {
  GltfCounts counts;
  const auto count_of = [&](std::size_t accessor) {
    const GltfObject object = file.item("accessors", accessor);
    const std::uint64_t count = object.needed_index("count");
    if (count > 0xFFFFFFFFu) object.refuse(fmt::format("has {} values", count));
    if (object.object("sparse") || !object.index("bufferView"))
      counts.described_bytes = std::max(counts.described_bytes, 16 * count);
    return count;
  };
  for (const GltfInstance& instance : scene.instances)
    for (const GltfPrimitive& primitive : instance.primitives) {
      const std::uint64_t vertices = count_of(primitive.positions);
      const std::uint64_t corners = primitive.indices ? count_of(*primitive.indices) : vertices;
      for (const auto& [set, accessor] : primitive.coordinates) count_of(accessor);
      if (primitive.colors) count_of(*primitive.colors);
      counts.vertices += vertices;
      counts.faces += primitive.mode == 4 ? corners / 3 : corners;
    }
  return counts;
}

namespace {

Wrap wrap_of(const GltfObject& sampler, const char* key) {
  switch (sampler.index(key).value_or(10497)) {
    case 10497:
      return Wrap::repeat;
    case 33648:
      return Wrap::mirror;
    case 33071:
      return Wrap::clamp;
    default:
      sampler.refuse(fmt::format("has a {} that is not known", key));
  }
}

// The image of a texture. Extensions may give it an image of another format.
std::size_t image_of(const GltfObject& texture) {
  if (const auto image = texture.index("source")) return *image;
  std::string names;
  if (const auto extensions = texture.object("extensions"))
    for (const std::string& key : extensions->keys()) names += (names.empty() ? "" : ", ") + key;
  texture.refuse(names.empty()
                     ? "has no source"
                     : fmt::format("has its picture only in {}, which is not supported", names));
}

// KHR_texture_transform: offset + rotation * scale * (u, v). The rotation is counter-clockwise as
// one sees the texture, whose v points down, so that the angle r turns (1, 0) to (cos r, -sin r).
// The specification's examples and Khronos's viewer agree on this; a matrix in its text, read
// column by column, would turn the other way.
void read_texture_transform(const GltfObject& info, GltfMaterial& material) {
  const auto transform = info.extension("KHR_texture_transform");
  if (!transform) return;
  const std::vector<double> offset = transform->numbers("offset", 2),
                            scale = transform->numbers("scale", 2);
  const double angle = transform->number("rotation").value_or(0);
  material.turn << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  if (!scale.empty()) material.turn *= Eigen::Vector2d(scale[0], scale[1]).asDiagonal();
  if (!offset.empty()) material.offset = {offset[0], offset[1]};
  material.coordinates = transform->index("texCoord").value_or(material.coordinates);
}

}  // namespace

GltfMaterial material_of(const GltfFile& file, const GltfPrimitive& primitive) {
  GltfMaterial material;
  if (!primitive.material) return material;
  const auto look = file.item("materials", *primitive.material).object("pbrMetallicRoughness");
  if (!look) return material;
  const std::vector<double> factor = look->numbers("baseColorFactor", 4);
  if (!factor.empty()) material.factor = {factor[0], factor[1], factor[2]};
  const auto info = look->object("baseColorTexture");
  if (!info) return material;
  const GltfObject texture = file.item("textures", info->needed_index("index"));
  material.image = image_of(texture);
  material.coordinates = info->index("texCoord").value_or(0);
  if (const auto index = texture.index("sampler")) {
    const GltfObject sampler = file.item("samplers", *index);
    material.wrap = {wrap_of(sampler, "wrapS"), wrap_of(sampler, "wrapT")};
  }
  read_texture_transform(*info, material);
  return material;
}

namespace {

std::vector<std::uint32_t> corners_of(GltfFile& file, const GltfPrimitive& primitive,
                                      std::size_t vertices) {
  std::vector<std::uint32_t> corners;
  if (!primitive.indices) {
    corners.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint32_t>(i);
    return corners;
  }
  const GltfValues values = file.values(*primitive.indices, "SCALAR", {5121, 5123, 5125});
  corners.reserve(values.count);
  for (std::size_t i = 0; i < values.count; ++i) {
    corners.push_back(static_cast<std::uint32_t>(values.at(i)));
    if (corners.back() >= vertices)
      fail_in(file.name(), "{}: a face refers to vertex {}, but there are {}", primitive.name,
              corners.back(), vertices);
  }
  return corners;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of(GltfFile& file,
                                                       const GltfPrimitive& primitive,
                                                       std::size_t vertices) {
  const std::vector<std::uint32_t> c = corners_of(file, primitive, vertices);
  std::vector<std::array<std::uint32_t, 3>> faces;
  if (primitive.mode == 4) {
    if (c.size() % 3 != 0)
      fail_in(file.name(), "{}: the number of corners, {}, is no multiple of 3", primitive.name,
              c.size());
    faces.reserve(c.size() / 3);
    for (std::size_t i = 0; i < c.size(); i += 3) faces.push_back({c[i], c[i + 1], c[i + 2]});
    return faces;
  }
  faces.reserve(c.size());
  for (std::size_t i = 0; i + 2 < c.size(); ++i) {
    // The specification's formulas for strips and fans.
    const std::array<std::uint32_t, 3> face =
        primitive.mode == 5 ? std::array{c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]}
                            : std::array{c[i + 1], c[i + 2], c[0]};
    if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) faces.push_back(face);
  }
  return faces;
}

std::vector<Eigen::Vector2d> coordinates_of(GltfFile& file, const GltfPrimitive& primitive,
                                            const GltfMaterial& material, std::size_t vertices) {
  const auto set = std::ranges::find(primitive.coordinates, material.coordinates,
                                     &std::pair<std::size_t, std::size_t>::first);
  if (set == primitive.coordinates.end())
    fail_in(file.name(), "{} has no TEXCOORD_{}, which its texture needs", primitive.name,
            material.coordinates);
  const GltfValues values = file.values(set->second, "VEC2", {5121, 5123, 5126});
  if (values.component_type != 5126 && !values.normalized)
    fail_in(file.name(),
            "accessors[{}] has texture coordinates of integers that are not normalized",
            set->second);
  if (values.count != vertices)
    fail_in(file.name(), "{} has {} positions, but {} texture coordinates", primitive.name,
            vertices, values.count);
  const bool is_moved = !material.turn.isIdentity(0) || !material.offset.isZero(0);
  std::vector<Eigen::Vector2d> result;
  result.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    Eigen::Vector2d uv(values.at(i, 0), values.at(i, 1));
    if (is_moved) uv = material.turn * uv + material.offset;
    if (!uv.allFinite())
      fail_in(file.name(), "{} has a texture coordinate that is not finite", primitive.name);
    result.push_back(uv);
  }
  return result;
}

GltfValues colors_of(GltfFile& file, std::size_t accessor, std::size_t vertices) {
  const bool has_alpha = file.item("accessors", accessor).text("type") == "VEC4";
  GltfValues values = file.values(accessor, has_alpha ? "VEC4" : "VEC3", {5121, 5123, 5126});
  values.normalized = true;
  if (values.count != vertices)
    fail_in(file.name(), "accessors[{}] has {} colours for {} vertices", accessor, values.count,
            vertices);
  return values;
}

TextureSource picture_of(GltfFile& file, std::size_t index) {
  const GltfObject image = file.item("images", index);
  const auto uri = image.text("uri");
  const auto view = image.index("bufferView");
  if (uri.has_value() == view.has_value()) image.refuse("needs either a uri or a bufferView");
  TextureSource source;
  source.name = fmt::format("{}: image {}", file.name(), index);
  if (view) {
    source.bytes = file.view(*view);
  } else {
    GltfData data = file.data_of(*uri, image);
    source.file = data.path;
    source.bytes = std::move(data.bytes);
  }
  if (source.file.empty() && source.bytes.empty()) image.refuse("has no bytes");
  return source;
}

}  // namespace axial::io
