// SPDX-License-Identifier: GPL-3.0-or-later
// A Markdown page with results: its numbers are inserted and never copied by hand.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/experiment.h"

namespace axial::apps {

// Error unless the page can be read and written, has a table of each experiment, and an end marker
// after every table. Called before the experiments, which take hours.
void check_page(const std::filesystem::path& page,
                const std::vector<experiments::Experiment>& experiments);

// Replaces the text between the lines "<!-- FILE.md -->" and "<!-- end -->" of the page by the
// table FILE.md of `documents`, for all tables that the page has. Writes each figure that the page
// shows as "images/FILE.svg".
void update_page(const std::filesystem::path& page,
                 const std::vector<experiments::Document>& documents);

}  // namespace axial::apps
