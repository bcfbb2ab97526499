// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log.h"

#include <fmt/format.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/log_file.h"
#include "base/message.h"

namespace axial {
namespace {

// In the order of LogLevel.
constexpr std::array kLevels{spdlog::level::trace, spdlog::level::debug, spdlog::level::info,
                             spdlog::level::warn};

spdlog::level::level_enum level_of(LogLevel level) {
  return kLevels[static_cast<std::size_t>(level)];
}

// The mark of warnings, so that people and programs find them in a log: "%*" of a pattern.
class WarningMark : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    constexpr std::string_view kMark = "warning: ";
    if (message.level == spdlog::level::warn)
      line.append(kMark.data(), kMark.data() + kMark.size());
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<WarningMark>();
  }
};

// `time`: the pattern of the beginning of a line.
std::unique_ptr<spdlog::formatter> line_format(const std::string& time) {
  auto format = std::make_unique<spdlog::pattern_formatter>();
  format->add_flag<WarningMark>('*').set_pattern(time + " [%n] %*%v");
  return format;
}

std::shared_ptr<spdlog::sinks::sink>& file_sink() {
  static std::shared_ptr<spdlog::sinks::sink> sink;
  return sink;
}

SettingNames& setting_names() {
  static SettingNames names;
  return names;
}

// Whether lines of a log may be appended to `file`: it begins with a date and time, is empty, does
// not exist, or is not a regular file.
bool may_hold_a_log(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return true;
  std::array<char, 20> start{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), start.size());
  const std::string_view read(start.data(), static_cast<std::size_t>(stream.gcount()));
  const std::string_view form = "0000-00-00 00:00:00 ";
  const auto fits = [](char c, char wanted) {
    return wanted == '0' ? '0' <= c && c <= '9' : c == wanted;
  };
  return read.empty() || std::ranges::equal(read, form, fits);
}

}  // namespace

void log_to_file_too(const std::filesystem::path& file) {
  if (!may_hold_a_log(file)) fail_in(file, "is not a log file, and nothing is added to it");
  try {
    const auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string());
    sink->set_formatter(line_format("%Y-%m-%d %H:%M:%S"));
    spdlog::default_logger()->sinks().push_back(sink);
    file_sink() = sink;
  } catch (const spdlog::spdlog_ex& error) {
    fail_in(file, "cannot be written: {}", error.what());
  }
}

void log_to_file_only(std::string_view line) {
  if (!file_sink()) return;
  const std::string& name = spdlog::default_logger_raw()->name();
  file_sink()->log(spdlog::details::log_msg(spdlog::string_view_t(name.data(), name.size()),
                                            spdlog::level::err,
                                            spdlog::string_view_t(line.data(), line.size())));
  file_sink()->flush();
}

void set_log_level(LogLevel level) {
  spdlog::set_level(level_of(level));
}

LogLevel log_level() {
  return static_cast<LogLevel>(std::ranges::find(kLevels, spdlog::get_level()) - kLevels.begin());
}

bool logs(LogLevel level) {
  return spdlog::should_log(level_of(level));
}

void start_log(const std::string& name, const std::string& line_start) {
  const auto log =
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stdout_sink_mt>());
  log->set_formatter(line_format(line_start + "%H:%M:%S"));
  log->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(log);
  name_settings({});
}

void name_settings(SettingNames names) {
  setting_names() = std::move(names);
}

std::string log_words(std::string_view text) {
  return in_words(text, setting_names());
}

void log_line(LogLevel level, std::string_view line) {
  std::string words = log_words(line);
  if (level == LogLevel::warning) words = as_message(words);
  spdlog::default_logger_raw()->log(level_of(level),
                                    spdlog::string_view_t(words.data(), words.size()));
}

void log_formatted(LogLevel level, fmt::string_view format, fmt::format_args arguments) {
  if (logs(level)) log_line(level, fmt::vformat(format, arguments));
}

struct LogCapture::State {
  std::ostringstream text;
  std::shared_ptr<spdlog::logger> before = spdlog::default_logger();
  SettingNames names_before = std::exchange(setting_names(), {});
};

LogCapture::LogCapture() : state_(std::make_unique<State>()) {
  const auto log = std::make_shared<spdlog::logger>(
      "captured", std::make_shared<spdlog::sinks::ostream_sink_mt>(state_->text));
  log->set_pattern("%v");
  spdlog::set_default_logger(log);
}

LogCapture::~LogCapture() {
  spdlog::set_default_logger(state_->before);
  name_settings(state_->names_before);
}

std::string LogCapture::text() const {
  return state_->text.str();
}

}  // namespace axial
