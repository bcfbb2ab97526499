// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/option_values.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <map>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/program/output_name.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

template <class T>
concept Number = !std::same_as<T, bool> && (std::integral<T> || std::floating_point<T>);

// Refuses a number outside of the range of its option.
template <Number T>
void check(const Option& option, const T& value) {
  if (option.is_positive && !(value > T{0} && std::isfinite(static_cast<double>(value))))
    fail("--{} {}: must be positive", option.long_name(), value);
  if (!option.range) return;
  const auto [low, high, or_zero] = *option.range;
  const double number = static_cast<double>(value);
  if ((number >= low && number <= high) || (or_zero && number == 0)) return;
  if (high == std::numeric_limits<double>::max())
    fail("--{} {}: must be {}at least {}", option.long_name(), value,
         std::floating_point<T> ? "finite, and " : "", low);
  fail("--{} {}: must be from {} to {}{}", option.long_name(), value, low, high,
       or_zero ? ", or 0" : "");
}

void check(const Option& option, const std::optional<double>& value) {
  if (value) check(option, *value);
}

void take_choice(const Option& option, const std::string& word) {
  std::string words;
  for (const OptionChoice& choice : option.choices) {
    if (choice.word == word) return choice.take();
    words += (words.empty() ? "" : ", ") + choice.word;
  }
  fail("--{} {}: must be one of {}", option.long_name(), word, words);
}

void check(const Option& option, const std::string& text) {
  if (option.required && text.empty()) return;  // refused as missing
  if (!option.choices.empty()) take_choice(option, text);
  if (option.read) option.read(text);
  if (!option.accepted.empty() && std::ranges::find(option.accepted, text) == option.accepted.end())
    fail("--{} {}: not built yet", option.long_name(), text);
}

template <class T>
void check(const Option&, const T&) {}  // other types have no rules

void make_absolute(const Option& option, const CommonOptions& common, fs::path& path) {
  const std::string name = "--" + option.long_name();
  switch (option.path) {
    case PathKind::input:
      path = in_working_folder(common, path.string());
      break;
    case PathKind::output_file:
      path = output_in_working_folder(common, path.string(), name);
      break;
    case PathKind::output_folder:
      path = folder_in_working_folder(common, path.string(), name);
      break;
  }
}

void make_absolute(const Option& option, const CommonOptions& common,
                   std::vector<fs::path>& paths) {
  for (fs::path& path : paths) make_absolute(option, common, path);
}

template <class T>
void make_absolute(const Option&, const CommonOptions&, T&) {}  // other types are no paths

template <class T>
bool is_missing(const T& value) {
  if constexpr (requires { value.empty(); }) return value.empty();
  return false;
}

void take_value(const Option& option, const ParsedOptions& parsed, bool is_given) {
  std::visit(
      [&](auto* target) {
        if (option.required && (!is_given || is_missing(*target)))
          fail("--{} is missing{}{}", option.long_name(), option.required->empty() ? "" : ": ",
               *option.required);
        if (!is_given) return;
        check(option, *target);
        make_absolute(option, parsed.common, *target);
      },
      option.target);
}

// The names of the given options that have no effect, for each cause.
void warn_of_no_effect(std::span<const OptionList* const> lists, const ParsedOptions& parsed) {
  std::map<std::string, std::string> names_of;
  for (const OptionList* list : lists)
    for (const Option& option : list->options()) {
      if (option.without_effect.empty() || !given(parsed, option.long_name())) continue;
      std::string& names = names_of[option.without_effect];
      names += (names.empty() ? "--" : ", --") + option.long_name();
    }
  for (const auto& [cause, names] : names_of) log_warning("{}: without effect: {}", names, cause);
}

}  // namespace

void take_values(std::span<const OptionList* const> lists, const ParsedOptions& parsed) {
  // Another name of an option has the same target: the rules of the option hold for it, too.
  std::vector<OptionTarget> targets;
  for (const OptionList* list : lists)
    for (const Option& option : list->options())
      if (given(parsed, option.long_name())) targets.push_back(option.target);
  for (const OptionList* list : lists)
    for (const Option& option : list->options())
      take_value(option, parsed, std::ranges::find(targets, option.target) != targets.end());
  warn_of_no_effect(lists, parsed);
}

void check_range(const std::string& option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", option, value, low, high);
}

void warn_without_effect(const ParsedOptions& parsed, std::span<const char* const> names,
                         const std::string& cause) {
  std::string listed;
  for (const char* name : names)
    if (given(parsed, name)) listed += (listed.empty() ? "--" : ", --") + std::string(name);
  if (!listed.empty()) log_warning("{}: without effect {}", listed, cause);
}

void warn_without_effect(const ParsedOptions& parsed, std::initializer_list<const char*> names,
                         const std::string& cause) {
  warn_without_effect(parsed, std::span(names.begin(), names.end()), cause);
}

}  // namespace axial
