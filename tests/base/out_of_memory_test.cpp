// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/out_of_memory.h"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/program/program.h"
#include "support/empty_folder.h"

namespace axial {
namespace {

constexpr const char* kOfOpenCv =
    "OpenCV(4.6.0) alloc.cpp:73: error: (-4:Insufficient memory) Failed to allocate 36864000 bytes "
    "in function 'OutOfMemoryError'";

TEST(OutOfMemory, IsToldFromOtherErrors) {
  EXPECT_TRUE(is_out_of_memory(std::bad_alloc()));
  EXPECT_TRUE(is_out_of_memory(std::bad_array_new_length()));
  EXPECT_TRUE(is_out_of_memory(std::runtime_error(kOfOpenCv)));
  EXPECT_TRUE(
      is_out_of_memory(std::runtime_error("a.jpg: cannot be decoded: Failed to allocate 9")));
  EXPECT_TRUE(is_out_of_memory(std::system_error(ENOMEM, std::generic_category())));
  EXPECT_FALSE(is_out_of_memory(std::runtime_error("a.jpg: is truncated")));
  EXPECT_FALSE(is_out_of_memory(std::logic_error("")));
}

// Throws an exception that nothing catches.
template <class Exception>
[[noreturn]] void throw_in_a_thread(const Exception& exception) {
  report_uncaught_exceptions();
  std::thread([&] { throw exception; }).join();
  std::abort();
}

void throw_where_nothing_may(const std::function<void()>& thrower) noexcept {
  thrower();
}

TEST(OutOfMemoryDeathTest, EndsTheProgramWithOneLineFromEveryThread) {
  const auto ended = testing::ExitedWithCode(1);
  const std::string line = std::string("^") + program_invocation_short_name + ": out of memory\n$";
  EXPECT_EXIT(throw_in_a_thread(std::bad_alloc()), ended, line);
  EXPECT_EXIT(throw_in_a_thread(std::runtime_error(kOfOpenCv)), ended, line);
  EXPECT_EXIT(throw_in_a_thread(std::runtime_error("two\nlines")), ended, ": two lines\n$");
  EXPECT_EXIT(throw_in_a_thread(7), ended, "unknown type\n$");
  report_uncaught_exceptions();
  EXPECT_EXIT(throw_where_nothing_may([] { throw std::bad_alloc(); }), ended, line);
}

TEST(OutOfMemory, IsWhatTheProgramSaysWhereverItHappens) {
  const auto said = [](const std::function<void()>& body) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_program("Test",
                          [&] {
                            body();
                            return 0;
                          }),
              1);
    return testing::internal::GetCapturedStderr();
  };
  const std::string line = "Test: out of memory\n";
  EXPECT_EQ(said([] { throw std::bad_alloc(); }), line);
  EXPECT_EQ(said([] { throw std::runtime_error(kOfOpenCv); }), line);
  EXPECT_EQ(said([] {
              parallel_for(100, [](std::size_t i) {
                if (i == 50) throw std::bad_alloc();
              });
            }),
            line);
  // The message does not name the file, because the file is not the cause.
  const std::filesystem::path folder = test::empty_folder();
  EXPECT_EQ(said([&] {
              write_atomically(folder / "a",
                               [](const std::filesystem::path&) { throw std::bad_alloc(); });
            }),
            line);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace axial
