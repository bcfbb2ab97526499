// SPDX-License-Identifier: GPL-3.0-or-later
// The folder that is written: the refined model first, then how well it is known.
#pragma once

#include <filesystem>
#include <functional>

#include "report.h"

// Writes `folder` whole: what `write_model` leaves in the staging folder whose name it gets, and a
// report.json that says that the standard deviations are missing. Then computes these by `compute`,
// writes them into report.json, and returns them. If that fails, for want of memory, say, the
// folder stays, and an Error says that they alone are missing.
axial::pose::Uncertainty write_results(
    const std::filesystem::path& folder,
    const std::function<void(const std::filesystem::path& staging)>& write_model,
    const Results& results, const std::function<axial::pose::Uncertainty()>& compute);
