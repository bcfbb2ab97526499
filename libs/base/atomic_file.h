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
// `path`. commit() renames the temporary file to `path` and replaces an existing file there.
// Without commit() the destructor removes the temporary file, and `path` keeps its old content. The
// name of the temporary file has the extension of `path`, because some libraries choose the format
// by the extension.
// If an earlier process was killed while it wrote `path`, its temporary file is still in the
// folder. The constructor removes such files (see remove_abandoned()). The constructor throws an
// Error that names `path` if `path` exists and is not a regular file, because a renamed file would
// replace a device such as /dev/null.
class AtomicFile {
 public:
  // Creates no file yet, and does not check that `path` can be written.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // Flushes the temporary file to the disk and renames it to `path`. The caller must have closed
  // the temporary file. If either step fails, throws an Error that names `path`; `path` then keeps
  // its old content.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
};

// Writes `path` through a temporary file in the same folder. `write` gets the name of the temporary
// file and must close the file before it returns. Then the temporary file is flushed to the disk
// and renamed to `path`. On any failure (unwritable folder, full disk, exception from `write`) the
// temporary file is removed, `path` keeps its old content, and an Error that names `path` is
// thrown. Exception: a std::bad_alloc from `write` reaches the caller unchanged.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

// Writes several files through temporary files. `write` gets the names of the temporary files, in
// the order of `paths`, and must close the files before it returns. First all temporary files are
// flushed to the disk, then they are renamed to `paths` one after the other. If `write` or a flush
// fails, all files of `paths` keep their old content. If a rename fails, the files renamed before
// it have their new content, and the others keep their old content. On any failure the remaining
// temporary files are removed.
// A failed flush or rename throws an Error. In the message of an Error from `write`, each name of a
// temporary file is replaced by the final name. Other exceptions from `write` reach the caller
// unchanged.
void write_together(
    const std::vector<std::filesystem::path>& paths,
    const std::function<void(const std::vector<std::filesystem::path>& temporaries)>& write);

// Writes the files of a folder through a temporary folder, `staging`. `write` gets the name of
// `staging`, which exists and is empty, and creates the files in it and in its subfolders. If
// `folder` does not exist, `staging` is renamed to `folder`, so that `folder` appears at once with
// all its files. If `folder` exists, the new files are moved into it one by one, and its other
// files stay. Files with the names of new files are removed before the first new file is moved. If
// the process is killed between the removal and the last move, some new files are missing, but no
// old file remains in place of a new file.
// If `write` fails, the files in `folder` are unchanged. On any failure `staging` is removed. A
// failed file operation throws an Error that names `folder` or the file. In the message of an Error
// from `write`, the name of `staging` is replaced by the name of `folder`. Other exceptions from
// `write` reach the caller unchanged, except for filesystem_error, which becomes an Error that
// names `folder`.
void write_folder(const std::filesystem::path& folder,
                  const std::function<void(const std::filesystem::path& staging)>& write);

// Writes `bytes` to `path`, with the guarantees of write_atomically() above.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Throws the Error of write_atomically() if `path` cannot be written. A program can call this
// function before it computes for hours. The test creates a temporary file in the folder of `path`
// and removes it again; it does not touch `path`. If an earlier process was killed while it wrote
// `path`, its temporary file is still in the folder. require_writable() removes such files.
void require_writable(const std::filesystem::path& path);

// Throws an Error that names `folder` if write_folder() could not create files in it. `folder` and
// its parents need not exist, because write_folder() creates them. The test creates a temporary
// file in the deepest existing folder of the path and removes it again. Temporary files and folders
// that killed processes left beside or in `folder`, when they wrote it with write_folder(), are
// removed, too.
void require_writable_folder(const std::filesystem::path& folder);

// Creates `folder` and its parents where they are missing. Throws an Error that names `folder` if
// it is not a folder afterwards.
void make_folder(const std::filesystem::path& folder);

// Makes the file `to`, which must not exist, another name of the file `from`: a hard link, or where
// the disk has none a copy, which is complete or absent as by write_atomically(). Makes the folder
// of `to` if it is missing. Throws an Error that names `to` if it cannot be written.
void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to);

// Returns the content of the whole file, byte by byte. Throws an Error that names `path` if it is
// not a regular file, cannot be read, or is larger than `max_bytes` (default: no limit).
std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

// Removes from `folder` the temporary files and folders of this header that killed processes left
// there, if their final names begin with `prefix`. An empty `folder` is the current folder. The
// name of a temporary file contains an identifier of the machine and the number of the process that
// created it. Temporary files of running processes stay. Temporary files of other machines stay for
// a day after their last change. Failures are ignored: what cannot be removed stays, and a folder
// that cannot be read is skipped.
void remove_abandoned(const std::filesystem::path& folder, const std::string& prefix);

}  // namespace axial
