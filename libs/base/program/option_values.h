// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of a table of options (base/program/option_list.h), applied to the values that a user
// gave.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "base/program/option_list.h"
#include "base/program/parsed_options.h"

namespace axial {

// Checks and converts the values of the given options of `lists`, and warns of options that have no
// effect. parse_options() calls this function. Throws an Error that names the option and the value
// for the first value, in the order of the lists, that breaks a rule, and for a required option
// that is absent.
void take_values(std::span<const OptionList* const> lists, const ParsedOptions& parsed);

// Throws the Error "--<option> <value>: must be from <low> to <high>" unless `value` is in the
// range. For ranges that depend on other options.
void check_range(const std::string& option, double value, double low, double high);

// Logs one warning "--a, --b: without effect <cause>" that lists the given options among `names`.
// Logs nothing if none of them is given.
void warn_without_effect(const ParsedOptions& parsed, std::span<const char* const> names,
                         const std::string& cause);
void warn_without_effect(const ParsedOptions& parsed, std::initializer_list<const char*> names,
                         const std::string& cause);

}  // namespace axial
