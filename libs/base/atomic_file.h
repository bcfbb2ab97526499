// SPDX-License-Identifier: GPL-3.0-or-later
// Output files that are either complete or absent.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace axial {

// A file that is being written. The caller writes to temporary(), a file in the same folder as
// `path`; commit() renames it to `path`. Without commit() the destructor removes the temporary, and
// `path` keeps its old content. The name of the temporary has the extension of `path`, because some
// libraries choose the format by the extension. The constructor removes temporaries that killed
// processes left of the same `path` (see remove_abandoned).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // Flushes the temporary to the disk and renames it to `path`. Call it after the temporary has
  // been closed. Throws an Error that names `path` if either step fails.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
};

// Writes `path` through a temporary file in the same folder. `write` gets the temporary's name and
// must close the file before it returns. Then the temporary is flushed to the disk and renamed to
// `path`. On any failure (unwritable folder, full disk, exception from `write`) the temporary is
// removed, `path` keeps its old content, and an Error that names `path` is thrown. Only
// std::bad_alloc is passed on as it is.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

// As above for several files. They are renamed after all of them have reached the disk. `write`
// gets the temporaries' names, in the order of `paths`. An Error from `write` is thrown on with the
// final names in place of the temporaries' names.
void write_together(
    const std::vector<std::filesystem::path>& paths,
    const std::function<void(const std::vector<std::filesystem::path>& temporaries)>& write);

// As above for all files that `write` leaves in the folder `staging` and in its subfolders. `write`
// gets the name of `staging`. If `folder` does not exist, it appears at once with all its files. If
// it exists, its other files stay. Files that are to be replaced are removed before the first new
// file is moved to its place: if the process is killed in between, some files are missing, but old
// and new files are never mixed. On failure throws an Error that names `folder` or the file.
void write_folder(const std::filesystem::path& folder,
                  const std::function<void(const std::filesystem::path& staging)>& write);

// Writes `bytes` to `path`, with the guarantees of the first write_atomically().
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Throws the Error of write_atomically() if `path` cannot be written, so that a program can fail
// before hours of work. It creates a temporary file in the same folder and removes it again. It
// also removes temporaries that killed processes left of `path`.
void require_writable(const std::filesystem::path& path);

// The same for write_folder(). `folder` and its parents need not exist, because write_folder()
// creates them: the test is made in the deepest folder of the path that exists.
void require_writable_folder(const std::filesystem::path& folder);

// Creates `folder` and its parents where they are missing. Throws an Error that names `folder` if
// it is not a folder afterwards.
void make_folder(const std::filesystem::path& folder);

// Returns the content of the whole file. Throws an Error that names `path` if it is not a regular
// file, cannot be read, or is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

// Removes temporary files and folders that killed processes left in `folder`, if their final names
// begin with `prefix`. The name of a temporary contains the number of its process. Temporaries of
// running processes stay.
void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace axial
