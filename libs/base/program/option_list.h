// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a program's options: one entry an option, with its name, the variable that gets its
// value, its help, and the rules for its value. From the table base/program/program.h makes the
// parser and
// --help, checks values, and converts them. This header does not include the parsing library, whose
// headers take a second to compile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "axial/base.h"

namespace axial {

// The variable that gets the value of an option. Its type is the type of the value. A path becomes
// absolute: a relative one starts at the working folder, and an empty one stays empty.
using OptionTarget =
    std::variant<bool*, int*, unsigned*, std::uint64_t*, double*, std::string*,
                 std::vector<std::string>*, std::filesystem::path*,
                 std::vector<std::filesystem::path>*, std::optional<bool>*, std::optional<double>*>;

// What a path of an option names. The name of an output has no control characters, and that of an
// output file does not end in a slash, "." or "..".
enum class PathKind { input, output_file, output_folder };

// The values that a number may have. With `or_zero`, 0 is allowed, too.
struct OptionRange {
  double low = 0, high = 0;
  bool or_zero = false;
};

// A word that is a value of an option, and the function that writes its meaning to the target.
struct OptionChoice {
  std::string word;
  std::function<void()> take;
};

// A setting of a library that an option sets. Messages call it "--<option><value>".
struct OptionSetting {
  std::string name;   // a field ("mask_folder"), or a field with a value ("make_maps false")
  std::string value;  // "", or a value of the option with a space before it (" -1")
};

// One option. The functions of OptionList make it.
struct Option {
  std::string name;     // without dashes: "resolution-level", or "input-file,i" with a short name
  OptionTarget target;  // not null
  std::string help;     // the text that --help prints beside the name
  bool shows_default = false;             // --help shows the value of the target at declaration
  bool is_switch = false;                 // bool only: the name without a value means true
  PathKind path = PathKind::input;        // paths only
  std::optional<OptionRange> range{};     // numbers only
  bool is_positive = false;               // double only: a finite number above 0
  std::vector<OptionChoice> choices{};    // not empty: the value is one of these words
  std::vector<std::string> accepted{};    // not empty: not built; all spellings of the default
  std::optional<std::string> required{};  // the option must be given; what it is for ("" if clear)
  std::string without_effect{};           // not empty: the cause that a warning states
  std::function<void(const std::string&)> read{};  // converts a text
  std::vector<OptionSetting> settings{};
  std::shared_ptr<void> storage{};  // the target, where the caller has no variable for it

  // The name without the short name.
  std::string long_name() const { return name.substr(0, name.find(',')); }
};

// The options of a program, in the order of --help. parse_options() (base/program/program.h) checks
// their values and writes them to the variables. A variable keeps its value unless its option is
// given on the command line or in the cfg file. The variables must exist until parse_options() has
// returned. The functions add...() and the rules below them return the list itself, so that calls
// can be chained.
class OptionList {
 public:
  OptionList() = default;
  // `title`: the headline in --help.
  explicit OptionList(std::string title) : title_(std::move(title)) {}

  // Adds an option for which --help shows no default: it has none, or `help` explains it. A vector
  // takes the values of all occurrences of the option.
  OptionList& add(const char* name, OptionTarget target, const char* help) {
    options_.push_back({.name = name, .target = target, .help = help});
    return *this;
  }

  // Adds an option whose default is the present value of the target. --help shows this value. Not
  // for vectors.
  OptionList& add_with_default(const char* name, OptionTarget target, const char* help) {
    add(name, target, help).options_.back().shows_default = true;
    return *this;
  }

  // Adds a bool option whose default is the present value of the target. --help shows this value.
  // The value may be omitted on the command line: "--quick" means "--quick 1".
  OptionList& add_switch(const char* name, bool* target, const char* help) {
    add_with_default(name, target, help).options_.back().is_switch = true;
    return *this;
  }

  // Adds an option whose values are words, each with its meaning. The present value of `target`
  // must be one of the meanings: --help shows its word as the default.
  template <class T>
  OptionList& add_choice(
      const char* name, T* target,
      std::initializer_list<std::pair<const char*, std::type_identity_t<T>>> choices,
      const char* help) {
    auto word = std::make_shared<std::string>();
    add_with_default(name, word.get(), help);
    for (const auto& [text, meaning] : choices) {
      if (meaning == *target) *word = text;
      options_.back().choices.push_back({text, [target, value = meaning] { *target = value; }});
    }
    options_.back().storage = std::move(word);
    return *this;
  }

  // Adds an option whose text is converted by `read`, if the option is given. `read` throws an
  // Error that names the option for a text without a meaning.
  OptionList& add_text(const char* name, std::function<void(const std::string&)> read,
                       const char* help) {
    auto text = std::make_shared<std::string>();
    add(name, text.get(), help).options_.back().read = std::move(read);
    options_.back().storage = std::move(text);
    return *this;
  }

  // The same with a default, which --help shows and which is not converted.
  OptionList& add_text_with_default(const char* name, const std::string& shown,
                                    std::function<void(const std::string&)> read,
                                    const char* help) {
    add_text(name, std::move(read), help).options_.back().shows_default = true;
    *std::get<std::string*>(options_.back().target) = shown;
    return *this;
  }

  // Adds --max-memory: the limit of memory [MB], or 0. It sets ParsedOptions::memory.
  // `program_bytes`: as for MemoryBudget::of_program().
  OptionList& add_max_memory(
      std::uint64_t program_bytes = kProgramBytes,
      const char* help = "largest memory to use [MB] (0: 70 % of the free memory)") {
    max_memory_ = std::make_shared<std::uint64_t>(0);
    program_bytes_ = program_bytes;
    return add_with_default("max-memory", max_memory_.get(), help).range(0, 0x1p40);
  }

  // The budget that the value of --max-memory states. Without this option, it has no limit.
  MemoryBudget memory() const {
    if (!max_memory_) return {};
    return MemoryBudget::of_program(*max_memory_, program_bytes_);
  }

  // Adds an option of OpenMVS's programs whose function AxialMVS does not have. It accepts only its
  // default, in one of the spellings `accepted`: so scripts for OpenMVS that pass the default work
  // here, too, and every other value is refused. --help says that the option is not built yet.
  OptionList& add_not_built(const char* name, const std::string& value,
                            std::vector<std::string> accepted) {
    add_owned(name, value, "not built yet: accepts only the default");
    options_.back().accepted = std::move(accepted);
    return *this;
  }

  // Adds an option that has no effect. If it is given, a warning states the cause.
  template <class T>
  OptionList& add_without_effect(const char* name, T value, const char* help, const char* cause) {
    add_owned(name, value, help).options_.back().without_effect = cause;
    return *this;
  }

  // The rules below are for the option that was added last. They hold for the value that is given,
  // not for the default. A number must be from `low` to `high`.
  OptionList& range(double low, double high) {
    options_.back().range = {low, high};
    return *this;
  }
  // A number must be 0, or from `low` to `high`.
  OptionList& zero_or(double low, double high) {
    options_.back().range = {low, high, true};
    return *this;
  }
  // A number must be finite, and at least `low`.
  OptionList& at_least(double low) { return range(low, std::numeric_limits<double>::max()); }
  // A text must be one of `words`.
  OptionList& one_of(std::initializer_list<const char*> words) {
    for (const char* word : words) options_.back().choices.push_back({word, [] {}});
    return *this;
  }
  // A number must be finite and above 0.
  OptionList& positive() {
    options_.back().is_positive = true;
    return *this;
  }
  // The option must be given, and not be empty. `what`: what it is, for the message, or "".
  OptionList& required(const char* what) {
    options_.back().required = what;
    return *this;
  }
  // The path is the name of a file that the program writes.
  OptionList& output_file() {
    options_.back().path = PathKind::output_file;
    return *this;
  }
  // The path is the name of a folder that the program writes.
  OptionList& output_folder() {
    options_.back().path = PathKind::output_folder;
    return *this;
  }
  // The option sets the field `setting` of a library, and has another name than the field. A field
  // "max_memory" of an option "max-memory" needs no such rule. `value`: see OptionSetting.
  OptionList& sets(const char* setting, const char* value = "") {
    options_.back().settings.push_back({setting, value});
    return *this;
  }

  // The headline in --help.
  const std::string& title() const { return title_; }
  // The options in the order in which they were added.
  const std::vector<Option>& options() const { return options_; }

 private:
  template <class T>
  OptionList& add_owned(const char* name, const T& value, const char* help) {
    auto storage = std::make_shared<T>(value);
    add_with_default(name, storage.get(), help).options_.back().storage = std::move(storage);
    return *this;
  }

  std::string title_;
  std::vector<Option> options_;
  std::shared_ptr<std::uint64_t> max_memory_;
  std::uint64_t program_bytes_ = 0;
};

}  // namespace axial
