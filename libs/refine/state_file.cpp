// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/state_file.h"

#include <array>
#include <string_view>

#include "base/hash.h"
#include "io/artifacts/array_file.h"

namespace axial::refine {
namespace {

// The number is the version of the method and of the file.
constexpr const char* kKind = "AxialMVS refinement of a mesh 2";

using Pairs = std::vector<std::array<std::uint64_t, 2>>;

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

std::string fingerprint(const Mesh& mesh, const Options& options, const std::string& views) {
  // A new option does not compile until it has a name here.
  const auto& [scales, scale_step, max_views, references, smoothness, anchor, max_face_area,
               bytes_afterwards] = options;
  Fingerprint print;
  print.add(kKind).add(bytes_of(mesh.vertices)).add(bytes_of(mesh.colors));
  print.add(bytes_of(mesh.faces)).add(views);
  for (const std::uint64_t value :
       {std::uint64_t{scales}, std::uint64_t{max_views}, static_cast<std::uint64_t>(references)})
    print.add(value);
  for (const double value : {scale_step, smoothness, anchor, max_face_area}) print.add(value);
  return print.hex();
}

void write_state(const std::filesystem::path& file, const State& state,
                 const std::string& fingerprint) {
  const Report& report = state.report;
  const std::vector<std::uint64_t> counts{state.done, report.split_faces, report.measured,
                                          report.steps};
  Pairs pairs;
  for (const auto& [a, b] : state.pairs) pairs.push_back({a, b});
  io::write_arrays({file, fingerprint, kKind}, counts, std::vector{report.moved},
                   state.mesh.vertices, state.mesh.colors, state.mesh.faces, state.first, pairs);
}

std::optional<State> read_state(const std::filesystem::path& file, const std::string& fingerprint) {
  State state;
  std::vector<std::uint64_t> counts;
  std::vector<double> moved;
  Pairs pairs;
  if (!io::read_arrays({file, fingerprint, kKind}, counts, moved, state.mesh.vertices,
                       state.mesh.colors, state.mesh.faces, state.first, pairs))
    return {};
  for (const auto& [a, b] : pairs) state.pairs.emplace_back(a, b);
  state.done = static_cast<unsigned>(counts.at(0));
  state.report = {counts.at(1), pairs.size(), counts.at(2), static_cast<unsigned>(counts.at(3)),
                  moved.at(0)};
  return state;
}

StateOfRun::~StateOfRun() {
  if (is_removed_ && !context_.stop_requested()) remove();
}

void StateOfRun::write(const State& state, const std::string& fingerprint) {
  writing([&] { write_state(file_, state, fingerprint); });
  is_removed_ = true;
}

void StateOfRun::writing(const std::function<void()>& write) {
  try {
    write();
  } catch (...) {
    is_removed_ = false;
    std::error_code ignored;
    if (std::filesystem::exists(file_, ignored))
      context_.warning("{}: is kept: the same command continues from there", file_.string());
    throw;
  }
}

void StateOfRun::remove() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace axial::refine
