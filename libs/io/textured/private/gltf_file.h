// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the parts of a glTF 2.0 file, .gltf or .glb, with checks of every reference.
// Source of the format: the specification glTF 2.0 of the Khronos Group.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/private/only_for_io.h"

namespace axial::io {

// Types of the chunks of a GLB.
inline constexpr std::uint32_t kGlbJson = 0x4E4F534A, kGlbBinary = 0x004E4942;

// A JSON object of a glTF. Messages name the file and the object: "a.glb: nodes[3].mesh is -1". A
// key that is absent gives an empty result; a value of another type gives an Error. The object
// refers to the GltfFile that made it.
class GltfObject {
 public:
  GltfObject(const std::string& file, std::string name, const nlohmann::json& json);

  const std::string& file() const { return *file_; }
  const std::string& name() const { return name_; }

  std::optional<std::size_t> index(const char* key) const;  // a whole number of at least 0
  std::size_t needed_index(const char* key) const;          // Error if the key is absent
  std::vector<std::size_t> indices(const char* key) const;  // a list of such numbers
  std::optional<double> number(const char* key) const;      // finite
  // A list of `size` finite numbers; any length if `size` is 0. Empty if the key is absent.
  std::vector<double> numbers(const char* key, std::size_t size) const;
  std::optional<std::string> text(const char* key) const;
  std::vector<std::string> texts(const char* key) const;
  bool flag(const char* key) const;  // false if the key is absent
  std::optional<GltfObject> object(const char* key) const;
  std::optional<GltfObject> extras() const;  // nothing if the extras are no object
  std::vector<GltfObject> objects(const char* key) const;
  std::optional<GltfObject> extension(const char* key) const;  // extensions[key]
  std::vector<std::string> keys() const;

  // Error that names the file and the object: "FILE: OBJECT `text`".
  [[noreturn]] void refuse(std::string_view text) const;

 private:
  const std::string* file_;
  std::string name_;
  const nlohmann::json* json_;

  const nlohmann::json* value(const char* key) const;
  // The value at `key`, as take(value) reads it: an optional. Nothing if the key is
  // absent. Error if `take` returns nothing: the value is not `kind`.
  template <class Read>
  auto read(const char* key, std::string_view kind, Read take) const -> decltype(take(*json_));
};

// The values of an accessor. Value i has `components` numbers.
struct GltfValues {
  std::string_view bytes;  // from the first value on
  std::string own_bytes;   // replace `bytes` unless they are empty: values that the file describes
  std::size_t count = 0, stride = 0;
  std::size_t component_type = 0;  // number of the specification, for example 5126 for float
  std::size_t components = 1;

  // The number k of value i. Normalized integers are returned as 0 to 1.
  double at(std::size_t i, std::size_t k = 0) const;
  bool normalized = false;
};

// A file that contains data, or a data URI: exactly one of `path` and `bytes` is used.
struct GltfData {
  std::filesystem::path path;
  std::string bytes;
  bool is_file() const { return !path.empty(); }
};

// Reads the JSON part at once, and buffers when they are needed.
class GltfFile {
 public:
  // Error that names the file if it cannot be read or is malformed, if its version is not 2.x, or
  // if it requires an extension that this reader does not know.
  explicit GltfFile(const std::filesystem::path& path);
  ~GltfFile();

  const std::string& name() const { return name_; }
  GltfObject root() const;

  // The number of objects in a list of the file, for example "nodes".
  std::size_t size(const char* list) const;
  // Object `index` of the list. Error if it does not exist.
  GltfObject item(const char* list, std::size_t index) const;

  // The bytes of a buffer view. Error if they lie outside of their buffer.
  std::string_view view(std::size_t index);

  // The values of an accessor with a type ("VEC3"), and component types of the specification. Error
  // that names the accessor if it has other types, or if its values lie outside of its buffer view.
  GltfValues values(std::size_t index, std::string_view type,
                    std::initializer_list<std::size_t> component_types);

  // The file or the bytes that a URI names. Error that names `owner` for an address in a network.
  GltfData data_of(const std::string& uri, const GltfObject& owner) const;

  // The files of the buffers.
  std::vector<std::filesystem::path> buffer_files() const;

  // Upper bounds of the memory of the JSON part, and of all buffers [bytes].
  std::uint64_t json_bytes() const { return json_bytes_; }
  std::uint64_t buffer_bytes() const;

 private:
  std::string read_json_part();
  void find_chunks(std::uint64_t size);
  std::string read_bytes(std::uint64_t first, std::uint64_t size) const;
  void require_known_format() const;
  const std::string& buffer(std::size_t index);
  std::string_view window(std::size_t view, std::size_t offset, std::size_t bytes,
                          const GltfObject& owner);
  void replace_sparse(const GltfObject& sparse, std::size_t value_bytes, GltfValues& values);

  struct Chunk {
    std::uint64_t first = 0, size = 0;  // place in the file [bytes]
  };

  std::filesystem::path path_;
  std::string name_;
  std::uint64_t file_bytes_ = 0, json_bytes_ = 0;
  std::optional<Chunk> json_chunk_, binary_;  // of a GLB
  std::unique_ptr<nlohmann::json> json_;
  std::vector<std::unique_ptr<std::string>> buffers_;  // that were read
};

}  // namespace axial::io
