// SPDX-License-Identifier: GPL-3.0-or-later
// A Markdown page that shows results without a number copied by hand.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/experiment.h"

namespace axial {

// Error unless the page can be read and written, has a table of each experiment, and an end to
// every table: better said before hours of computing than after them.
void check_page(const std::filesystem::path& page,
                const std::vector<experiments::Experiment>& experiments);

// Puts each table of `documents` between the lines "<!-- FILE.md -->" and "<!-- end -->" of the
// page, where it has them, and writes each figure that the page shows as "images/FILE.svg" there.
void update_page(const std::filesystem::path& page,
                 const std::vector<experiments::Document>& documents);

}  // namespace axial
