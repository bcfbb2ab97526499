// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: reads a PLY file of any size through a buffer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "bytes/private/only_for_io.h"
#include "ply/private/ply_header.h"

namespace axial::io {

// Reads the rows of the elements in their order. At most 32 MB of the file are in memory.
class PlyStream {
 public:
  // Opens the file and reads the header. Error that names the file if it cannot be read, or if the
  // header is malformed or longer than the buffer.
  explicit PlyStream(const std::filesystem::path& path);

  const PlyHeader& header() const { return header_; }
  const std::string& file() const { return file_; }

  // Calls `read` for each row of the next element. `read` reads exactly one row from the body, and
  // returns whether more rows are wanted. After `false`, no further element may be read. Error that
  // names the file if it is truncated. Rows of more than 1 MB count as truncated.
  void for_each_row(const std::function<bool(PlyBody&)>& read);

 private:
  void fill();
  bool at_end() const { return end_ == size_; }

  std::string file_;
  std::ifstream in_;
  std::uint64_t size_ = 0;  // of the file
  std::uint64_t end_ = 0;   // the place in the file of the end of the buffer
  std::string buffer_;
  std::size_t position_ = 0;  // of the next row, in the buffer
  PlyHeader header_;
  std::size_t next_ = 0;  // index of the next element
};

// The element vertex of a file. Error that names the file if there is none.
const PlyElement& vertex_element(const PlyStream& stream);

// Calls `read` for each row of the element vertex, and skips the elements before it. No row may
// have been read before. `read`, and Errors: as for PlyStream::for_each_row().
void for_each_vertex(PlyStream& stream, const std::function<bool(PlyBody&)>& read);

}  // namespace axial::io
