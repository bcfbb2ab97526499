// SPDX-License-Identifier: GPL-3.0-or-later
// Panels of lines and panels of maps, side by side in rows.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

struct Line {
  std::string name;
  std::vector<double> x, y;
};

// Lines of the same name have the same colour in all panels of a figure only if they come in the
// same order.
struct LinePanel {
  std::string title, x_title, y_title;
  std::vector<Line> lines;
  bool logarithmic = false;  // the y axis
  bool marked = true;        // a dot at every value
};

// `columns` panels a row, each with its legend.
std::string draw_lines(const std::string& title, const std::vector<LinePanel>& panels,
                       std::size_t columns);

struct MapPanel {
  std::string title;
  std::size_t width = 0;       // of the map
  std::vector<double> values;  // row by row; below zero: none, drawn grey
};

// All maps in one scale of colours from 0 to `highest`, drawn beside them.
std::string draw_maps(const std::string& title, const std::vector<MapPanel>& panels,
                      std::size_t columns, double highest, const std::string& unit);

}  // namespace axial::experiments
