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

// The colour of a line depends on its index in `lines`. So lines of the same name should have the
// same index in all panels of a figure.
struct LinePanel {
  std::string title, x_title, y_title;
  std::vector<Line> lines;
  bool logarithmic = false;  // whether the y axis is logarithmic
  bool marked = true;        // whether every value has a dot
};

// The figure with `columns` panels in each row. Each panel has its legend.
std::string draw_lines(const std::string& title, const std::vector<LinePanel>& panels,
                       std::size_t columns);

struct MapPanel {
  std::string title;
  std::size_t width = 0;       // number of values in a row
  std::vector<double> values;  // row by row; negative: no value, drawn grey
};

// The figure with `columns` panels in each row. All maps have the same colour scale from 0 to
// `highest`, which is drawn beside the panels. `unit`: the unit of the values.
std::string draw_maps(const std::string& title, const std::vector<MapPanel>& panels,
                      std::size_t columns, double highest, const std::string& unit);

}  // namespace axial::experiments
