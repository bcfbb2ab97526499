// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <limits>
#include <sstream>

#include "base/error.h"
#include "textured/private/textured_writers.h"

namespace axial::io {
namespace {

// A name as an address: glTF wants bytes other than these as %XX.
std::string as_uri(const std::string& name) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string uri;
  for (const char c : name)
    if (kPlain.find(c) != std::string_view::npos)
      uri += c;
    else
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return uri;
}

// Builds a model with one buffer.
class GltfModel {
 public:
  GltfModel() {
    model_.asset.version = "2.0";
    model_.asset.generator = "AxialMVS";
    model_.extensionsUsed = {"KHR_materials_unlit"};
    model_.meshes.emplace_back();
    model_.scenes.emplace_back();
    model_.scenes[0].nodes = {0};
    model_.defaultScene = 0;
    model_.samplers.emplace_back();
    model_.samplers[0].magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    model_.samplers[0].minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    model_.samplers[0].wrapS = model_.samplers[0].wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  }

  void add_node(const LocalFrame& frame) {
    tinygltf::Node& node = model_.nodes.emplace_back();
    node.mesh = 0;
    if (frame.is_world()) return;
    tinygltf::Value::Array offset;
    for (const double coordinate : frame.origin) offset.emplace_back(coordinate);
    node.extras = tinygltf::Value(tinygltf::Value::Object{{"geo_offset", tinygltf::Value(offset)}});
  }

  // A texture in a file of its own.
  void add_texture_file(const std::string& name) { add_texture().uri = as_uri(name); }

  // Prepares the buffer for textures of `bytes` bytes and for `faces` faces.
  void make_room(std::size_t bytes, std::size_t faces) {
    // Three corners at most, each with position and uv, and their indices.
    constexpr std::size_t kOfFace = 3 * (12 + 8 + 4);
    bytes_.reserve(bytes + kOfFace * faces);
  }

  // A texture in the buffer.
  void add_texture_bytes(const Bytes& png) {
    const int view = add_view(png.data(), png.size(), 0);
    tinygltf::Image& image = add_texture();
    image.bufferView = view;
    image.mimeType = "image/png";
  }

  // For each texture, its faces, if there are any.
  void add_primitives(const TexturedMesh& mesh) {
    CornerUnifier unifier(mesh);
    for (std::uint32_t k = 0; k < mesh.textures.size(); ++k)
      add_primitive(mesh, k, unifier.corners_of(k));
  }

  // Writes a file that contains the buffer.
  void write_binary(std::ostream& out) {
    constexpr std::uint64_t kMostBytes = (1ull << 32) - (1ull << 26);  // with room for the text
    if (bytes_.size() > kMostBytes)
      fail("a GLB holds at most 4 GiB, but mesh and textures have {} MB; glTF has no such limit",
           bytes_.size() / 1'000'000);
    model_.buffers.emplace_back().data = std::move(bytes_);
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, out, false, true)) fail("the glTF writer failed");
  }

  // Returns a file that refers to the buffer by the name `uri`, and moves the buffer out.
  GltfFiles files(const std::string& uri) {
    std::ostringstream out;
    // The writer puts a buffer into the text as base64. With a byte in its place, the text is that
    // of a short buffer, whose length and address are then replaced.
    model_.buffers.emplace_back().data.assign(1, 0);
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model_, out, false, false)) fail("the glTF writer failed");
    GltfFiles files{std::move(out).str(), std::move(bytes_)};
    const std::string begin = "\"buffers\":[{\"byteLength\":1,\"uri\":\"";
    const std::size_t at = files.json.find(begin);
    if (at == std::string::npos) fail("the glTF writer has an unknown layout");
    const std::size_t end = files.json.find('"', at + begin.size());
    files.json.replace(at, end - at,
                       fmt::format("\"buffers\":[{{\"byteLength\":{},\"uri\":\"{}",
                                   files.buffer.size(), as_uri(uri)));
    return files;
  }

 private:
  void add_primitive(const TexturedMesh& mesh, std::uint32_t texture,
                     const UnifiedCorners& corners) {
    if (corners.faces.empty()) return;
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector2f> uv;
    for (std::size_t i = 0; i < corners.vertex.size(); ++i) {
      positions.push_back(mesh.mesh.vertices[corners.vertex[i]]);
      uv.push_back(relative(corners.uv[i], mesh.textures[texture].size()));
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(texture);
    primitive.attributes["POSITION"] = add_positions(positions);
    primitive.attributes["TEXCOORD_0"] =
        add_accessor(uv.data(), uv.size(), sizeof(uv[0]), TINYGLTF_TYPE_VEC2,
                     TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.indices =
        add_accessor(corners.faces.data(), 3 * corners.faces.size(), 4, TINYGLTF_TYPE_SCALAR,
                     TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    model_.meshes[0].primitives.push_back(std::move(primitive));
  }

  tinygltf::Image& add_texture() {
    const auto index = static_cast<int>(model_.images.size());
    tinygltf::Texture& texture = model_.textures.emplace_back();
    texture.source = index;
    texture.sampler = 0;
    tinygltf::Material& material = model_.materials.emplace_back();
    material.name = fmt::format("material_{}", index);
    material.doubleSided = true;
    material.pbrMetallicRoughness.baseColorTexture.index = index;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object{});
    return model_.images.emplace_back();
  }

  int add_view(const void* data, std::size_t size, int target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);  // accessors begin at multiples of 4
    tinygltf::BufferView& view = model_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = bytes_.size();
    view.byteLength = size;
    view.target = target;
    const auto* begin = static_cast<const unsigned char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
    return static_cast<int>(model_.bufferViews.size() - 1);
  }

  int add_accessor(const void* data, std::size_t count, std::size_t stride, int type, int component,
                   int target) {
    const int view = add_view(data, count * stride, target);
    tinygltf::Accessor& accessor = model_.accessors.emplace_back();
    accessor.bufferView = view;
    accessor.type = type;
    accessor.componentType = component;
    accessor.count = count;
    return static_cast<int>(model_.accessors.size() - 1);
  }

  int add_positions(const std::vector<Eigen::Vector3f>& positions) {
    const int index =
        add_accessor(positions.data(), positions.size(), sizeof(positions[0]), TINYGLTF_TYPE_VEC3,
                     TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
    Eigen::Vector3f low = positions[0], high = positions[0];
    for (const Eigen::Vector3f& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    for (int k = 0; k < 3; ++k) {
      accessor.minValues.push_back(low[k]);
      accessor.maxValues.push_back(high[k]);
    }
    return index;
  }

  tinygltf::Model model_;
  Bytes bytes_;
};

}  // namespace

GltfFiles textured_gltf(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                        const std::string& binary, const LocalFrame& frame) {
  GltfModel model;
  for (const std::string& name : textures) model.add_texture_file(name);
  model.add_primitives(mesh);
  model.add_node(frame);
  return model.files(binary);
}

void write_textured_glb(std::ostream& out, const TexturedMesh& mesh, std::vector<Bytes> pngs,
                        const LocalFrame& frame) {
  GltfModel model;
  std::size_t bytes = 0;
  for (const Bytes& png : pngs) bytes += png.size() + 4;
  model.make_room(bytes, mesh.mesh.faces.size());
  for (Bytes& png : pngs) {
    model.add_texture_bytes(png);
    Bytes().swap(png);
  }
  model.add_primitives(mesh);
  model.add_node(frame);
  model.write_binary(out);
}

}  // namespace axial::io
