// SPDX-License-Identifier: GPL-3.0-or-later
// Errors and lines that mark settings.
#include "base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <exception>
#include <thread>

#include "base/log.h"
#include "base/message.h"
#include "base/program/program.h"
#include "support/captured_events.h"

namespace axial {
namespace {

template <class Run>
Error error_from(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no Error";
  return Error("");
}

const SettingNames kNames{{"max_memory", "--max-memory"}, {"make_maps false", "--fusion-mode -1"}};

TEST(ErrorText, HasTheNamesOfTheReader) {
  const Error error = error_from([] {
    fail("{} {}: contradicts {} and {}", setting("max_memory"), 7, setting("make_maps false"),
         setting("other"));
  });
  EXPECT_STREQ(error.what(), "max_memory 7: contradicts make_maps false and other");
  EXPECT_EQ(in_words(error.text(), kNames),
            "--max-memory 7: contradicts --fusion-mode -1 and other");
  EXPECT_EQ(error.setting(), "max_memory");
  EXPECT_EQ(error.file(), "");
}

TEST(ErrorText, KeepsItsPartsInOtherErrors) {
  const Error inner = error_from([] { fail("less than {}", setting("max_memory")); });
  const Error outer = error_from([&] { fail_in("a.ply", "tile {}: {}", 2, inner.text()); });
  EXPECT_STREQ(outer.what(), "a.ply: tile 2: less than max_memory");
  EXPECT_EQ(in_words(outer.text(), kNames), "a.ply: tile 2: less than --max-memory");
  EXPECT_EQ(outer.file(), "a.ply");
  EXPECT_EQ(outer.setting(), "");
}

TEST(ErrorText, KeepsItsPartsAcrossThreads) {
  std::exception_ptr held;
  std::thread([&] {
    try {
      fail("{}: too little", setting("max_memory"));
    } catch (...) {
      held = std::current_exception();
    }
  }).join();
  EXPECT_EQ(error_from([&] { std::rethrow_exception(held); }).setting(), "max_memory");
}

TEST(ErrorText, IsOneLineWithoutMarks) {
  EXPECT_EQ(in_words("a " + setting("b") + setting("") + "."), "a b.");
  const std::string marks = setting("");
  for (const std::string& text : {marks.substr(0, 1) + "a", "a" + marks.substr(1),
                                  marks.substr(0, 1) + setting("a"), marks.substr(1) + "a"}) {
    EXPECT_EQ(in_words(text), "a");
    EXPECT_STREQ(Error(text).what(), "a");
  }
  EXPECT_EQ(Error(std::string(2000, '\n')).what(), as_message(std::string(2000, '\n')));
}

TEST(ErrorText, OfOtherExceptionsIsTheirMessage) {
  EXPECT_EQ(marked_text(std::runtime_error("full")), "full");
  EXPECT_EQ(marked_text(Error(setting("a"))), setting("a"));
}

TEST(MarkedLines, HaveTheNamesOfTheProgramInItsLog) {
  const LogCapture log;
  log_warning("see {}", setting("max_memory"));
  name_settings(kNames);
  log_warning("see {}", setting("max_memory"));
  program_context({}).info("see {}", setting("make_maps false"));
  const Context context = program_context({});
  Context(context.with_prefix("Part: ")).warning("see {}", setting("other"));
  EXPECT_EQ(log.text(),
            "see max_memory\nsee --max-memory\nsee --fusion-mode -1\nPart: see other\n");
}

TEST(MarkedLines, HaveTheNamesOfTheLibraryInEvents) {
  const test::CapturedEvents events;
  events.context.warning("see {}", setting("max_memory"));
  EXPECT_THAT(events.lines, testing::HasSubstr("see max_memory\n"));
}

}  // namespace
}  // namespace axial
