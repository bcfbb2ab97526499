// SPDX-License-Identifier: GPL-3.0-or-later
// Builds small glTF files for tests, independently of the program's writer.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace axial::test {

class GltfBuilder {
 public:
  nlohmann::json json{{"asset", {{"version", "2.0"}}}};
  std::string buffer;

  // Appends values to the buffer and returns the number of a buffer view of them.
  template <class T>
  std::size_t view(const std::vector<T>& values, std::size_t stride = 0) {
    return view_of({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)},
                   stride);
  }
  std::size_t view_of(std::string_view bytes, std::size_t stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    nlohmann::json view{{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    buffer += bytes;
    return added("bufferViews", view);
  }

  std::size_t accessor(std::size_t view, const char* type, int component, std::size_t count,
                       std::size_t offset = 0) {
    return added("accessors", {{"bufferView", view},
                               {"type", type},
                               {"componentType", component},
                               {"count", count},
                               {"byteOffset", offset}});
  }
  std::size_t floats(const std::vector<float>& values, const char* type, std::size_t width) {
    return accessor(view(values), type, 5126, values.size() / width);
  }
  std::size_t positions(const std::vector<float>& values) { return floats(values, "VEC3", 3); }
  std::size_t uv(const std::vector<float>& values) { return floats(values, "VEC2", 2); }
  std::size_t indices(const std::vector<std::uint16_t>& values) {
    return accessor(view(values), "SCALAR", 5123, values.size());
  }

  // Adds an object to a list and returns its number.
  std::size_t added(const char* list, const nlohmann::json& object) {
    json[list].push_back(object);
    return json[list].size() - 1;
  }

  // A mesh of one primitive, and a node of the default scene that uses it.
  nlohmann::json& mesh(const nlohmann::json& attributes) {
    added("meshes", {{"primitives", {{{"attributes", attributes}}}}});
    return json["meshes"].back()["primitives"][0];
  }
  void node(const nlohmann::json& object) {
    const std::size_t number = added("nodes", object);
    json["scenes"][0]["nodes"].push_back(number);
  }

  // A material with the picture `image`.
  std::size_t material(const nlohmann::json& image, const nlohmann::json& info = {},
                       const nlohmann::json& sampler = {}) {
    nlohmann::json texture{{"source", added("images", image)}}, base(info);
    if (!sampler.is_null()) texture["sampler"] = added("samplers", sampler);
    base["index"] = added("textures", texture);
    return added("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", base}}}});
  }

  std::string glb() {
    json["buffers"] = {{{"byteLength", buffer.size()}}};
    return glb_of(json.dump(), buffer);
  }
  // A GLB with this text and buffer.
  static std::string glb_of(std::string text, std::string bin) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4);
    return "glTF" + word(2) + word(28 + text.size() + bin.size()) + word(text.size()) + "JSON" +
           text + word(bin.size()) + std::string("BIN\0", 4) + bin;
  }
  // A .gltf whose buffer is `uri`.
  std::string gltf(const std::string& uri) {
    json["buffers"] = {{{"byteLength", buffer.size()}, {"uri", uri}}};
    return json.dump();
  }

 private:
  static std::string word(std::size_t value) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFF);
    return bytes;
  }
};

// A right triangle, and its corners.
inline const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

}  // namespace axial::test
