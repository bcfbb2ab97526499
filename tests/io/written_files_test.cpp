// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/artifacts/written_files.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "base/atomic_file.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

class WrittenFilesTest : public test::FolderTest {
 protected:
  void put(const fs::path& name, const std::string& content) const {
    make_folder((folder_ / name).parent_path());
    write_atomically(folder_ / name, content);
  }

  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (!entry.is_directory())
        found[entry.path().lexically_relative(folder_).string()] = read_file(entry.path());
    return found;
  }
};

std::set<std::string> names(const std::vector<fs::path>& files) {
  return {files.begin(), files.end()};
}

std::string random_name(std::mt19937& random) {
  std::string name(1, static_cast<char>('a' + random() % 3));
  while (random() % 2 == 0) name += std::string("/") + static_cast<char>('a' + random() % 3);
  return name + ".x";  // so that no file has the name of a folder
}

// Other programs change, remove and add files in any order.
TEST_F(WrittenFilesTest, AreThoseThatNobodyChanged) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    fs::remove_all(folder_);
    make_folder(folder_);
    std::mt19937 random(seed);
    for (int i = 0; i < 12; ++i) put(random_name(random), "ours " + std::to_string(random() % 4));
    const auto ours = contents();
    const nlohmann::json listed = list_files(folder_);
    EXPECT_EQ(listed.size(), ours.size());
    for (int i = 0; i < 6; ++i) {
      const std::string name = random_name(random);
      if (random() % 3 == 0)
        fs::remove(folder_ / name);
      else
        put(name, "ours " + std::to_string(random() % 6));
    }
    std::set<std::string> unchanged, changed;
    auto left = contents();
    for (const auto& [name, content] : contents())
      if (ours.contains(name)) (ours.at(name) == content ? unchanged : changed).insert(name);
    const WrittenFiles found = find_written(folder_, listed);
    EXPECT_EQ(names(found.unchanged), unchanged) << seed;
    EXPECT_EQ(names(found.changed), changed) << seed;

    remove_below(folder_, found.unchanged);
    for (const std::string& name : unchanged) left.erase(name);
    EXPECT_EQ(contents(), left) << seed;
    for (const std::string& name : unchanged)
      for (fs::path above = fs::path(name).parent_path(); !above.empty();
           above = above.parent_path())
        EXPECT_FALSE(fs::exists(folder_ / above) && fs::is_empty(folder_ / above)) << above;
    EXPECT_TRUE(fs::exists(folder_));
  }
}

TEST_F(WrittenFilesTest, TellLargeFilesApart) {
  std::string content((3 << 20) + 5, 'a');
  put("large", content);
  const nlohmann::json listed = list_files(folder_);
  EXPECT_EQ(find_written(folder_, listed).unchanged.size(), 1u);
  content[2 << 20] = 'b';
  put("large", content);
  EXPECT_EQ(find_written(folder_, listed).changed.size(), 1u);
}

TEST_F(WrittenFilesTest, AreNoneOutsideTheFolder) {
  put("inside/a", "x");
  put("outside", "x");
  const fs::path inside = folder_ / "inside";
  fs::create_symlink(folder_ / "outside", inside / "link");
  const std::string print = list_files(inside)["a"];
  EXPECT_EQ(list_files(inside).size(), 1u);
  for (const std::string& name :
       {std::string("../outside"), (folder_ / "outside").string(), std::string("a/../../outside"),
        std::string("link"), std::string("."), std::string(""), std::string("none")}) {
    const WrittenFiles found = find_written(inside, {{name, print}});
    EXPECT_TRUE(found.unchanged.empty() && found.changed.empty()) << name;
  }
  for (const nlohmann::json& listed : {nlohmann::json(3), nlohmann::json::array({"a"})})
    EXPECT_TRUE(find_written(inside, listed).unchanged.empty());
  EXPECT_EQ(find_written(inside, {{"a", 3}}).changed.size(), 1u);
}

// A user may keep the photographs on another disk.
TEST_F(WrittenFilesTest, GoWithoutALinkedFolder) {
  put("out/b", "x");
  put("disk/a", "x");
  fs::create_directory_symlink(folder_ / "disk", folder_ / "out" / "images");
  remove_below(folder_ / "out", {"images/a", "b"});
  EXPECT_FALSE(fs::exists(folder_ / "disk" / "a"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "out" / "images"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "b"));
}

}  // namespace
}  // namespace axial::io
