// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/newer_options.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/error.h"

namespace axial {
namespace {

constexpr std::array<std::string_view, 12> kLong{"--fusion-filter",
                                                 "--crop-roi-file",
                                                 "--export-dmaps",
                                                 "--up-axis",
                                                 "--normalize-coordinates",
                                                 "--estimate-segmentation",
                                                 "--invert-transform",
                                                 "--convert",
                                                 "--binary",
                                                 "--no-points",
                                                 "--common-intrinsics",
                                                 "--estimate-roi"};

constexpr std::array<std::string_view, 3> kShortOfDensify{"-t", "-d", "-m"};

}  // namespace

void refuse_newer_option(const std::string& program, const std::string& option) {
  const std::string name = option.substr(0, option.find('='));
  const bool is_short =
      program == "DensifyPointCloud" && !name.starts_with("--") &&
      std::ranges::find(kShortOfDensify, name.substr(0, 2)) != kShortOfDensify.end();
  if (!is_short && std::ranges::find(kLong, name) == kLong.end()) return;
  fail("{}: an option of OpenMVS 2.4 that {} does not have", is_short ? name.substr(0, 2) : name,
       program);
}

}  // namespace axial
