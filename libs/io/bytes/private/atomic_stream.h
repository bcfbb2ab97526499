// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: writes a binary file of any size, part by part, that is either complete or
// absent (AtomicFile).
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"
#include "bytes/private/only_for_io.h"

namespace axial::io {

// All functions throw an Error that names the file if it cannot be written.
class AtomicStream {
 public:
  // Opens the temporary file.
  explicit AtomicStream(const std::filesystem::path& path) : file_(path) {
    errno = 0;
    stream_.open(file_.temporary(), std::ios::binary);
    require_good();
  }

  std::string name() const { return file_.path().string(); }

  void write(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    require_good();
  }

  // Writes `header` over the first bytes of the file, and renames the file. Call it once, after the
  // last write().
  void finish(std::string_view header) {
    stream_.seekp(0);
    write(header);
    stream_.close();
    require_good();
    file_.commit();
  }

 private:
  void require_good() const {
    if (!stream_)
      fail_in(name(), "cannot be written: {}", errno ? std::strerror(errno) : "write failed");
  }

  AtomicFile file_;
  std::ofstream stream_;
};

}  // namespace axial::io
