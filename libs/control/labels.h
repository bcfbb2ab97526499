// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of targets, which other programs write in other ways, and marks of checks.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "control/control.h"

namespace axial::control {

// Whether a label has digits only, and at least one.
bool is_number(std::string_view label);

// Two labels name the same target if their keys are equal. Upper and lower case, blanks,
// underscores and zeros before a number do not matter, and a number alone is that of a circular
// target: "target 7", "Target_07" and "7" have the same key, "point 7" and "tag 7" have others.
std::string label_key(std::string_view label);
bool same_label(std::string_view first, std::string_view second);

// Whether both bars are between the same targets, in either order.
bool same_targets(const Bar& a, const Bar& b);

// The words for a bar in messages, and its name in mark_checks(): "target 1-target 2".
std::string name_of(const Bar& bar);

// Makes checks of the points and bars of these names. A name is the label of a point, or the labels
// of the targets of a bar, in either order, with a hyphen between them: "target 7",
// "target 1-target 2". Error that contains the name if there is no such point or bar; `control` is
// then unchanged.
void mark_checks(Control& control, std::span<const std::string> names);

}  // namespace axial::control
