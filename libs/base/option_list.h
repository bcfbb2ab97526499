// SPDX-License-Identifier: GPL-3.0-or-later
// Options of a program, each bound to a variable of the caller's. base/program.h parses them. The
// parsing library is not included here, because its headers take a second to compile.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace axial {

using OptionTarget = std::variant<bool*, int*, unsigned*, std::uint64_t*, double*, std::string*,
                                  std::vector<std::string>*>;

struct Option {
  std::string name;  // "resolution-level", or "input-file,i" with a letter
  OptionTarget target;
  std::string help;
  bool shows_default = false;  // --help names the value that the target has at declaration
  bool is_switch = false;      // of a bool: the name alone means true
};

// The options in the order of --help. A variable keeps its value unless its option is given on the
// command line or in the cfg file. The variables must outlive parse_options().
class OptionList {
 public:
  OptionList() = default;
  // `title` is the headline in --help.
  explicit OptionList(std::string title) : title_(std::move(title)) {}

  // An option without a default, or with one that `help` explains. A vector takes the values of all
  // occurrences of the option.
  OptionList& add(const char* name, OptionTarget target, const char* help) {
    options_.push_back({name, target, help});
    return *this;
  }

  // An option whose default is the value that the target has now. Not for vectors.
  OptionList& add_with_default(const char* name, OptionTarget target, const char* help) {
    options_.push_back({name, target, help, true});
    return *this;
  }

  // A bool with a default, whose value may be left out: "--quick" means "--quick 1".
  OptionList& add_switch(const char* name, bool* target, const char* help) {
    options_.push_back({name, target, help, true, true});
    return *this;
  }

  const std::string& title() const { return title_; }
  const std::vector<Option>& options() const { return options_; }

 private:
  std::string title_;
  std::vector<Option> options_;
};

}  // namespace axial
