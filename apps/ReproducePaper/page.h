// SPDX-License-Identifier: GPL-3.0-or-later
// A Markdown page with results. The program inserts the tables and figures, so that no number is
// copied by hand.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/experiment.h"

namespace axial::apps {

// Checks the page before the experiments, which take hours. Error unless the page can be read and
// written, has at least one table of each experiment, and has the marker "<!-- end -->" after every
// table.
void check_page(const std::filesystem::path& page,
                const std::vector<experiments::Experiment>& experiments);

// For each table FILE.md of `documents`: replaces the text between the markers "<!-- FILE.md -->"
// and "<!-- end -->" of the page by the table, if the page has these markers. For each figure
// FILE.svg of `documents`: writes it to images/FILE.svg beside the page, if the page shows this
// file.
void update_page(const std::filesystem::path& page,
                 const std::vector<experiments::Document>& documents);

}  // namespace axial::apps
