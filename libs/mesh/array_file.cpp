// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/array_file.h"

#include <cstdint>
#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"

namespace axial::mesh {
namespace {

constexpr std::size_t kHexDigits = 32;  // of a fingerprint

// Identifies kind and origin in a fixed number of bytes.
std::string head_of(const std::string& kind, const std::string& made_from, std::size_t count) {
  return Fingerprint().add(kind).add(made_from).add(std::uint64_t{count}).hex();
}

std::optional<std::string> next_bytes(std::istream& in, std::uint64_t count, std::uint64_t left) {
  if (count > left) return {};
  std::string bytes(count, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(count))) return {};
  return bytes;
}

}  // namespace

void write_arrays(const std::filesystem::path& file, const std::string& kind,
                  const std::string& made_from, std::span<const std::string_view> arrays) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    Fingerprint print;
    out << head_of(kind, made_from, arrays.size());
    for (const std::string_view array : arrays) {
      const std::uint64_t size = array.size();
      out.write(reinterpret_cast<const char*>(&size), sizeof(size));
      out.write(array.data(), static_cast<std::streamsize>(array.size()));
      print.add(array);
    }
    out << print.hex();
    out.close();
    if (!out) fail("{}: cannot be written", temporary.string());
  });
}

std::optional<std::vector<std::string>> read_arrays(const std::filesystem::path& file,
                                                    const std::string& kind,
                                                    const std::string& made_from,
                                                    std::size_t count) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) return {};
  if (next_bytes(in, kHexDigits, size) != head_of(kind, made_from, count)) return {};
  std::vector<std::string> arrays;
  Fingerprint print;
  while (arrays.size() < count) {
    std::uint64_t bytes = 0;
    if (!in.read(reinterpret_cast<char*>(&bytes), sizeof(bytes))) return {};
    std::optional<std::string> array = next_bytes(in, bytes, size);
    if (!array) return {};
    print.add(*array);
    arrays.push_back(std::move(*array));
  }
  if (next_bytes(in, kHexDigits, size) != print.hex() || in.peek() != EOF) return {};
  return arrays;
}

}  // namespace axial::mesh
