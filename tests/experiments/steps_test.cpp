// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/steps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class Steps : public ::testing::Test {
 protected:
  fs::path folder_ = test::empty_folder();
  fs::path step_ = folder_ / "step";
  int made_ = 0;

  void TearDown() override { fs::remove_all(folder_); }

  // Makes a file of this name in the step's folder.
  void make(const std::string& inputs, const std::string& name) {
    step(step_, Json(inputs), [&] {
      ++made_;
      write_atomically(step_ / name, inputs);
    });
  }
};

TEST_F(Steps, IsMadeOnceForTheSameInputs) {
  make("port 1", "a");
  make("port 1", "b");
  EXPECT_EQ(made_, 1);
  EXPECT_TRUE(fs::exists(step_ / "a"));
}

TEST_F(Steps, OtherInputsReplaceTheWholeFolder) {
  make("port 1", "a");
  make("port 2", "b");
  EXPECT_EQ(made_, 2);
  EXPECT_FALSE(fs::exists(step_ / "a"));
  EXPECT_EQ(read_file(step_ / "b"), "port 2");
}

TEST_F(Steps, AFailureIsRepeatedInAnEmptyFolder) {
  const auto fails = [&] {
    write_atomically(step_ / "half", "");
    fail("the program stopped");
  };
  EXPECT_EQ(test::error_of([&] { step(step_, Json("port 1"), fails); }), "the program stopped");
  make("port 1", "a");
  EXPECT_EQ(made_, 1);
  EXPECT_FALSE(fs::exists(step_ / "half"));
}

TEST_F(Steps, FilesAreSortedAndEndAsAskedFor) {
  for (const char* name : {"2.jpg", "1.jpg", "1.png", "10.jpg"})
    write_atomically(folder_ / name, "");
  EXPECT_THAT(files_ending_in(folder_, ".jpg"),
              ElementsAre(folder_ / "1.jpg", folder_ / "10.jpg", folder_ / "2.jpg"));
}

TEST_F(Steps, TheFingerprintIsOfNamesAndBytesAndNotOfThePlace) {
  const auto print_of = [&](const std::string& folder, const std::string& name,
                            const std::string& bytes) {
    make_folder(folder_ / folder);
    write_atomically(folder_ / folder / name, bytes);
    return content_of(folder_ / folder);
  };
  const std::string first = print_of("one", "cameras.txt", "1 PINHOLE");
  EXPECT_EQ(print_of("two", "cameras.txt", "1 PINHOLE"), first);
  EXPECT_NE(print_of("three", "images.txt", "1 PINHOLE"), first);
  EXPECT_NE(print_of("four", "cameras.txt", "2 PINHOLE"), first);
  EXPECT_NE(print_of("two", "images.txt", ""), first);  // a second file
  EXPECT_NE(content_of(folder_ / "one" / "cameras.txt"),
            content_of(folder_ / "four" / "cameras.txt"));
}

}  // namespace
}  // namespace axial::experiments
