// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/results.h"

#include <fmt/format.h>

#include <chrono>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "base/parse_number.h"
#include "io/bytes/json.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;

fs::path parts_folder(const fs::path& folder, const std::string& experiment) {
  return folder / "parts" / experiment;
}

// The file name contains a hash of the inputs, so that parts with other inputs have other files.
fs::path part_file(const fs::path& folder, const Part& part) {
  const std::string key = Fingerprint().add(io::to_text(part.inputs)).hex().substr(0, 8);
  return folder / (part.name + "-" + key + ".json");
}

// Times are not stored in the part itself, whose bytes are the same for any number of threads.
fs::path time_file(fs::path part_file) {
  return part_file.replace_extension(".seconds");
}

// The stored part; null if there is none or its file is damaged.
Json kept_part(const fs::path& file, const Part& part) {
  if (!fs::is_regular_file(file)) return nullptr;
  const Json kept = io::json_from(read_file(file));
  const bool whole = kept.is_object() && kept.contains("inputs") && kept.contains("result");
  return whole && kept["inputs"] == part.inputs ? kept : Json(nullptr);
}

void compute(const Part& part, const fs::path& file) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const Json finished{{"inputs", part.inputs}, {"result", part.compute()}};
  const std::chrono::duration<double> taken = Clock::now() - begin;
  write_atomically(time_file(file), fmt::format("{:.2f}", taken.count()));
  write_atomically(file, io::to_text(finished) + "\n");
}

}  // namespace

std::vector<Part> chosen_parts(const Experiment& experiment, const std::string& beginning) {
  std::vector<Part> chosen;
  for (const Part& part : experiment.parts)
    if (part.name.starts_with(beginning)) chosen.push_back(part);
  return chosen;
}

void compute(const std::string& experiment, const std::vector<Part>& parts, const fs::path& folder,
             const ProgressSink& progress) {
  const fs::path kept = parts_folder(folder, experiment);
  make_folder(kept);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const fs::path file = part_file(kept, parts[k]);
    if (kept_part(file, parts[k]).is_null()) compute(parts[k], file);
    if (progress) progress(k + 1, parts.size());
  }
}

Json kept_results(const Experiment& experiment, bool quick, const fs::path& folder) {
  Json results{{"experiment", experiment.name}, {"quick", quick}, {"parts", Json::object()}};
  for (const Part& part : experiment.parts) {
    Json kept = kept_part(part_file(parts_folder(folder, experiment.name), part), part);
    if (kept.is_null()) return nullptr;
    results["parts"][part.name] = std::move(kept);
  }
  return results;
}

PartTimes part_times(const Experiment& experiment, const fs::path& folder) {
  PartTimes times;
  for (const Part& part : experiment.parts) {
    const fs::path file = time_file(part_file(parts_folder(folder, experiment.name), part));
    if (!fs::is_regular_file(file)) continue;
    const auto seconds = parse_number<double>(read_file(file));
    if (!seconds) continue;
    ++times.parts;
    times.sum += *seconds;
    if (*seconds < times.longest) continue;
    times.longest = *seconds;
    times.longest_part = part.name;
  }
  return times;
}

}  // namespace axial::experiments
