// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): ::kill is not in <csignal>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>

#include "base/error.h"
#include "base/hash.h"
#include "base/parse_number.h"
#include "base/without_slash.h"

namespace axial {
namespace {

// Identifies this machine in the names of temporary files, because several machines can write to
// one folder, and the number of a process says nothing on another machine.
std::string machine() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return Fingerprint().add(std::string_view(name.data())).hex().substr(0, 8);
}

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  std::filesystem::path name = path.filename();
  const std::string extension = name.extension().string();
  name.replace_extension();
  name += fmt::format(".{}-{}.tmp{}", machine(), ::getpid(), extension);
  return path.parent_path() / name;
}

// The parts of a name that temporary_beside() made.
struct TemporaryName {
  std::string target;
  pid_t process = 0;
  std::string machine;  // empty: of an earlier version, which did not name the machine
};

// Empty if `name` was not made by temporary_beside().
std::optional<TemporaryName> parse_temporary(std::string_view name) {
  const std::size_t mark = name.rfind(".tmp");
  if (mark == std::string_view::npos || mark == 0) return std::nullopt;
  const std::string_view extension = name.substr(mark + 4);
  if (!extension.empty() && extension.rfind('.') != 0) return std::nullopt;
  const std::size_t dot = name.rfind('.', mark - 1);
  if (dot == std::string_view::npos || dot == 0) return std::nullopt;
  std::string_view number = name.substr(dot + 1, mark - dot - 1), machine;
  if (const std::size_t dash = number.find('-'); dash == 8) {
    machine = number.substr(0, dash);
    number.remove_prefix(dash + 1);
  }
  const auto process = parse_number<pid_t>(number);
  if (!process || *process <= 0) return std::nullopt;
  return TemporaryName{std::string(name.substr(0, dot)).append(extension), *process,
                       std::string(machine)};
}

// Whether the process that created a temporary has ended. The processes of other machines are not
// known: they count as ended a day after the last change of the temporary.
bool has_ended(const TemporaryName& temporary, const std::filesystem::path& path) {
  if (temporary.machine.empty() || temporary.machine == machine())
    return ::kill(temporary.process, 0) != 0 && errno == ESRCH;
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(path, error);
  return !error && std::filesystem::file_time_type::clock::now() - changed > std::chrono::days(1);
}

// The final name of a temporary, or of a temporary of a temporary, whose process has ended. Empty
// for all other names.
std::optional<std::string> abandoned_by(const std::filesystem::path& path) {
  std::optional<TemporaryName> temporary = parse_temporary(path.filename().string());
  if (!temporary || !has_ended(*temporary, path)) return std::nullopt;
  while (const auto inner = parse_temporary(temporary->target)) temporary = inner;
  return temporary->target;
}

// The temporaries that killed processes left in a folder, by their final names.
std::multimap<std::string, std::filesystem::path> abandoned_in(
    const std::filesystem::path& folder) {
  std::multimap<std::string, std::filesystem::path> found;
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder.empty() ? "." : folder, ignored))
    if (auto target = abandoned_by(entry.path())) found.emplace(std::move(*target), entry.path());
  return found;
}

void remove_quietly(const std::filesystem::path& file_or_folder) {
  std::error_code ignored;
  std::filesystem::remove_all(file_or_folder, ignored);
}

void remove_abandoned_of(const std::filesystem::path& path) {
  const auto found = abandoned_in(path.parent_path());
  const auto [begin, end] = found.equal_range(path.filename().string());
  for (auto i = begin; i != end; ++i) remove_quietly(i->second);
}

// The same for every file that this process writes. Each folder is listed only once, when the first
// file is written there, because a folder may get thousands of files.
class AbandonedOnce {
 public:
  void remove_of(const std::filesystem::path& path) {
    const std::lock_guard lock(mutex_);
    const std::filesystem::path folder = path.parent_path();
    if (!folders_.contains(folder)) folders_.emplace(folder, abandoned_in(folder));
    auto& abandoned = folders_.at(folder);
    const auto [begin, end] = abandoned.equal_range(path.filename().string());
    for (auto i = begin; i != end; ++i) remove_quietly(i->second);
    abandoned.erase(begin, end);
  }

 private:
  std::mutex mutex_;
  std::map<std::filesystem::path, std::multimap<std::string, std::filesystem::path>> folders_;
};

AbandonedOnce& abandoned_once() {
  static AbandonedOnce once;
  return once;
}

// Not all libraries that write files report a full disk when they close the file. fsync() does.
void flush_to_disk(const std::filesystem::path& temporary) {
  const int descriptor = ::open(temporary.c_str(), O_RDONLY);
  if (descriptor < 0) fail("the temporary file was removed");
  const int result = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (result != 0 && error != EINVAL && error != EROFS) fail("{}", std::strerror(error));
}

// A file that is renamed to the name of a device or a pipe, such as /dev/null, replaces it.
void require_regular(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  fail_in(path, "cannot be written: is {}",
          std::filesystem::is_directory(status) ? "a folder" : "not a regular file");
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_beside(path_)) {
  require_regular(path_);
  abandoned_once().remove_of(path_);
}

// After a commit() the temporary does not exist any more, and nothing is removed.
AtomicFile::~AtomicFile() {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  try {
    flush_to_disk(temporary_);
    std::filesystem::rename(temporary_, path_);
  } catch (const std::filesystem::filesystem_error& error) {
    fail_in(path_, "cannot be written: {}", error.code().message());
  } catch (const Error& error) {
    fail_in(path_, "cannot be written: {}", error.text());
  }
}

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write) {
  AtomicFile file(path);
  try {
    write(file.temporary());
  } catch (const std::bad_alloc&) {
    throw;  // the file is not the cause
  } catch (const std::filesystem::filesystem_error& error) {
    fail_in(path, "cannot be written: {}", error.code().message());
  } catch (const std::exception& error) {
    fail_in(path, "cannot be written: {}", marked_text(error));
  }
  file.commit();
}

namespace {

// Calls `write`. In the text of an Error from `write`, the name `temporary` is replaced by `named`.
template <class Write>
void write_under_name(const std::filesystem::path& temporary, const std::filesystem::path& named,
                      const Write& write) {
  try {
    write();
  } catch (const Error& error) {
    const std::string from = temporary.string(), to = named.string();
    const auto renamed = [&](std::string text) {
      for (std::size_t at = text.find(from); at != std::string::npos;
           at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
      return text;
    };
    throw Error(renamed(error.text()), renamed(error.file().string()));
  }
}

}  // namespace

void write_together(
    const std::vector<std::filesystem::path>& paths,
    const std::function<void(const std::vector<std::filesystem::path>& temporaries)>& write) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  std::vector<std::filesystem::path> temporaries;
  std::function<void()> work = [&] { write(temporaries); };
  for (const std::filesystem::path& path : paths) {
    const auto& file = files.emplace_back(std::make_unique<AtomicFile>(path));
    temporaries.push_back(file->temporary());
    work = [inner = work, path, temporary = file->temporary()] {
      write_under_name(temporary, path, inner);
    };
  }
  work();
  for (const auto& file : files) flush_to_disk(file->temporary());
  for (const auto& file : files) file->commit();
}

namespace {

// The folder in which the files lie until all are written. The destructor removes it.
class Staging {
 public:
  explicit Staging(const std::filesystem::path& folder)
      : folder_(folder),
        replaces_(!std::filesystem::exists(folder)),
        path_(temporary_beside(replaces_ ? folder : folder / "staging")) {
    remove_abandoned_of(replaces_ ? folder : folder / "staging");
    make_folder(path_);
  }
  ~Staging() { remove_quietly(path_); }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const std::filesystem::path& path() const { return path_; }

  void commit() const {
    if (replaces_)
      std::filesystem::rename(path_, folder_);
    else
      move_files();
  }

 private:
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_))
      if (!entry.is_directory()) found.push_back(entry.path().lexically_relative(path_));
    std::ranges::sort(found);
    return found;
  }

  void move_files() const {
    const std::vector<std::filesystem::path> found = files();
    for (const std::filesystem::path& file : found) {
      make_folder((folder_ / file).parent_path());
      if (std::filesystem::is_directory(folder_ / file))
        fail_in(folder_ / file, "cannot be written: is a folder");
    }
    for (const std::filesystem::path& file : found) std::filesystem::remove(folder_ / file);
    for (const std::filesystem::path& file : found) move(path_ / file, folder_ / file);
  }

  // Copies the file if it cannot be renamed: a folder within `folder_` may be a link to another
  // disk.
  static void move(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (!error) return;
    write_atomically(to, [&](const std::filesystem::path& temporary) {
      std::filesystem::copy_file(from, temporary);
    });
  }

  std::filesystem::path folder_;
  bool replaces_;
  std::filesystem::path path_;
};

}  // namespace

void write_folder(const std::filesystem::path& folder,
                  const std::function<void(const std::filesystem::path& staging)>& write) {
  const std::filesystem::path target = without_slash(folder);
  const Staging staging(target);
  try {
    write_under_name(staging.path(), target, [&] { write(staging.path()); });
    staging.commit();
  } catch (const std::filesystem::filesystem_error& error) {
    fail_in(target, "cannot be written: {}", error.code().message());
  }
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

namespace {

void try_temporary(const std::filesystem::path& temporary, const std::filesystem::path& named) {
  errno = 0;
  const bool opened = std::ofstream(temporary, std::ios::binary).is_open();
  const int error = errno;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  if (!opened) fail_in(named, "cannot be written: {}", std::strerror(error));
}

}  // namespace

void require_writable(const std::filesystem::path& path) {
  require_regular(path);
  remove_abandoned_of(path);
  try_temporary(temporary_beside(path), path);
}

void require_writable_folder(const std::filesystem::path& folder) {
  const std::filesystem::path target = without_slash(folder);
  remove_abandoned_of(target);
  remove_abandoned_of(target / "staging");
  std::filesystem::path deepest = target;
  std::error_code ignored;
  while (!std::filesystem::exists(deepest, ignored) && deepest.has_relative_path())
    deepest = deepest.parent_path();
  try_temporary(temporary_beside(deepest / "staging"), target);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    fail_in(folder, "cannot be created ({})", error.message());
}

void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  make_folder(to.parent_path());
  std::error_code error;
  std::filesystem::create_hard_link(from, to, error);
  if (!error) return;
  if (error == std::errc::file_exists) fail_in(to, "cannot be written: {}", error.message());
  write_atomically(to, [&](const std::filesystem::path& temporary) {
    std::filesystem::copy_file(from, temporary);
  });
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail_in(path, "is a folder, not a file");
  // A pipe could block the reader, and it has no size against which a reader can check counts.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    fail_in(path, "is not a regular file");
  errno = 0;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) fail_in(path, "cannot be opened: {}", std::strerror(errno));
  const auto size = static_cast<std::uintmax_t>(in.tellg());
  if (size > max_bytes) fail_in(path, "{} bytes is too large for this kind of file", size);
  std::string bytes(size, '\0');
  in.seekg(0);
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) fail_in(path, "cannot be read to its end");
  return bytes;
}

void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix) {
  for (const auto& [target, temporary] : abandoned_in(folder))
    if (target.starts_with(prefix)) remove_quietly(temporary);
}

}  // namespace axial
