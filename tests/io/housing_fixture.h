// SPDX-License-Identifier: GPL-3.0-or-later
// Examples of housing files, for the tests that read and write such files or attach ports to
// images.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "io/cameras/housing.h"
#include "io/wrong_input.h"

namespace axial::io {

inline const std::string kExample = R"({ "version": 1,
  "ports": {
    "main": { "type": "flat", "distance_m": 0.020, "thickness_m": 0.014, "normal": [0, 0, 1],
              "n_air": 1.0, "n_glass": 1.52, "n_water": 1.333 },
    "tilted": { "type": "flat", "distance_m": 0, "thickness_m": 0.5, "normal": [0.3, 0, 1],
                "n_glass": 1.33, "n_water": 1.49 } },
  "default": "main",
  "cameras": { "2": "tilted" },
  "images": { "dry_0001.jpg": "none", "left/a.jpg": "tilted" } }
)";

inline constexpr const char* kLake = R"({ "version": 1, "default": "lake", "ports": { "lake":
  { "type": "water-surface", "normal": [0, 0, -1], "point_m": [7, 8, 1.5], "n_water": 1.34 } },
  "images": { "dry.jpg": "none" } })";

using test::replaced;

inline auto& flat(auto& port) {
  return std::get<refractive::FlatPort<double>>(port);
}

class HousingTest : public test::FolderTest {
 protected:
  Housing read(const std::string& text) {
    test::put(file_, text);
    return read_housing(file_);
  }
  // Returns the error of reading kExample with the text `from` replaced by `to`.
  std::string error(const std::string& from, const std::string& to) {
    return test::error_naming(file_, [&] { read(replaced(kExample, from, to)); });
  }

  std::filesystem::path file_ = folder_ / "scene.housing.json";
};

}  // namespace axial::io
