// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "control/read_control.h"
#include "io/wrong_input.h"

namespace axial::control {

class ControlFiles : public test::FolderTest {
 protected:
  std::filesystem::path put(const std::string& name, std::string_view text) const {
    test::put(folder_ / name, text);
    return folder_ / name;
  }
  Control read(const std::string& name, std::string_view text,
               const ControlReading& options = {}) const {
    return read_control(put(name, text), options);
  }
};

inline const ControlPoint& point_named(const Control& control, std::string_view label) {
  const auto found = std::ranges::find(control.points, label, &ControlPoint::label);
  EXPECT_NE(found, control.points.end()) << label;
  return *found;
}

}  // namespace axial::control
