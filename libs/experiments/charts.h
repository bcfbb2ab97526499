// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of line panels or map panels, side by side in rows, as text in the format SVG.
#pragma once

#include <string>
#include <vector>

namespace axial::experiments {

// A polyline through the points (x[i], y[i]), in this order. `x` and `y` have the same length.
struct Line {
  std::string name;  // text in the legend
  std::vector<double> x, y;
};

// The x axis covers the x values of all lines, and the y axis covers their y values. A linear y
// axis begins at 0, so no y value may be negative. If `logarithmic`, each y value must be positive.
// The colour of a line depends on its index in `lines`. So lines of the same name should have the
// same index in all panels of a figure.
struct LinePanel {
  std::string title, x_title, y_title;
  std::vector<Line> lines;
  bool logarithmic = false;  // whether the y axis is logarithmic
  bool marked = true;        // whether every value has a dot
};

// Returns the figure with `columns` panels in each row, row by row. Each panel has its legend.
// Precondition: `columns` is at least 1.
std::string draw_lines(const std::string& title, const std::vector<LinePanel>& panels,
                       std::size_t columns);

// A map of values in rows of equal length.
struct MapPanel {
  std::string title;
  std::size_t width = 0;       // number of values in a row
  std::vector<double> values;  // row by row; negative: no value, drawn grey
};

// Returns the figure with `columns` panels in each row, row by row. Each map is drawn as a square.
// All maps have the same colour scale from 0 to `highest`, which is drawn beside the panels. Larger
// values have the colour of `highest`. `unit`: the text for the unit of the values. Precondition:
// `columns` and `highest` are positive, and each map has at least one row.
std::string draw_maps(const std::string& title, const std::vector<MapPanel>& panels,
                      std::size_t columns, double highest, const std::string& unit);

}  // namespace axial::experiments
