// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/state_file.h"

#include <gtest/gtest.h>

#include <set>
#include <stop_token>

#include "base/atomic_file.h"
#include "base/error.h"
#include "refine/photographed_mesh.h"
#include "support/captured_events.h"
#include "support/empty_folder.h"

namespace axial::refine {
namespace {

const test::PhotographedMesh& photographed() {
  static const test::PhotographedMesh scene;
  return scene;
}

// A coarse mesh with noise, whose faces are split.
State noisy() {
  State state;
  state.mesh = photographed().mesh(0.004, 0.1);
  state.mesh.colors.assign(state.mesh.vertices.size(), Rgb{1, 2, 3});
  return state;
}

Options three_resolutions() {
  Options options;
  options.scales = 3;
  options.references = References::alternating;  // the choice depends on the number of steps
  return options;
}

void run(State& state, const Checkpoint& checkpoint = {}, const Context& context = {}) {
  refine(
      state, photographed().views, [](std::size_t i) { return photographed().pictures[i]; },
      three_resolutions(), checkpoint, context);
}

TEST(StateFile, ARunGoesOnFromEachCheckpointToTheSameResult) {
  const auto file = test::empty_folder() / "mesh.state";
  std::vector<std::string> files;
  State whole = noisy();
  const std::string print = fingerprint(whole.mesh, three_resolutions(), "views");
  run(whole, [&](const State& state) {
    write_state(file, state, print);
    files.push_back(read_file(file));
  });
  ASSERT_EQ(files.size(), 3u);
  EXPECT_GT(whole.report.split_faces, 0u);
  for (unsigned done = 1; done <= 3; ++done) {
    write_atomically(file, files[done - 1]);
    std::optional<State> state = read_state(file, print);
    ASSERT_TRUE(state);
    EXPECT_EQ(state->done, done);
    run(*state);
    EXPECT_TRUE(state->mesh.vertices == whole.mesh.vertices) << done;
    EXPECT_TRUE(state->mesh.faces == whole.mesh.faces) << done;
    EXPECT_TRUE(state->mesh.colors == whole.mesh.colors) << done;
    EXPECT_EQ(state->report.split_faces, whole.report.split_faces);
    EXPECT_EQ(state->report.pairs, whole.report.pairs);
    EXPECT_EQ(state->report.measured, whole.report.measured);
    EXPECT_EQ(state->report.steps, whole.report.steps);
    EXPECT_EQ(state->report.moved, whole.report.moved);
  }
}

// The numbers that a run tells, from `state` on.
std::vector<std::size_t> told(State& state, const Checkpoint& checkpoint = {}) {
  std::vector<std::size_t> numbers;
  run(state, checkpoint, Context([&](const Event& event) {
        if (event.kind == Event::Kind::line || event.total == 0) return;
        EXPECT_EQ(event.total, 1000u);
        numbers.push_back(event.done);
      }));
  return numbers;
}

TEST(Progress, NeverFallsAndReachesTheEndOnce) {
  State state = noisy(), after_first;
  const std::vector<std::size_t> numbers = told(state, [&](const State& now) {
    if (now.done == 1) after_first = now;
  });
  for (const std::vector<std::size_t>& all : {numbers, told(after_first)}) {
    EXPECT_TRUE(std::ranges::is_sorted(all));
    EXPECT_EQ(std::ranges::count(all, 1000u), 1);
    EXPECT_LT(all.front(), 300u);
    EXPECT_GT(std::set(all.begin(), all.end()).size(), 10u);
  }
}

TEST(StateFile, DamagedAndForeignFilesAreNotRead) {
  const auto file = test::empty_folder() / "mesh.state";
  const std::string print(32, 'a'), other(32, 'b');
  State state;
  state.mesh.vertices.assign(5, {1, 2, 3});
  state.mesh.faces.assign(2, {0, 1, 2});
  state.first = state.mesh.vertices;
  state.pairs = {{0, 1}, {1, 2}};
  state.done = 1;
  EXPECT_FALSE(read_state(file, print));
  write_state(file, state, print);
  EXPECT_FALSE(read_state(file, other));
  const std::string good = read_file(file);
  for (std::size_t size = 0; size < good.size(); ++size) {
    write_atomically(file, good.substr(0, size));
    EXPECT_FALSE(read_state(file, print)) << size;
    std::string wrong = good;
    wrong[size] = static_cast<char>(wrong[size] ^ 0x40);
    write_atomically(file, wrong);
    EXPECT_FALSE(read_state(file, print)) << size;
  }
  write_atomically(file, good + "x");
  EXPECT_FALSE(read_state(file, print));
  write_atomically(file, good);
  const std::optional<State> read = read_state(file, print);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->mesh.vertices == state.mesh.vertices);
  EXPECT_EQ(read->pairs, state.pairs);
}

class RunWithState : public testing::Test {
 protected:
  // A run that ends with an Error after `work`.
  template <class Work>
  void failing_run(Work work) {
    EXPECT_THROW(
        {
          StateOfRun state(file_, context_);
          work(state);
          fail("a photograph cannot be read");
        },
        Error);
  }

  test::CapturedEvents events_;
  std::stop_source stop_;
  const Context context_{events_.sink(), stop_.get_token()};
  const std::filesystem::path file_ = test::empty_folder() / "mesh.state";
  const std::string print_ = std::string(32, 'a');
};

TEST_F(RunWithState, AnErrorRemovesTheStateThatTheRunWrote) {
  failing_run([&](StateOfRun& state) {
    state.write({}, print_);
    EXPECT_TRUE(read_state(file_, print_));
  });
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(RunWithState, AnErrorKeepsTheStateOfAnEarlierRun) {
  write_state(file_, {}, print_);
  failing_run([](StateOfRun&) {});
  EXPECT_TRUE(read_state(file_, print_));
}

TEST_F(RunWithState, AStopKeepsTheState) {
  failing_run([&](StateOfRun& state) {
    state.write({}, print_);
    stop_.request_stop();
  });
  EXPECT_TRUE(read_state(file_, print_));
}

TEST_F(RunWithState, AFileThatCannotBeWrittenKeepsTheState) {
  failing_run([&](StateOfRun& state) {
    state.write({}, print_);
    state.writing([] { fail("mesh.ply: cannot be written"); });
  });
  EXPECT_TRUE(read_state(file_, print_));
  EXPECT_NE(events_.lines.find("mesh.state: is kept: the same command continues"),
            std::string::npos);
}

TEST(StateFile, TheFingerprintDependsOnEverythingThatChangesTheResult) {
  const Mesh mesh = noisy().mesh;
  Options options;
  std::set<std::string> prints{fingerprint(mesh, options, "views")};
  options.bytes_afterwards = 7;
  prints.insert(fingerprint(mesh, options, "views"));
  EXPECT_EQ(prints.size(), 1u);
  prints.insert(fingerprint(mesh, options, "other views"));
  Mesh other = mesh;
  other.vertices[3].x() += 1e-6f;
  prints.insert(fingerprint(other, options, "views"));
  other = mesh;
  std::swap(other.faces[0], other.faces[1]);
  prints.insert(fingerprint(other, options, "views"));
  other = mesh;
  other.colors.clear();
  prints.insert(fingerprint(other, options, "views"));
  EXPECT_EQ(prints.size(), 5u);
  const auto changed = [&](auto Options::*member, auto value) {
    Options one;
    one.*member = value;
    prints.insert(fingerprint(mesh, one, "views"));
  };
  changed(&Options::scales, 5u);
  changed(&Options::scale_step, 0.7);
  changed(&Options::max_views, 3u);
  changed(&Options::references, References::second);
  changed(&Options::smoothness, 3.0);
  changed(&Options::anchor, 3.0);
  changed(&Options::max_face_area, 3.0);
  EXPECT_EQ(prints.size(), 12u);
}

}  // namespace
}  // namespace axial::refine
