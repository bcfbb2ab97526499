// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the output folder: the refined model first, then its standard deviations.
#pragma once

#include <filesystem>
#include <functional>

#include "pose/adjust/uncertainty.h"
#include "report.h"

namespace axial::apps {

// Writes `folder` atomically: the files that `write_model` writes into the staging folder, and a
// report.json without standard deviations. Then calls `compute` for the standard deviations, writes
// them into report.json, and returns them. If `compute` throws, for example because memory ran out,
// the folder stays, and an Error says that only the standard deviations are missing.
pose::Uncertainty write_results(
    const std::filesystem::path& folder,
    const std::function<void(const std::filesystem::path& staging)>& write_model,
    const Results& results, const std::function<pose::Uncertainty()>& compute);

}  // namespace axial::apps
