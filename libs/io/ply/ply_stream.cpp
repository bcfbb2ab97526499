// SPDX-License-Identifier: GPL-3.0-or-later
#include "ply/private/ply_stream.h"

#include <algorithm>
#include <system_error>

#include "base/error.h"

namespace axial::io {
namespace {

constexpr std::size_t kBuffer = std::size_t{32} << 20;
constexpr std::size_t kLongestRow = std::size_t{1} << 20;

}  // namespace

PlyStream::PlyStream(const std::filesystem::path& path) : file_(path.string()) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail_in(file_, "is not a regular file");
  size_ = std::filesystem::file_size(path, error);
  in_.open(path, std::ios::binary);
  if (error || !in_) fail_in(file_, "cannot be read");
  fill();
  header_ = parse_ply_header(buffer_, file_);
  position_ = header_.body;
  header_.body = 0;
}

// Drops the bytes before the position and fills the buffer.
void PlyStream::fill() {
  buffer_.erase(0, position_);
  position_ = 0;
  const std::size_t kept = buffer_.size();
  const std::uint64_t wanted = std::min<std::uint64_t>(kBuffer - kept, size_ - end_);
  buffer_.resize(kept + wanted);
  if (!in_.read(buffer_.data() + kept, static_cast<std::streamsize>(wanted)))
    fail_in(file_, "cannot be read");
  end_ += wanted;
}

void PlyStream::for_each_row(const std::function<bool(PlyBody&)>& read) {
  const PlyElement& element = header_.elements.at(next_++);
  const std::uint64_t left = size_ - end_ + buffer_.size() - position_;
  require_rows(element, header_.format, left, file_);
  for (std::uint64_t row = 0; row < element.count;) {
    if (buffer_.size() - position_ < kLongestRow) fill();
    std::string_view bytes = std::string_view(buffer_).substr(position_);
    // A number must not be cut at the end of the buffer.
    if (header_.format == PlyFormat::kAscii && !at_end())
      bytes = bytes.substr(0, bytes.rfind('\n') + 1);
    PlyBody body(bytes, file_, header_);
    const std::size_t spare = at_end() ? 0 : kLongestRow;
    do {
      if (!read(body)) return;
      ++row;
    } while (row < element.count && body.left() >= spare);
    position_ += bytes.size() - body.left();
  }
}

}  // namespace axial::io
