// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>

#include "base/error.h"

namespace axial {
namespace {

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  std::filesystem::path name = path.filename();
  const std::string extension = name.extension().string();
  name.replace_extension();
  name += fmt::format(".{}.tmp{}", ::getpid(), extension);
  return path.parent_path() / name;
}

// The number of the process in a name that temporary_beside made; none in any other name.
std::optional<pid_t> process_of_temporary(std::string_view name) {
  const std::size_t mark = name.rfind(".tmp");
  if (mark == std::string_view::npos || mark == 0) return std::nullopt;
  const std::size_t dot = name.rfind('.', mark - 1);
  if (dot == std::string_view::npos) return std::nullopt;
  pid_t process = 0;
  const char* const end = name.data() + mark;
  const auto [stop, error] = std::from_chars(name.data() + dot + 1, end, process);
  if (error != std::errc() || stop != end || process <= 0) return std::nullopt;
  return process;
}

// Libraries that write files by name do not all report a full disk at close; asking the kernel to
// finish the file does.
void flush_to_disk(const std::filesystem::path& temporary) {
  const int descriptor = ::open(temporary.c_str(), O_RDONLY);
  if (descriptor < 0) fail("the temporary file vanished");
  const int result = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (result != 0 && error != EINVAL && error != EROFS) fail("{}", std::strerror(error));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_beside(path_)) {}

// Nothing is left of it after a commit.
AtomicFile::~AtomicFile() {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  try {
    flush_to_disk(temporary_);
    std::filesystem::rename(temporary_, path_);
  } catch (const std::filesystem::filesystem_error& error) {
    fail("{}: cannot be written: {}", path_.string(), error.code().message());
  } catch (const Error& error) {
    fail("{}: cannot be written: {}", path_.string(), error.what());
  }
}

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  AtomicFile file(path);
  try {
    write(file.temporary());
  } catch (const std::filesystem::filesystem_error& error) {
    fail("{}: cannot be written: {}", path.string(), error.code().message());
  } catch (const std::exception& error) {
    fail("{}: cannot be written: {}", path.string(), error.what());
  }
  file.commit();
}

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    if (out) out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (out) out.close();
    if (!out) fail("{}", errno ? std::strerror(errno) : "write failed");
  });
}

void require_writable(const std::filesystem::path& path) {
  const std::filesystem::path temporary = temporary_beside(path);
  errno = 0;
  const bool opened = std::ofstream(temporary, std::ios::binary).is_open();
  const int error = errno;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  if (!opened) fail("{}: cannot be written: {}", path.string(), std::strerror(error));
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    fail("{}: cannot be created ({})", folder.string(), error.message());
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    fail("{}: is a folder, not a file", path.string());
  // A pipe would keep the reader waiting, and has no size to check counts against.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    fail("{}: is not a regular file", path.string());
  errno = 0;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) fail("{}: cannot be opened: {}", path.string(), std::strerror(errno));
  const auto size = static_cast<std::uintmax_t>(in.tellg());
  if (size > max_bytes)
    fail("{}: {} bytes is too large for this kind of file", path.string(), size);
  std::string bytes(size, '\0');
  in.seekg(0);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) fail("{}: cannot be read to its end", path.string());
  return bytes;
}

void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    const std::optional<pid_t> process = process_of_temporary(name);
    if (!name.starts_with(prefix) || !process) continue;
    const bool dead = ::kill(*process, 0) != 0 && errno == ESRCH;
    if (dead) std::filesystem::remove(entry.path(), ignored);
  }
}

}  // namespace axial
