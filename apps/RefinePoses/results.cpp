// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/out_of_memory.h"

namespace axial::apps {

namespace fs = std::filesystem;

pose::Uncertainty write_results(const fs::path& folder,
                                const std::function<void(const fs::path& staging)>& write_model,
                                const Results& results,
                                const std::function<pose::Uncertainty()>& compute) {
  constexpr const char* kReport = "report.json";
  write_folder(folder, [&](const fs::path& staging) {
    write_model(staging);
    write_atomically(staging / kReport, report_json(results, nullptr));
  });
  try {
    pose::Uncertainty known = compute();
    write_atomically(folder / kReport, report_json(results, &known));
    return known;
  } catch (const std::exception& error) {
    fail("{}: contains the refined model, only its standard deviations are missing: {}",
         folder.string(), is_out_of_memory(error) ? "memory ran out" : error.what());
  }
}

}  // namespace axial::apps
