// SPDX-License-Identifier: GPL-3.0-or-later
// Output files that exist whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace axial {

// A file under way (what killed processes left of the same file goes, see remove_abandoned): what
// is written to `temporary`, beside `path`, becomes `path` by commit(). Without it the temporary
// goes with this object, and `path` keeps what it held before. The temporary's name ends in
// `path`'s own extension, because libraries that open files themselves read it.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // Call it once the temporary is closed. Error that names `path` unless everything reached the
  // disk and the temporary took its name.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
};

// Writes `path` through a temporary file beside it, which is renamed over `path` once `write` has
// returned and everything reached the disk. On any failure (unwritable folder, full disk, an
// exception out of `write`) the temporary is removed, `path` keeps what it held before, and an
// Error that names `path` is thrown. `write` gets the temporary's name.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

// The same for several files, which take their names once all are on the disk. `write` gets the
// temporaries' names, in the order of `paths`.
void write_together(
    const std::vector<std::filesystem::path>& paths,
    const std::function<void(const std::vector<std::filesystem::path>& temporaries)>& write);

// The same for all files, in folders or not, that `write` leaves in the folder `staging`, whose
// name it gets. A `folder` that is not there yet appears with all of them at once. One that is
// there keeps its other files; files of the same names are removed before the new ones take their
// places, so that a kill in between leaves some missing, but never old ones among new. Error that
// names `folder`.
void write_folder(const std::filesystem::path& folder,
                  const std::function<void(const std::filesystem::path& staging)>& write);

// The same as the first for bytes that are in memory.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Fails as write_atomically would if `path` cannot be written, before hours of work: tries a
// temporary file beside it and removes it again. What killed processes left of `path` goes.
void require_writable(const std::filesystem::path& path);

// The same for write_folder, which would make missing parents of `folder`, too.
void require_writable_folder(const std::filesystem::path& folder);

// Creates `folder` and its parents. Error that names it.
void make_folder(const std::filesystem::path& folder);

// The whole file. Error that names `path` if it cannot be read or is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

// Removes what killed processes left half-written in `folder`, of files and folders whose names
// begin with `prefix`. Names of temporaries hold the number of the process; those of living ones
// stay.
void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace axial
