// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/artifacts/array_file.h"

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial::io {
namespace {

constexpr std::size_t kPrintDigits = 32;  // of a fingerprint

// Identifies kind and origin in a fixed number of bytes.
std::string head_of(const Artifact& artifact, std::size_t count) {
  return Fingerprint().add(artifact.kind).add(artifact.made_from).add(std::uint64_t{count}).hex();
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void write_byte_arrays(const Artifact& artifact,
                       std::span<const std::span<const std::byte>> arrays) {
  write_atomically(artifact.file, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    Fingerprint print;
    out << head_of(artifact, arrays.size());
    for (const std::span<const std::byte> array : arrays) {
      const std::uint64_t size = array.size();
      out.write(reinterpret_cast<const char*>(&size), sizeof(size));
      out << text_of(array);
      print.add(text_of(array));
    }
    out << print.hex();
    out.close();
    if (!out) fail_in(temporary, "cannot be written");
  });
}

ArrayReader::ArrayReader(const Artifact& artifact, std::size_t count) {
  std::error_code error;
  size_ = std::filesystem::file_size(artifact.file, error);
  if (!error)
    in_.open(artifact.file, std::ios::binary);  // to open a pipe would wait for its writer
  if (error || next_print() != head_of(artifact, count)) in_.setstate(std::ios::failbit);
}

std::string ArrayReader::next_print() {
  std::string text(kPrintDigits, '\0');
  in_.read(text.data(), kPrintDigits);
  return text;
}

std::uint64_t ArrayReader::next_size() {
  std::uint64_t bytes = 0;
  in_.read(reinterpret_cast<char*>(&bytes), sizeof(bytes));
  if (bytes > size_) in_.setstate(std::ios::failbit);
  return bytes;
}

bool ArrayReader::read_bytes(std::span<std::byte> bytes) {
  in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  print_.add(text_of(bytes));
  return static_cast<bool>(in_);
}

bool ArrayReader::is_whole() {
  return next_print() == print_.hex() && in_.peek() == EOF;
}

}  // namespace axial::io
