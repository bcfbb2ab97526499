// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/context.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stop_token>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/program/console.h"

namespace axial {
namespace {

TEST(Context, SendsLinesAndProgressInTheirOrder) {
  std::vector<Event> events;
  const Context context([&](const Event& event) { events.push_back(event); });
  context.info("{} points", 3);
  const ProgressSink progress = context.stage("Matched");
  progress(1, 2);
  context.warning("two\nlines");
  context.details("more");
  ASSERT_EQ(events.size(), 5u);
  EXPECT_EQ(events[0].text, "3 points");
  EXPECT_EQ(events[0].level, LogLevel::info);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(events[i].kind, Event::Kind::progress);
    EXPECT_EQ(events[i].text, "Matched");
    EXPECT_EQ(events[i].done, i - 1);
    EXPECT_EQ(events[i].total, 2 * (i - 1));
  }
  EXPECT_EQ(events[3].level, LogLevel::warning);
  EXPECT_EQ(events[3].text, "two lines");
  EXPECT_EQ(events[4].level, LogLevel::trace);
}

TEST(Context, PrefixesTheEventsOfAPart) {
  std::vector<std::string> texts;
  const Context whole([&](const Event& event) { texts.push_back(event.text); });
  const Context part(whole.with_prefix("Registering: "), whole.stop_token());
  part.info("round {}", 1);
  part.stage("Matched");
  EXPECT_EQ(texts, (std::vector<std::string>{"Registering: round 1", "Registering: Matched"}));
}

TEST(Context, WithoutASinkIsSilentAndCannotBeStopped) {
  const Context context;
  context.warning("nobody hears this");
  context.stage("Matched")(1, 1);
  EXPECT_NO_THROW(context.check_stop());
}

// The items of a loop report their progress: the loop ends early, and its caller sees Stopped.
TEST(Context, StopsALoopThatReportsProgress) {
  std::stop_source source;
  const Context context({}, source.get_token());
  ProgressCounter counter(context.stage("Matched"), 1000);
  std::atomic<std::size_t> begun = 0;
  const auto item = [&](std::size_t) {
    if (++begun == 10) source.request_stop();
    counter.add();
  };
  EXPECT_THROW(parallel_for(1000, item), Stopped);
  EXPECT_LT(begun, 1000u);
  EXPECT_THROW(context.check_stop(), Stopped);
  EXPECT_THROW(context.stage("Fused"), Stopped);
}

TEST(ConsoleEvents, AreLinesOfTheLog) {
  const LogCapture log;
  const Context context(console_events());
  context.info("{} points", 3);
  const ProgressSink progress = context.stage("Matched");
  progress(2, 2);
  context.warning("no masks");
  EXPECT_EQ(log.text().rfind("3 points\nMatched 2/2 (100%, ", 0), 0u);
  EXPECT_NE(log.text().find(")\nno masks\n"), std::string::npos);
}

}  // namespace
}  // namespace axial
