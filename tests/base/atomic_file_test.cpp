// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "support/empty_folder.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, TellsBeforeTheWorkThatAFileCannotBeWritten) {
  const fs::path folder = test::empty_folder();
  EXPECT_NO_THROW(require_writable(folder / "a.txt"));
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_THROW(require_writable(folder / "no_such_folder" / "a.txt"), Error);
  fs::remove_all(folder);
}

// A renamed file would replace a device, too: /dev/null, if root writes to it.
TEST(AtomicFile, ReplacesNoPipe) {
  const fs::path folder = test::empty_folder();
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(require_writable(pipe), Error);
  EXPECT_THROW(write_atomically(pipe, "text"), Error);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(files_in(folder), 1u);
  fs::remove_all(folder);
}

TEST(AtomicFile, KeepsTheOldContentsWhenTheWriterFails) {
  const fs::path folder = test::empty_folder();
  const fs::path file = folder / "a.txt";
  write_atomically(file, "old");
  EXPECT_THROW(write_atomically(file,
                                [](const fs::path& temporary) {
                                  write_atomically(temporary, "half");
                                  fail("no more ink");
                                }),
               Error);
  EXPECT_EQ(read_file(file), "old");
  EXPECT_EQ(files_in(folder), 1u);
  fs::remove_all(folder);
}

TEST(AtomicFile, NamesTheFileThatCannotBeWritten) {
  try {
    write_atomically("/no/such/folder/a.txt", "x");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/no/such/folder/a.txt"));
  }
}

// While the object exists, no file of this process can grow beyond `bytes`. Writing more fails as
// on a full disk. The limit works on every file system.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AtomicFile, ReportsAFullDiskAndLeavesNothingBehind) {
  const fs::path folder = test::empty_folder();
  const fs::path file = folder / "a.txt";
  write_atomically(file, "old");
  // The limits are within the first buffer, after the first buffers, and before the last byte.
  for (const rlim_t limit : {1, 5000, 99999}) {
    std::string message;
    {
      const FileSizeLimit full(limit);
      try {
        write_atomically(file, std::string(100000, 'x'));
      } catch (const Error& error) {
        message = error.what();
      }
    }
    EXPECT_THAT(message, testing::HasSubstr(file.string()));
    EXPECT_THAT(message, testing::HasSubstr("too large"));  // the system's text for this limit
    EXPECT_EQ(read_file(file), "old");
    EXPECT_EQ(files_in(folder), 1u);
  }
  write_atomically(file, std::string(100000, 'x'));
  EXPECT_EQ(read_file(file).size(), 100000u);
  fs::remove_all(folder);
}

// The number of a process that has ended.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

TEST(AtomicFile, RemovesOnlyTemporariesOfDeadProcesses) {
  const fs::path folder = test::empty_folder();
  const pid_t dead = dead_process();
  const std::vector<std::string> abandoned = {fmt::format("depth0.{}.tmp.dmap", dead),
                                              fmt::format("depth0.{0}.tmp.{0}.tmp.dmap", dead),
                                              fmt::format("depth0.{}.tmp", dead)};
  const std::vector<std::string> kept = {fmt::format("depth0.{}.tmp.dmap", ::getpid()),
                                         fmt::format("other.{}.tmp.dmap", dead),
                                         "depth0.dmap",
                                         "depth0.tmp.dmap",
                                         "depth0.x1.tmp.dmap",
                                         "depth0.-1.tmp.dmap",
                                         "depth0.99999999999.tmp.dmap"};
  for (const std::string& name : abandoned) std::ofstream(folder / name) << "x";
  for (const std::string& name : kept) std::ofstream(folder / name) << "x";
  remove_abandoned(folder, "depth");
  for (const std::string& name : abandoned) EXPECT_FALSE(fs::exists(folder / name)) << name;
  for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder / name)) << name;
  fs::remove_all(folder);
}

// Several machines write to one folder. A process of another machine can run although its number is
// free here.
TEST(AtomicFile, KeepsTemporariesOfOtherMachinesForADay) {
  const fs::path folder = test::empty_folder();
  const pid_t dead = dead_process();
  const std::string mine = AtomicFile(folder / "depth0.dmap").temporary().filename().string();
  const std::string machine = mine.substr(std::string("depth0.").size(), 8);
  const std::string ended = fmt::format("depth0.{}-{}.tmp.dmap", machine, dead);
  ASSERT_EQ(mine, fmt::format("depth0.{}-{}.tmp.dmap", machine, ::getpid()));
  const std::string fresh = fmt::format("depth0.{}-{}.tmp.dmap", "00000000", dead);
  const std::string old = fmt::format("depth0.{}-{}.tmp.dmap", "00000001", dead);
  for (const std::string& name : {mine, ended, fresh, old}) std::ofstream(folder / name) << "x";
  fs::last_write_time(folder / old, fs::file_time_type::clock::now() - std::chrono::hours(25));
  remove_abandoned(folder, "depth");
  for (const std::string& name : {mine, fresh}) EXPECT_TRUE(fs::exists(folder / name)) << name;
  for (const std::string& name : {ended, old}) EXPECT_FALSE(fs::exists(folder / name)) << name;
  fs::remove_all(folder);
}

TEST(AtomicFile, LeavesNothingWithoutACommit) {
  const fs::path folder = test::empty_folder();
  write_atomically(folder / "a.txt", "old");
  for (const bool commit : {false, true}) {
    AtomicFile file(folder / "a.txt");
    write_atomically(file.temporary(), "new");
    EXPECT_EQ(files_in(folder), 2u);
    EXPECT_EQ(read_file(folder / "a.txt"), "old");
    if (commit) file.commit();
  }
  EXPECT_EQ(files_in(folder), 1u);
  EXPECT_EQ(read_file(folder / "a.txt"), "new");
  fs::remove_all(folder);
}

TEST(AtomicFile, KeepsTheExtensionOfTheTemporary) {
  const fs::path folder = test::empty_folder();
  write_atomically(folder / "a.b.tiff", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.extension(), ".tiff");
    EXPECT_EQ(temporary.parent_path(), folder);
    EXPECT_NE(temporary.filename(), "a.b.tiff");
    write_atomically(temporary, "x");
  });
  EXPECT_EQ(read_file(folder / "a.b.tiff"), "x");
  fs::remove_all(folder);
}

TEST(AtomicFile, FailsWhereTheWriterWroteNothing) {
  const fs::path folder = test::empty_folder();
  EXPECT_THROW(write_atomically(folder / "a.txt", [](const fs::path&) {}), Error);
  fs::create_directories(folder / "b.txt" / "c");
  EXPECT_THROW(write_atomically(folder / "b.txt", "x"), Error);  // a folder has this name
  EXPECT_EQ(files_in(folder), 1u);
  fs::remove_all(folder);
}

TEST(ReadFile, ReadsBytesAsTheyAre) {
  const fs::path folder = test::empty_folder();
  const std::string bytes("a\0\r\n\xFF", 5);
  write_atomically(folder / "a", bytes);
  EXPECT_EQ(read_file(folder / "a"), bytes);
  EXPECT_EQ(read_file(folder / "a", 5), bytes);
  write_atomically(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "empty"), "");
  for (const fs::path& file : {folder / "missing", folder}) {
    try {
      read_file(file);
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(file.string()));
    }
  }
  EXPECT_THROW(read_file(folder / "a", 4), Error);
  fs::remove_all(folder);
}

// The names and contents of all files below a folder.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      contents[entry.path().lexically_relative(folder)] = read_file(entry.path());
  return contents;
}

TEST(AtomicFile, LosesWhatKilledProcessesLeftOfIt) {
  const fs::path folder = test::empty_folder();
  const pid_t dead = dead_process();
  const std::string mine = fmt::format("cloud.{}.tmp.ply", dead);
  const std::string twice = fmt::format("cloud.{0}.tmp.{0}.tmp.ply", dead);
  const std::vector<std::string> kept = {
      fmt::format("other.{}.tmp.ply", dead), fmt::format("cloud.{}.tmp.mvs", dead),
      fmt::format("cloud2.{}.tmp.ply", dead), fmt::format("cloud.{}.tmp.ply", ::getppid())};
  for (const std::string& name : kept) std::ofstream(folder / name) << "x";
  // Temporaries are removed by require_writable() and when the file is written. Writing lists a
  // folder only once, so that this case comes first.
  for (const bool before : {false, true}) {
    for (const std::string& name : {mine, twice}) std::ofstream(folder / name) << "x";
    if (before)
      require_writable(folder / "cloud.ply");
    else
      write_atomically(folder / "cloud.ply", "whole");
    EXPECT_FALSE(fs::exists(folder / mine)) << before;
    EXPECT_FALSE(fs::exists(folder / twice)) << before;
    for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  fs::remove_all(folder);
}

TEST(WriteTogether, GivesAllFilesOrNone) {
  const fs::path folder = test::empty_folder();
  const std::vector<fs::path> paths{folder / "a.txt", folder / "b.json"};
  write_atomically(paths[0], "old");
  try {
    write_together(paths, [](const std::vector<fs::path>& temporaries) {
      write_atomically(temporaries[0], "new");
      fail("{}: no more ink", temporaries[1].string());
    });
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), paths[1].string() + ": no more ink");
  }
  EXPECT_EQ(contents_of(folder), (std::map<std::string, std::string>{{"a.txt", "old"}}));
  write_together(paths, [](const std::vector<fs::path>& temporaries) {
    for (const fs::path& temporary : temporaries) write_atomically(temporary, "new");
  });
  EXPECT_EQ(contents_of(folder),
            (std::map<std::string, std::string>{{"a.txt", "new"}, {"b.json", "new"}}));
  fs::remove_all(folder);
}

TEST(LinkOrCopy, GivesTheContentAndKeepsFiles) {
  const fs::path folder = test::empty_folder();
  write_atomically(folder / "a.txt", "text");
  link_or_copy(folder / "a.txt", folder / "new" / "b.txt");
  EXPECT_EQ(contents_of(folder),
            (std::map<std::string, std::string>{{"a.txt", "text"}, {"new/b.txt", "text"}}));
  write_atomically(folder / "a.txt", "other");  // replaces the file, and not its content
  EXPECT_EQ(contents_of(folder).at("new/b.txt"), "text");
  EXPECT_THROW(link_or_copy(folder / "a.txt", folder / "new" / "b.txt"), Error);
  EXPECT_THROW(link_or_copy(folder / "none.txt", folder / "c.txt"), Error);
  fs::remove_all(folder);
}

void write_model(const fs::path& folder, const std::string& text) {
  make_folder(folder / "sparse");
  write_atomically(folder / "report.json", text);
  write_atomically(folder / "sparse" / "images.txt", text + text);
  write_atomically(folder / "sparse" / "points.txt", text + text + text);
}

// Tests a full disk after different numbers of bytes, for a folder that exists and for a new one.
TEST(WriteFolder, GivesAllFilesOrNoneOnAFullDisk) {
  const fs::path folder = test::empty_folder();
  const std::string text(4000, 'n');
  for (const bool there : {false, true}) {
    const fs::path out = folder / (there ? "there" : "new");
    std::map<std::string, std::string> before;
    if (there) {
      write_model(out, "old");
      write_atomically(out / "sparse" / "other.txt", "mine");
      before = contents_of(out);
    }
    // The limits are within the first, the second and the third file.
    for (const rlim_t limit : {1000, 5000, 11000}) {
      {
        const FileSizeLimit full(limit);
        try {
          write_folder(out, [&](const fs::path& staging) { write_model(staging, text); });
          ADD_FAILURE() << limit;
        } catch (const Error& error) {
          EXPECT_THAT(error.what(), testing::StartsWith(out.string() + "/"));
          EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr(".tmp")));
        }
      }
      EXPECT_EQ(fs::exists(out), there);
      EXPECT_EQ(there ? contents_of(out) : before, before) << limit;
      EXPECT_EQ(files_in(folder), there ? 2u : 0u);
    }
    write_folder(out, [&](const fs::path& staging) { write_model(staging, text); });
    before["report.json"] = text;
    before["sparse/images.txt"] = text + text;
    before["sparse/points.txt"] = text + text + text;
    EXPECT_EQ(contents_of(out), before);
  }
  fs::remove_all(folder);
}

// A child process that writes the folder is killed at different moments. The folder must then not
// contain old files together with new ones.
TEST(WriteFolder, IsNeverHalfOldAndHalfNew) {
  const fs::path folder = test::empty_folder(), out = folder / "out";
  for (int moment = 0; moment < 40; ++moment) {
    fs::remove_all(folder);
    write_model(out, "old");
    const pid_t child = ::fork();
    if (child == 0) {
      for (;;) write_folder(out, [](const fs::path& staging) { write_model(staging, "new"); });
    }
    ::usleep(static_cast<useconds_t>(100 * moment));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::size_t old = 0, fresh = 0;
    for (const char* name : {"report.json", "sparse/images.txt", "sparse/points.txt"}) {
      const std::string text = fs::exists(out / name) ? read_file(out / name) : "";
      old += text.starts_with("old") ? 1 : 0;
      fresh += text.starts_with("new") ? 1 : 0;
    }
    EXPECT_TRUE(old == 0 || fresh == 0) << moment;
    // The temporaries of the killed process are removed before the folder is written again.
    require_writable_folder(out);
    for (const auto& entry : fs::directory_iterator(out))
      EXPECT_THAT(entry.path().string(), testing::Not(testing::HasSubstr(".tmp")));
  }
  fs::remove_all(folder);
}

TEST(WriteFolder, TellsBeforeTheWorkThatAFolderCannotBeWritten) {
  const fs::path folder = test::empty_folder();
  write_atomically(folder / "file", "x");
  for (const fs::path& out : {folder / "a" / "b" / "c", folder, folder / "new" / ""})
    EXPECT_NO_THROW(require_writable_folder(out)) << out;
  EXPECT_EQ(files_in(folder), 1u);
  for (const fs::path& out : {folder / "file", folder / "file" / "a", fs::path("/proc/a")}) {
    EXPECT_THROW(require_writable_folder(out), Error) << out;
    EXPECT_THROW(write_folder(out, [](const fs::path& staging) { write_model(staging, "x"); }),
                 Error)
        << out;
  }
  EXPECT_EQ(files_in(folder), 1u);
  // A name with a slash at the end, and missing parents.
  write_folder(folder / "a" / "b" / "", [](const fs::path& staging) { write_model(staging, "x"); });
  EXPECT_EQ(contents_of(folder / "a" / "b").size(), 3u);
  EXPECT_EQ(files_in(folder / "a"), 1u);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace axial
