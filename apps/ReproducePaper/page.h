// SPDX-License-Identifier: GPL-3.0-or-later
// A Markdown page that shows results without a number copied by hand.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/experiment.h"

namespace axial {

// Puts each table of `documents` between the lines "<!-- FILE.md -->" and "<!-- end -->" of the
// page, where it has them, and writes each figure that the page shows as "images/FILE.svg" there.
void update_page(const std::filesystem::path& page,
                 const std::vector<experiments::Document>& documents);

}  // namespace axial
