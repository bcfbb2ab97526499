// SPDX-License-Identifier: GPL-3.0-or-later
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "private/images/image_codecs.h"
#include "private/textured/textured_readers.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Does nothing: images are decoded later from their part of the buffer.
bool leave_encoded(tinygltf::Image*, int, std::string*, std::string*, int, int,
                   const unsigned char*, int, void*) {
  return true;
}

// A GLB is a single file, so no other file is read.
tinygltf::FsCallbacks no_files() {
  return {
      [](const std::string&, void*) { return false; },
      [](const std::string& name, void*) { return name; },
      [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
      [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
      },
      nullptr};
}

tinygltf::Model parsed(const std::string& bytes, const std::string& file) {
  if (bytes.size() > std::numeric_limits<unsigned>::max())
    fail("{}: is larger than 4 GiB, which a GLB cannot be", file);
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(leave_encoded, nullptr);
  reader.SetFsCallbacks(no_files());
  std::string error, warning;
  bool good = false;
  try {
    good = reader.LoadBinaryFromMemory(&model, &error, &warning,
                                       reinterpret_cast<const unsigned char*>(bytes.data()),
                                       static_cast<unsigned>(bytes.size()), "");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // the library uses an object that the file does not have
    error = "the objects of its JSON part do not fit together";
  }
  if (good) return model;
  const std::string first = error.substr(0, error.find('\n'));
  fail("{}: is not a valid GLB: {}", file, first.empty() ? "no cause is known" : first);
}

class GlbReader {
 public:
  // `textured`: false to read vertices and faces only.
  GlbReader(const std::string& bytes, std::string file, bool textured)
      : file_(std::move(file)), textured_(textured), model_(parsed(bytes, file_)) {}

  // Other images are not read, and may have a format that the program does not know.
  std::vector<ImageHeader> color_headers() const {
    std::set<int> images;
    for (const tinygltf::Material& material : model_.materials)
      if (const int texture = material.pbrMetallicRoughness.baseColorTexture.index; texture >= 0)
        images.insert(item(model_.textures, texture, "texture").source);
    std::vector<ImageHeader> headers;
    for (const int k : images) {
      const std::span<const unsigned char> bytes =
          bytes_of(item(model_.images, k, "image").bufferView);
      headers.push_back(
          image_header_of({bytes.begin(), bytes.end()}, fmt::format("{}: image {}", file_, k)));
    }
    return headers;
  }

  TexturedMesh read(const std::optional<LocalFrame>& frame) {
    for (const tinygltf::Node& node : model_.nodes) read_node(node);
    for (const tinygltf::Mesh& mesh : model_.meshes)
      for (const tinygltf::Primitive& primitive : mesh.primitives) add(primitive);
    if (result_.mesh.faces.empty()) fail("{}: the mesh has no faces", file_);
    result_.mesh.vertices = placed_in(frame, positions_, offset_, file_);
    return std::move(result_);
  }

 private:
  // The values of an accessor.
  struct Values {
    const unsigned char* first = nullptr;
    std::size_t count = 0, stride = 0;

    template <class T>
    T at(std::size_t i, std::size_t k = 0) const {
      T value;
      std::memcpy(&value, first + i * stride + k * sizeof(T), sizeof(T));
      return value;
    }
  };

  template <class Item>
  const Item& item(const std::vector<Item>& all, int index, const char* kind) const {
    if (index < 0 || static_cast<std::size_t>(index) >= all.size())
      fail("{}: the {} {} does not exist", file_, kind, index);
    return all[static_cast<std::size_t>(index)];
  }

  // The bytes of a part of a buffer.
  std::span<const unsigned char> bytes_of(int view_index) const {
    const tinygltf::BufferView& view = item(model_.bufferViews, view_index, "buffer view");
    const tinygltf::Buffer& buffer = item(model_.buffers, view.buffer, "buffer");
    if (view.byteOffset > buffer.data.size() ||
        view.byteLength > buffer.data.size() - view.byteOffset)
      fail("{}: the buffer view {} ends outside its buffer", file_, view_index);
    return std::span(buffer.data).subspan(view.byteOffset, view.byteLength);
  }

  Values values_of(int index, int type, std::initializer_list<int> components,
                   const char* name) const {
    const tinygltf::Accessor& accessor = item(model_.accessors, index, "accessor");
    if (accessor.type != type ||
        std::ranges::find(components, accessor.componentType) == components.end() ||
        accessor.sparse.isSparse)
      fail("{}: the {} of a primitive are of a type that is not supported", file_, name);
    const std::span<const unsigned char> bytes = bytes_of(accessor.bufferView);
    const auto size = static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(
                          static_cast<std::uint32_t>(accessor.componentType))) *
                      static_cast<std::size_t>(
                          tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    const std::size_t given =
        model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = given == 0 ? size : given;
    const std::size_t left = bytes.size() - std::min(bytes.size(), accessor.byteOffset);
    if (accessor.count > 0 && (left < size || (accessor.count - 1) > (left - size) / stride))
      fail("{}: the {} of a primitive end outside their buffer view", file_, name);
    return {bytes.data() + std::min(bytes.size(), accessor.byteOffset), accessor.count, stride};
  }

  int attribute(const tinygltf::Primitive& primitive, const char* name) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) fail("{}: a primitive has no {}", file_, name);
    return found->second;
  }

  void read_node(const tinygltf::Node& node) {
    if (!node.matrix.empty() || !node.rotation.empty() || !node.scale.empty() ||
        !node.translation.empty())
      fail("{}: a node has a transformation, which is not supported", file_);
    if (!node.extras.Has("geo_offset")) return;
    const tinygltf::Value& offset = node.extras.Get("geo_offset");
    if (offset.ArrayLen() != 3) fail("{}: geo_offset is not a list of three numbers", file_);
    Eigen::Vector3d origin;
    for (int k = 0; k < 3; ++k) {
      const tinygltf::Value& number = offset.Get(k);
      if (!number.IsNumber() || !std::isfinite(number.GetNumberAsDouble()))
        fail("{}: geo_offset is not a list of three numbers", file_);
      origin[k] = number.GetNumberAsDouble();
    }
    offset_ = origin;
  }

  // Returns the index of the texture of a material. Reads the texture at the first call for it.
  std::uint32_t texture_of(int material_index) {
    const tinygltf::Material& material = item(model_.materials, material_index, "material");
    const tinygltf::Texture& texture =
        item(model_.textures, material.pbrMetallicRoughness.baseColorTexture.index, "texture");
    const tinygltf::Image& image = item(model_.images, texture.source, "image");
    for (std::size_t k = 0; k < sources_.size(); ++k)
      if (sources_[k] == texture.source) return static_cast<std::uint32_t>(k);
    const std::span<const unsigned char> bytes = bytes_of(image.bufferView);
    result_.textures.push_back(decode_color_image(
        {bytes.begin(), bytes.end()}, fmt::format("{}: image {}", file_, texture.source)));
    sources_.push_back(texture.source);
    return static_cast<std::uint32_t>(sources_.size() - 1);
  }

  std::vector<std::uint32_t> indices_of(const tinygltf::Primitive& primitive,
                                        std::size_t vertices) const {
    const Values values = values_of(
        primitive.indices, TINYGLTF_TYPE_SCALAR,
        {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT}, "indices");
    const bool wide = model_.accessors[static_cast<std::size_t>(primitive.indices)].componentType ==
                      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (values.count % 3 != 0) fail("{}: the number of indices is no multiple of 3", file_);
    std::vector<std::uint32_t> indices(values.count);
    for (std::size_t i = 0; i < values.count; ++i) {
      indices[i] = wide ? values.at<std::uint32_t>(i) : values.at<std::uint16_t>(i);
      if (indices[i] >= vertices)
        fail("{}: a face refers to vertex {}, but its primitive has {}", file_, indices[i],
             vertices);
    }
    return indices;
  }

  void add(const tinygltf::Primitive& primitive) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
      fail("{}: a primitive is not made of triangles", file_);
    const Values positions = values_of(attribute(primitive, "POSITION"), TINYGLTF_TYPE_VEC3,
                                       {TINYGLTF_COMPONENT_TYPE_FLOAT}, "positions");
    const std::vector<std::uint32_t> indices = indices_of(primitive, positions.count);
    const auto before = static_cast<std::uint32_t>(positions_.size());
    for (std::size_t i = 0; i < positions.count; ++i)
      positions_.push_back(vector_at<3>(positions, i));
    for (std::size_t i = 0; i < indices.size(); i += 3)
      result_.mesh.faces.push_back(
          {before + indices[i], before + indices[i + 1], before + indices[i + 2]});
    if (textured_) add_uv(primitive, positions.count, indices);
  }

  void add_uv(const tinygltf::Primitive& primitive, std::size_t vertices,
              const std::vector<std::uint32_t>& indices) {
    const Values uv = values_of(attribute(primitive, "TEXCOORD_0"), TINYGLTF_TYPE_VEC2,
                                {TINYGLTF_COMPONENT_TYPE_FLOAT}, "texture coordinates");
    if (uv.count != vertices)
      fail("{}: a primitive has {} positions, but {} texture coordinates", file_, vertices,
           uv.count);
    const std::uint32_t texture = texture_of(primitive.material);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      auto& corners = result_.uv.emplace_back();
      result_.texture_of.push_back(texture);
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector2d at = vector_at<2>(uv, indices[i + k]);
        corners[k] = pixel_of({at.x(), 1 - at.y()}, result_.textures[texture].size());
        if (!corners[k].allFinite())
          fail("{}: a texture coordinate is not finite or too large", file_);
      }
    }
  }

  template <int kSize>
  static Eigen::Matrix<double, kSize, 1> vector_at(const Values& values, std::size_t i) {
    Eigen::Matrix<double, kSize, 1> vector;
    for (int k = 0; k < kSize; ++k)
      vector[k] = static_cast<double>(values.at<float>(i, static_cast<std::size_t>(k)));
    return vector;
  }

  std::string file_;
  bool textured_;
  tinygltf::Model model_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<int> sources_;  // the image of each texture of `result_`
  std::optional<Eigen::Vector3d> offset_;
  TexturedMesh result_;
};

}  // namespace

std::vector<ImageHeader> color_headers_of_glb(const fs::path& path) {
  return GlbReader(read_file(path), path.string(), true).color_headers();
}

TexturedMesh read_textured_glb(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return GlbReader(read_file(path), path.string(), true).read(frame);
}

Mesh read_shape_glb(const fs::path& path, const std::optional<LocalFrame>& frame) {
  return std::move(GlbReader(read_file(path), path.string(), false).read(frame).mesh);
}

}  // namespace axial::io
