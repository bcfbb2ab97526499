// SPDX-License-Identifier: GPL-3.0-or-later
// Figures (SVG) of line panels or map panels, side by side in rows.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

struct Line {
  std::string name;
  std::vector<double> x, y;
};

// Lines with the same name have the same colour in all panels of a figure only if they have the
// same order in all panels.
struct LinePanel {
  std::string title, x_title, y_title;
  std::vector<Line> lines;
  bool logarithmic = false;  // of the y axis
  bool marked = true;        // a dot at every value
};

// The figure with `columns` panels in each row. Each panel has its legend.
std::string draw_lines(const std::string& title, const std::vector<LinePanel>& panels,
                       std::size_t columns);

struct MapPanel {
  std::string title;
  std::size_t width = 0;       // of the map
  std::vector<double> values;  // row by row; negative: no value, drawn grey
};

// All maps with one colour scale from 0 to `highest`, which is drawn beside them.
std::string draw_maps(const std::string& title, const std::vector<MapPanel>& panels,
                      std::size_t columns, double highest, const std::string& unit);

}  // namespace axial::experiments
