// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/state_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <type_traits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"

namespace axial::refine {
namespace {

// The numbers at the beginning of the file, before the arrays.
struct Head {
  std::array<char, 32> kind{};  // kKind
  std::array<char, 32> fingerprint{};
  std::uint64_t vertices = 0, colors = 0, faces = 0, pairs = 0;  // lengths of the arrays
  std::uint64_t done = 0, split_faces = 0, measured = 0, steps = 0;
  double moved = 0;
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 136);

// The number is the version of the method and of the file.
constexpr std::string_view kKind = "AxialMVS refinement of a mesh 1";
constexpr std::size_t kEnd = 32;  // bytes of the fingerprint of all bytes before

using Pairs = std::vector<std::array<std::uint64_t, 2>>;

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

Head head_of(const State& state, const std::string& fingerprint) {
  Head head;
  kKind.copy(head.kind.data(), head.kind.size());
  fingerprint.copy(head.fingerprint.data(), head.fingerprint.size());
  head.vertices = state.mesh.vertices.size();
  head.colors = state.mesh.colors.size();
  head.faces = state.mesh.faces.size();
  head.pairs = state.pairs.size();
  head.done = state.done;
  head.split_faces = state.report.split_faces;
  head.measured = state.report.measured;
  head.steps = state.report.steps;
  head.moved = state.report.moved;
  return head;
}

// The size of the file, or nothing if the lengths cannot be those of a file of `size` bytes.
std::optional<std::uint64_t> size_of(const Head& head, std::uint64_t size) {
  if (std::max({head.vertices, head.colors, head.faces, head.pairs}) > size) return {};
  return sizeof(head) + head.vertices * 2 * sizeof(Eigen::Vector3f) + head.colors * sizeof(Rgb) +
         head.faces * 3 * sizeof(std::uint32_t) + head.pairs * sizeof(Pairs::value_type) + kEnd;
}

// Reads the next `count` values of the stream, and adds them to `print`.
template <class T>
std::vector<T> read_next(std::istream& in, std::uint64_t count, Fingerprint& print) {
  std::vector<T> values(count);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
  print.add(bytes_of(values));
  return values;
}

std::string_view text_of(const std::array<char, 32>& text) {
  return {text.data(), text.size()};
}

}  // namespace

std::string fingerprint(const Mesh& mesh, const Options& options, const std::string& views) {
  // A new option does not compile until it has a name here.
  const auto& [scales, scale_step, max_views, references, smoothness, anchor, max_face_area,
               max_bytes, bytes_afterwards, name_of] = options;
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
  const Head head = head_of(state, fingerprint);
  Pairs pairs;
  for (const auto& [a, b] : state.pairs) pairs.push_back({a, b});
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    Fingerprint print;
    for (const std::string_view part :
         {std::string_view(reinterpret_cast<const char*>(&head), sizeof(head)),
          bytes_of(state.mesh.vertices), bytes_of(state.mesh.colors), bytes_of(state.mesh.faces),
          bytes_of(state.first), bytes_of(pairs)}) {
      out.write(part.data(), static_cast<std::streamsize>(part.size()));
      print.add(part);
    }
    out << print.hex();
    out.close();
    if (!out) fail("{}: cannot be written", temporary.string());
  });
}

std::optional<State> read_state(const std::filesystem::path& file, const std::string& fingerprint) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return {};  // also for a pipe, whose opening would wait for a writer
  std::ifstream in(file, std::ios::binary);
  Head head;
  if (!in.read(reinterpret_cast<char*>(&head), sizeof(head))) return {};
  if (!text_of(head.kind).starts_with(kKind) || text_of(head.fingerprint) != fingerprint) return {};
  if (size_of(head, size) != size) return {};
  Fingerprint print;
  print.add(std::string_view(reinterpret_cast<const char*>(&head), sizeof(head)));
  State state;
  state.mesh.vertices = read_next<Eigen::Vector3f>(in, head.vertices, print);
  state.mesh.colors = read_next<Rgb>(in, head.colors, print);
  state.mesh.faces = read_next<std::array<std::uint32_t, 3>>(in, head.faces, print);
  state.first = read_next<Eigen::Vector3f>(in, head.vertices, print);
  for (const auto& [a, b] : read_next<Pairs::value_type>(in, head.pairs, print))
    state.pairs.emplace_back(a, b);
  state.done = static_cast<unsigned>(head.done);
  state.report = {head.split_faces, head.pairs, head.measured, static_cast<unsigned>(head.steps),
                  head.moved};
  std::string end(kEnd, '\0');
  in.read(end.data(), kEnd);
  if (!in || end != print.hex()) return {};
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
