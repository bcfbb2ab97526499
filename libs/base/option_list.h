// SPDX-License-Identifier: GPL-3.0-or-later
// Options of a program, each bound to a variable of the caller. base/program.h parses them. This
// header does not include the parsing library, whose headers take a second to compile.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace axial {

// The variable that gets the value of an option. Its type is the type of the value.
using OptionTarget = std::variant<bool*, int*, unsigned*, std::uint64_t*, double*, std::string*,
                                  std::vector<std::string>*>;

// One option. The functions add...() of OptionList make it.
struct Option {
  std::string name;     // without dashes: "resolution-level", or "input-file,i" with a short name
  OptionTarget target;  // not null
  std::string help;     // the text that --help prints beside the name
  bool shows_default = false;  // --help shows the value of the target at declaration
  bool is_switch = false;      // bool only: the name without a value means true
};

// The options of a program, in the order of --help. parse_options() (base/program.h) writes their
// values to the variables. A variable keeps its value unless its option is given on the command
// line or in the cfg file. The variables must exist until parse_options() has returned. The
// functions add...() return the list itself, so that calls can be chained.
class OptionList {
 public:
  OptionList() = default;
  // `title`: the headline in --help.
  explicit OptionList(std::string title) : title_(std::move(title)) {}

  // Adds an option for which --help shows no default: it has none, or `help` explains it. A vector
  // takes the values of all occurrences of the option.
  OptionList& add(const char* name, OptionTarget target, const char* help) {
    options_.push_back({name, target, help});
    return *this;
  }

  // Adds an option whose default is the present value of the target. --help shows this value. Not
  // for vectors.
  OptionList& add_with_default(const char* name, OptionTarget target, const char* help) {
    options_.push_back({name, target, help, true});
    return *this;
  }

  // Adds a bool option whose default is the present value of the target. --help shows this value.
  // The value may be omitted on the command line: "--quick" means "--quick 1".
  OptionList& add_switch(const char* name, bool* target, const char* help) {
    options_.push_back({name, target, help, true, true});
    return *this;
  }

  // The headline in --help.
  const std::string& title() const { return title_; }
  // The options in the order in which they were added.
  const std::vector<Option>& options() const { return options_; }

 private:
  std::string title_;
  std::vector<Option> options_;
};

}  // namespace axial
