// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.h"

#include "base/atomic_file.h"
#include "base/hash.h"

namespace axial {
namespace {

namespace fs = std::filesystem;
using experiments::Json;
using experiments::Part;

// Parts of other inputs, such as a quick run's, stand beside each other.
fs::path part_file(const fs::path& folder, const Part& part) {
  const std::string key = Fingerprint().add(part.inputs.dump()).hex().substr(0, 8);
  return folder / (part.name + "-" + key + ".json");
}

// The kept part, or null. A damaged file is as good as none.
Json kept_part(const fs::path& file, const Part& part) {
  if (!fs::is_regular_file(file)) return nullptr;
  const Json kept = Json::parse(read_file(file), nullptr, false);
  const bool whole = kept.is_object() && kept.contains("inputs") && kept.contains("result");
  return whole && kept["inputs"] == part.inputs ? kept : Json(nullptr);
}

}  // namespace

Json computed_results(const experiments::Experiment& experiment, bool quick, const fs::path& folder,
                      const ProgressSink& progress) {
  const fs::path parts_folder = folder / "parts" / experiment.name;
  make_folder(parts_folder);
  Json results{{"experiment", experiment.name}, {"quick", quick}, {"parts", Json::object()}};
  for (std::size_t k = 0; k < experiment.parts.size(); ++k) {
    const Part& part = experiment.parts[k];
    const fs::path file = part_file(parts_folder, part);
    Json kept = kept_part(file, part);
    if (kept.is_null()) {
      kept = {{"inputs", part.inputs}, {"result", part.compute()}};
      write_atomically(file, kept.dump() + "\n");
    }
    results["parts"][part.name] = std::move(kept);
    if (progress) progress(k + 1, experiment.parts.size());
  }
  return results;
}

}  // namespace axial
