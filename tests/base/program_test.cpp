// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <new>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "support/empty_folder.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// A program with options of every kind. Every test runs it in a folder of its own.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override { folder_ = test::empty_folder(); }
  void TearDown() override { fs::remove_all(folder_); }

  ParsedOptions parse(std::vector<std::string> arguments, bool in_folder = true) {
    level_ = 1;
    limit_ = 640;
    secret_ = 0;
    ProgramOptions program;
    program.name = "TestProgram";
    program.description = "tests";
    quick_ = false;
    program.visible.add_switch("quick", &quick_, "switch");
    if (takes_input_) program.visible.add("input-file,i", &input_, "input");
    program.visible.add_with_default("crop-to-roi", &crop_, "crop")
        .add_with_default("resolution-level", &level_, "level")
        .add_with_default("resolution-limit", &limit_, "limit");
    program.hidden.add_with_default("secret", &secret_, "hidden");
    arguments.insert(arguments.begin(), "TestProgram");
    if (in_folder) arguments.insert(arguments.end(), {"-w", folder_.string()});
    std::vector<const char*> argv;
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      const ParsedOptions parsed =
          parse_options(static_cast<int>(argv.size()), argv.data(), program);
      out_ = testing::internal::GetCapturedStdout();
      err_ = testing::internal::GetCapturedStderr();
      return parsed;
    } catch (...) {
      out_ = testing::internal::GetCapturedStdout();
      err_ = testing::internal::GetCapturedStderr();
      throw;
    }
  }

  std::string error(const std::vector<std::string>& arguments) {
    try {
      parse(arguments);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
      return error.what();
    }
    ADD_FAILURE() << "no Error";
    return {};
  }

  fs::path folder_;
  std::string input_, out_, err_;
  bool takes_input_ = true, crop_ = true, quick_ = false;
  int level_ = 0, limit_ = 0, secret_ = 0;
};

TEST_F(ProgramTest, HasTheDefaultsOfEveryProgram) {
  const ParsedOptions parsed = parse({"a.mvs"});
  EXPECT_TRUE(parsed.run);
  EXPECT_EQ(input_, "a.mvs");
  EXPECT_TRUE(crop_);
  EXPECT_EQ(level_, 1);
  EXPECT_EQ(parsed.common.archive_type, -1);
  EXPECT_EQ(parsed.common.max_threads, 0u);
  EXPECT_EQ(parsed.common.verbosity, 2);
  EXPECT_FALSE(given(parsed, "crop-to-roi"));
  EXPECT_TRUE(given(parsed, "input-file"));
}

TEST_F(ProgramTest, TakesEverySpellingOfAnOption) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"-i", "a.mvs", "--resolution-level", "3", "-v", "1"},
        {"-ia.mvs", "--resolution-level=3", "-v1"},
        {"a.mvs", "--resolution-le", "3", "--verb=1"},
        {"--input-file=a.mvs", "--resolution-le=3", "--verbosity", "1"}}) {
    const ParsedOptions parsed = parse(arguments);
    EXPECT_TRUE(parsed.run);
    EXPECT_EQ(input_, "a.mvs");
    EXPECT_EQ(level_, 3);
    EXPECT_EQ(parsed.common.verbosity, 1);
    EXPECT_TRUE(given(parsed, "resolution-level"));
  }
}

TEST_F(ProgramTest, TakesBooleansWithAValue) {
  for (const char* yes : {"1", "true", "yes", "on"}) {
    crop_ = false;
    parse({"a.mvs", "--crop-to-roi", yes});
    EXPECT_TRUE(crop_) << yes;
  }
  for (const char* no : {"0", "false", "no", "off"}) {
    crop_ = true;
    parse({"a.mvs", "--crop-to-roi", no});
    EXPECT_FALSE(crop_) << no;
  }
  EXPECT_THAT(error({"a.mvs", "--crop-to-roi", "2"}), HasSubstr("crop-to-roi"));
  EXPECT_THAT(error({"a.mvs", "--crop-to-roi"}), HasSubstr("crop-to-roi"));
}

TEST_F(ProgramTest, LeavesASwitchThatHasNoValueTheNextWord) {
  const std::vector<std::vector<std::string>> on = {
      {"--quick", "a.mvs"},       {"a.mvs", "--quick"},
      {"--qui", "a.mvs"},         {"--quick", "1", "a.mvs"},
      {"--quick=1", "a.mvs"},     {"--quick", "YES", "a.mvs"},
      {"--quick", "-i", "a.mvs"}, {"--quick", "-v", "1", "a.mvs"},
      {"-v1", "--quick", "a.mvs"}};
  for (const std::vector<std::string>& arguments : on) {
    EXPECT_TRUE(parse(arguments).run) << testing::PrintToString(arguments);
    EXPECT_EQ(input_, "a.mvs") << testing::PrintToString(arguments);
    EXPECT_TRUE(quick_) << testing::PrintToString(arguments);
  }
  for (const char* no : {"0", "false", "Off", "no"}) {
    parse({"--quick", no, "a.mvs"});
    EXPECT_EQ(input_, "a.mvs");
    EXPECT_FALSE(quick_) << no;
  }
  EXPECT_THAT(error({"-i", "a.mvs", "--quick", "2"}), HasSubstr("'2' belongs to no option"));
  EXPECT_THAT(error({"--quick=2", "a.mvs"}), HasSubstr("quick"));
}

TEST_F(ProgramTest, TakesNoOptionForTheValueOfAnother) {
  const std::vector<std::vector<std::string>> missing = {
      {"-i", "--quick"},
      {"-i", "--quick=1"},
      {"--input-file", "-v1"},
      {"-i", "-v", "1"},
      {"a.mvs", "--config-file", "--quick"},
      {"a.mvs", "--crop-to-roi", "--quick"},
      {"a.mvs", "--resolution-level", "--resolution-limit", "3"},
      {"a.mvs", "-c", "--resolution-le", "3"}};
  for (const std::vector<std::string>& arguments : missing)
    EXPECT_THAT(error(arguments), HasSubstr("has no value")) << testing::PrintToString(arguments);
  EXPECT_EQ(error({"-i", "--quick"}), "command line: -i has no value: --quick is an option");
  // Values that begin with a dash are allowed if they are not names of options.
  parse({"a.mvs", "--secret", "-3"});
  EXPECT_EQ(secret_, -3);
  parse({"--input-file=--quick"});
  EXPECT_EQ(input_, "--quick");
  parse({"-i", "--no-such-option.mvs"});
  EXPECT_EQ(input_, "--no-such-option.mvs");
  EXPECT_EQ(parse({"--help", "--quick"}).exit_code, 0);
}

TEST_F(ProgramTest, AnInputFileHasAName) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"-i", ""}, {"--input-file="}, {""}})
    EXPECT_THAT(error(arguments), HasSubstr("input-file")) << testing::PrintToString(arguments);
}

TEST_F(ProgramTest, NamesWhatItDoesNotUnderstand) {
  EXPECT_THAT(error({"a.mvs", "--no-such-option", "1"}), HasSubstr("no-such-option"));
  EXPECT_THAT(error({"a.mvs", "-z"}), HasSubstr("-z"));
  EXPECT_THAT(error({"a.mvs", "--resolution-l", "1"}), HasSubstr("ambiguous"));
  EXPECT_THAT(error({"a.mvs", "--resolution-level", "high"}), HasSubstr("high"));
  EXPECT_THAT(error({"a.mvs", "--resolution-level", "1", "--resolution-level", "2"}),
              HasSubstr("resolution-level"));
  EXPECT_THAT(error({"a.mvs", "b.mvs"}), HasSubstr("'b.mvs' belongs to no option"));
  EXPECT_THAT(error({"-i", "a.mvs", "1"}), HasSubstr("'1' belongs to no option"));
  EXPECT_THAT(error({"a.mvs", "--max-threads", "-1"}), HasSubstr("--max-threads -1"));
  EXPECT_THAT(error({"a.mvs", "--max-threads=-1"}), HasSubstr("--max-threads -1"));
  EXPECT_THAT(error({"a.mvs", "--max-threads", "5000"}), HasSubstr("at most 1024"));
  EXPECT_THAT(error({"a.mvs", "--archive-type", "4"}), HasSubstr("--archive-type 4"));
}

TEST_F(ProgramTest, RefusesStrayArgumentsWhereThereIsNoInputFile) {
  takes_input_ = false;
  EXPECT_TRUE(parse({"--resolution-level", "3"}).run);
  EXPECT_EQ(error({"--resolution-level", "3", "closeup"}),
            "command line: 'closeup' belongs to no option");
}

TEST_F(ProgramTest, LogsMoreTheHigherTheVerbosity) {
  const LogLevel before = log_level();
  const std::vector<std::pair<const char*, LogLevel>> levels = {
      {"-v-1", LogLevel::warning}, {"-v0", LogLevel::warning}, {"-v1", LogLevel::info},
      {"-v2", LogLevel::debug},    {"-v3", LogLevel::trace},   {"-v9", LogLevel::trace}};
  for (const auto& [option, level] : levels) {
    parse({"a.mvs", option});
    EXPECT_EQ(log_level(), level) << option;
  }
  set_log_level(before);
}

TEST_F(ProgramTest, LetsTheCommandLineWinOverTheFileAndTheFileOverDefaults) {
  write_atomically(folder_ / "TestProgram.cfg",
                   "# a comment\nresolution-level = 4\nresolution-limit = 100\nsecret = 5\n");
  const ParsedOptions parsed = parse({"a.mvs", "--resolution-limit", "200"});
  EXPECT_EQ(level_, 4);
  EXPECT_EQ(limit_, 200);
  EXPECT_EQ(secret_, 5);
  EXPECT_TRUE(crop_);
  EXPECT_TRUE(given(parsed, "resolution-level"));
}

TEST_F(ProgramTest, PassesOverAByteOrderMarkInTheConfigFile) {
  write_atomically(folder_ / "TestProgram.cfg", "\xEF\xBB\xBFresolution-level = 4\r\n");
  parse({"a.mvs"});
  EXPECT_EQ(level_, 4);
}

TEST_F(ProgramTest, ReadsTheNamedConfigFileInTheWorkingFolder) {
  write_atomically(folder_ / "other.cfg", "resolution-level = 6\n");
  parse({"a.mvs", "-c", "other.cfg"});
  EXPECT_EQ(level_, 6);
  EXPECT_THAT(error({"a.mvs", "-c", "missing.cfg"}), HasSubstr("missing.cfg"));
}

TEST_F(ProgramTest, NamesTheConfigFileThatIsWrong) {
  const fs::path cfg = folder_ / "TestProgram.cfg";
  for (const char* text : {"no-such-option = 1\n", "max-threads = 1\n", "garbage\n",
                           "resolution-level = 1\nresolution-level = 2\n"}) {
    write_atomically(cfg, text);
    EXPECT_THAT(error({"a.mvs"}), HasSubstr(cfg.string())) << text;
  }
}

TEST_F(ProgramTest, ShowsHelpAndSaysWhetherThatWasAsked) {
  ParsedOptions parsed = parse({"-h"});
  EXPECT_FALSE(parsed.run);
  EXPECT_EQ(parsed.exit_code, 0);
  EXPECT_THAT(out_, HasSubstr("--resolution-level"));
  EXPECT_THAT(out_, HasSubstr("--max-threads"));
  EXPECT_THAT(out_, Not(HasSubstr("--secret")));
  EXPECT_EQ(err_, "");

  parsed = parse({"a.mvs", "--help"});
  EXPECT_FALSE(parsed.run);
  EXPECT_EQ(parsed.exit_code, 0);

  parsed = parse({});
  EXPECT_FALSE(parsed.run);
  EXPECT_EQ(parsed.exit_code, 1);
  EXPECT_THAT(err_, HasSubstr("no input file"));
  EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1);
}

TEST_F(ProgramTest, ResolvesPathsInTheWorkingFolder) {
  const ParsedOptions parsed = parse({"a.mvs"});
  EXPECT_EQ(parsed.common.working_folder, folder_);
  EXPECT_EQ(in_working_folder(parsed.common, "x/../b.mvs"), folder_ / "b.mvs");
  EXPECT_EQ(in_working_folder(parsed.common, "/abs/b.mvs"), "/abs/b.mvs");
  EXPECT_EQ(in_working_folder(parsed.common, ""), "");
  EXPECT_TRUE(parse({"a.mvs"}, false).common.working_folder.is_absolute());
  for (const char* folder : {"/no/such/folder", "/dev/null"}) {
    try {
      parse({"a.mvs", "-w", folder}, false);
      ADD_FAILURE() << folder;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(folder));
    }
  }
}

TEST_F(ProgramTest, TurnsExceptionsIntoOneLineAndExitCode1) {
  const auto run = [&](const std::function<int()>& body) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_program("TestProgram", body);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return code;
  };
  EXPECT_EQ(run([] { return 0; }), 0);
  EXPECT_EQ(run([] { return 7; }), 7);
  EXPECT_EQ(err_, "");
  EXPECT_EQ(run([]() -> int { fail("a.mvs: is {}", "bad"); }), 1);
  EXPECT_EQ(err_, "TestProgram: a.mvs: is bad\n");
  EXPECT_EQ(run([]() -> int { throw std::runtime_error("two\nlines"); }), 1);
  EXPECT_EQ(err_, "TestProgram: two lines\n");
  EXPECT_EQ(run([]() -> int { throw std::bad_alloc(); }), 1);
  EXPECT_EQ(err_, "TestProgram: out of memory\n");
  EXPECT_EQ(run([]() -> int {
              name_settings({{"max_memory", "--max-memory"}});
              fail("{}: too little", setting("max_memory"));
            }),
            1);
  EXPECT_EQ(err_, "TestProgram: --max-memory: too little\n");
  EXPECT_EQ(run([] {
              log_info("hello");
              return 0;
            }),
            0);
  EXPECT_THAT(out_, testing::ContainsRegex("^[0-9]+:[0-9]+:[0-9]+ \\[TestProgram\\] hello\n"));
}

}  // namespace
}  // namespace axial
