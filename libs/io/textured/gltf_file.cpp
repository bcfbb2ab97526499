// SPDX-License-Identifier: GPL-3.0-or-later
#include "textured/private/gltf_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "io/bytes/json.h"
#include "textured/private/file_names.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kLargestJson = 256u << 20;

// The extensions that a file may require. Each extension is read, or changes only the light.
constexpr std::array<std::string_view, 14> kKnownExtensions{"KHR_materials_unlit",
                                                            "KHR_texture_transform",
                                                            "KHR_lights_punctual",
                                                            "KHR_materials_anisotropy",
                                                            "KHR_materials_clearcoat",
                                                            "KHR_materials_dispersion",
                                                            "KHR_materials_emissive_strength",
                                                            "KHR_materials_ior",
                                                            "KHR_materials_iridescence",
                                                            "KHR_materials_sheen",
                                                            "KHR_materials_specular",
                                                            "KHR_materials_transmission",
                                                            "KHR_materials_volume",
                                                            "KHR_xmp_json_ld"};

template <class T>
T value_of(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::size_t bytes_of_component(std::size_t component_type) {
  constexpr std::size_t kInt8 = 5120;
  // int8, uint8, int16, uint16, none, uint32, float
  constexpr std::array<std::size_t, 7> kBytes{1, 1, 2, 2, 0, 4, 4};
  const std::size_t at = component_type - kInt8;
  return component_type >= kInt8 && at < kBytes.size() ? kBytes[at] : 0;
}

std::size_t components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 0;
}

// An upper bound of the memory of a JSON value with this text [bytes]. Each value and each key
// follows one of these characters, and needs at most 180 bytes besides its text: a value, a node of
// a map, a node of the keys that must differ, and blocks that grow.
std::uint64_t memory_of_json(std::string_view text) {
  const auto values = std::ranges::count_if(
      text, [](char c) { return c == ',' || c == ':' || c == '[' || c == '{'; });
  return 2 * text.size() + 180 * static_cast<std::uint64_t>(values);
}

}  // namespace

GltfFile::GltfFile(const fs::path& path) : path_(path), name_(path.string()) {
  const std::string text = read_json_part();
  json_bytes_ = memory_of_json(text) + text.size();
  json_ = std::make_unique<Json>(parse_json(without_byte_order_mark(text), name_));
  require_known_format();
  buffers_.resize(size("buffers"));
}

GltfFile::~GltfFile() = default;

std::string GltfFile::read_bytes(std::uint64_t first, std::uint64_t size) const {
  std::ifstream in(path_, std::ios::binary);
  std::string bytes(size, '\0');
  in.seekg(static_cast<std::streamoff>(first));
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) fail_in(name_, "cannot be read");
  return bytes;
}

std::string GltfFile::read_json_part() {
  std::error_code error;
  if (!fs::is_regular_file(path_, error)) return read_file(path_);  // says why
  file_bytes_ = fs::file_size(path_, error);
  if (error) fail_in(name_, "cannot be read");
  if (file_bytes_ < 4 || read_bytes(0, 4) != "glTF") {
    if (lower_extension(path_) == ".glb")
      fail_in(name_, "is not a valid GLB: it does not begin with 'glTF'");
    return read_file(path_, kLargestJson);
  }
  find_chunks(file_bytes_);
  if (json_chunk_->size > kLargestJson)
    fail_in(name_, "its JSON part has {} bytes, more than {} are not read", json_chunk_->size,
            kLargestJson);
  return read_bytes(json_chunk_->first, json_chunk_->size);
}

// The header of a GLB has 12 bytes: "glTF", version, length. Each chunk has a length and a type in
// front of its bytes.
void GltfFile::find_chunks(std::uint64_t size) {
  if (size < 12) fail_in(name_, "truncated: a GLB has at least 12 bytes");
  const std::string header = read_bytes(0, 12);
  const auto version = value_of<std::uint32_t>(header, 4);
  const auto length = value_of<std::uint32_t>(header, 8);
  if (version != 2) fail_in(name_, "is a GLB of version {}, but only version 2 is read", version);
  if (length != size)
    fail_in(name_, "{}: its header states {} bytes, but the file has {}",
            length > size ? "truncated" : "malformed", length, size);
  for (std::uint64_t at = 12; at < size;) {
    if (size - at < 8) fail_in(name_, "malformed: {} bytes follow the last chunk", size - at);
    const std::string chunk = read_bytes(at, 8);
    const Chunk place{at + 8, value_of<std::uint32_t>(chunk, 0)};
    const auto type = value_of<std::uint32_t>(chunk, 4);
    if (place.size > size - place.first)
      fail_in(name_, "truncated: a chunk of {} bytes ends outside of the file", place.size);
    if (!json_chunk_ && type != kGlbJson) fail_in(name_, "the first chunk is not JSON");
    if (!json_chunk_)
      json_chunk_ = place;
    else if (type == kGlbBinary && !binary_)
      binary_ = place;
    at = place.first + place.size;
  }
  if (!json_chunk_) fail_in(name_, "truncated: the GLB has no JSON chunk");
}

void GltfFile::require_known_format() const {
  const auto asset = root().object("asset");
  if (!asset) fail_in(name_, "is not a glTF file: it has no asset");
  const std::string version = asset->text("version").value_or("");
  if (!version.starts_with("2.")) {
    if (version.empty()) asset->refuse("has no version");
    asset->refuse(fmt::format("has the version {}, but only 2.x is read", version));
  }
  for (const std::string& extension : root().texts("extensionsRequired"))
    if (std::ranges::find(kKnownExtensions, extension) == kKnownExtensions.end())
      fail_in(name_, "requires the extension {}, which is not supported", extension);
}

GltfObject GltfFile::root() const {
  return {name_, "glTF", *json_};
}

std::size_t GltfFile::size(const char* list) const {
  const auto found = json_->find(list);
  if (found == json_->end()) return 0;
  if (!found->is_array()) fail_in(name_, "{} is not a list", list);
  return found->size();
}

GltfObject GltfFile::item(const char* list, std::size_t index) const {
  const std::size_t count = size(list);
  if (index >= count) fail_in(name_, "{}[{}] does not exist: there are {}", list, index, count);
  return {name_, fmt::format("{}[{}]", list, index), (*json_)[list][index]};
}

GltfData GltfFile::data_of(const std::string& uri, const GltfObject& owner) const {
  if (uri.starts_with("data:"))
    return {{}, bytes_of_data_uri(uri, owner.file() + ": " + owner.name())};
  const std::size_t colon = uri.find(':');
  if (colon != std::string::npos && colon > 1 && colon < uri.find('/'))
    owner.refuse(fmt::format("is at {}, but only files are read", uri));
  GltfData data{file_of_uri(path_.parent_path(), uri), {}};
  if (data.path.native().find('\0') != std::string::npos)
    owner.refuse("names a file with a NUL byte");
  return data;
}

std::vector<fs::path> GltfFile::buffer_files() const {
  std::vector<fs::path> files;
  for (std::size_t i = 0; i < size("buffers"); ++i) {
    const GltfObject buffer = item("buffers", i);
    const auto uri = buffer.text("uri");
    if (uri && !uri->starts_with("data:")) files.push_back(data_of(*uri, buffer).path);
  }
  return files;
}

std::uint64_t GltfFile::buffer_bytes() const {
  std::uint64_t bytes = binary_ ? binary_->size : 0;
  for (std::size_t i = 0; i < size("buffers"); ++i) {
    const auto uri = item("buffers", i).text("uri");
    if (uri && uri->starts_with("data:")) bytes += 2 * uri->size();
  }
  for (const fs::path& file : buffer_files()) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error) bytes += size;
  }
  return bytes;
}

const std::string& GltfFile::buffer(std::size_t index) {
  const GltfObject object = item("buffers", index);
  if (buffers_[index]) return *buffers_[index];
  std::string bytes;
  if (const auto uri = object.text("uri")) {
    GltfData data = data_of(*uri, object);
    bytes = data.is_file() ? read_file(data.path) : std::move(data.bytes);
  } else if (index == 0 && binary_) {
    bytes = read_bytes(binary_->first, binary_->size);
  } else {
    object.refuse("has no uri, and the file holds no bytes for it");
  }
  const std::size_t length = object.needed_index("byteLength");
  if (bytes.size() < length)
    object.refuse(fmt::format("should have {} bytes, but there are {}", length, bytes.size()));
  bytes.resize(length);
  buffers_[index] = std::make_unique<std::string>(std::move(bytes));
  return *buffers_[index];
}

std::string_view GltfFile::view(std::size_t index) {
  const GltfObject view = item("bufferViews", index);
  const std::string& bytes = buffer(view.needed_index("buffer"));
  const std::size_t offset = view.index("byteOffset").value_or(0);
  const std::size_t length = view.needed_index("byteLength");
  if (offset > bytes.size() || length > bytes.size() - offset)
    view.refuse("ends outside of its buffer");
  return std::string_view(bytes).substr(offset, length);
}

// `bytes` bytes of a buffer view, from `offset` on.
std::string_view GltfFile::window(std::size_t index, std::size_t offset, std::size_t bytes,
                                  const GltfObject& owner) {
  const std::string_view all = view(index);
  if (offset > all.size() || bytes > all.size() - offset)
    owner.refuse("ends outside of its buffer view");
  return all.substr(offset, bytes);
}

GltfValues GltfFile::values(std::size_t index, std::string_view type,
                            std::initializer_list<std::size_t> component_types) {
  const GltfObject accessor = item("accessors", index);
  GltfValues values;
  values.component_type = accessor.needed_index("componentType");
  values.count = accessor.needed_index("count");
  values.normalized = accessor.flag("normalized");
  if (accessor.text("type") != type ||
      std::ranges::find(component_types, values.component_type) == component_types.end())
    accessor.refuse(fmt::format("has the type {} and the componentType {}, which its use excludes",
                                accessor.text("type").value_or("none"), values.component_type));
  values.components = components_of(type);
  const std::size_t size = values.components * bytes_of_component(values.component_type);
  values.stride = size;
  const auto view_index = accessor.index("bufferView");
  const auto sparse = accessor.object("sparse");
  if (!view_index &&
      values.count > file_bytes_ + buffer_bytes())  // a small file must not describe huge values
    accessor.refuse(fmt::format("has {} values, but no bufferView", values.count));
  if (!view_index) {
    values.own_bytes.assign(values.count * size, '\0');
  } else {
    const GltfObject view = item("bufferViews", *view_index);
    values.stride = view.index("byteStride").value_or(size);
    if (values.stride < size) view.refuse("has a byteStride below the size of its values");
    const std::size_t offset = accessor.index("byteOffset").value_or(0);
    const std::string_view all = this->view(*view_index);
    if (values.count > 0 && (offset > all.size() || all.size() - offset < size ||
                             values.count - 1 > (all.size() - offset - size) / values.stride))
      accessor.refuse("ends outside of its buffer view");
    if (values.count > 0) values.bytes = all.substr(offset);
  }
  if (sparse) replace_sparse(*sparse, size, values);
  return values;
}

void GltfFile::replace_sparse(const GltfObject& sparse, std::size_t value_bytes,
                              GltfValues& values) {
  const bool copied = values.own_bytes.empty();
  if (copied) values.own_bytes.reserve(values.count * value_bytes);
  if (copied)
    for (std::size_t i = 0; i < values.count; ++i)
      values.own_bytes += values.bytes.substr(i * values.stride, value_bytes);
  values.stride = value_bytes;
  const std::size_t count = sparse.needed_index("count");
  const auto indices = sparse.object("indices"), replacing = sparse.object("values");
  if (!indices || !replacing) sparse.refuse("has no indices or no values");
  if (count > values.count) sparse.refuse("replaces more values than there are");
  GltfValues places;
  places.component_type = indices->needed_index("componentType");
  places.stride = bytes_of_component(places.component_type);
  places.count = count;
  if (places.component_type != 5121 && places.component_type != 5123 &&
      places.component_type != 5125)
    indices->refuse("has a componentType of no indices");
  places.bytes = window(indices->needed_index("bufferView"),
                        indices->index("byteOffset").value_or(0), count * places.stride, *indices);
  const std::string_view bytes =
      window(replacing->needed_index("bufferView"), replacing->index("byteOffset").value_or(0),
             count * value_bytes, *replacing);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = static_cast<std::size_t>(places.at(i));
    if (place >= values.count) indices->refuse(fmt::format("names the value {}", place));
    bytes.copy(values.own_bytes.data() + place * value_bytes, value_bytes, i * value_bytes);
  }
}

double GltfValues::at(std::size_t i, std::size_t k) const {
  const std::string_view all = own_bytes.empty() ? bytes : std::string_view(own_bytes);
  const std::size_t first = i * stride;
  switch (component_type) {
    case 5121: {
      const double value = value_of<std::uint8_t>(all, first + k);
      return normalized ? value / 255 : value;
    }
    case 5123: {
      const double value = value_of<std::uint16_t>(all, first + 2 * k);
      return normalized ? value / 65535 : value;
    }
    case 5125:
      return value_of<std::uint32_t>(all, first + 4 * k);
    default:
      return static_cast<double>(value_of<float>(all, first + 4 * k));
  }
}

}  // namespace axial::io
