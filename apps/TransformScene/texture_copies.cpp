// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture_copies.h"

#include <set>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// True if the two paths lead to the same file, which need not exist.
bool same_place(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (a == b || fs::equivalent(a, b, error)) return true;
  return a.filename() == b.filename() && fs::equivalent(a.parent_path(), b.parent_path(), error);
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::file_size(a, error) == fs::file_size(b, error) && read_file(a) == read_file(b);
}

// `name`: of the texture, relative to the folder of `input`, without needless dots.
TextureCopy copy_of(const fs::path& name, const fs::path& input, const fs::path& output) {
  TextureCopy copy{input.parent_path() / name, output.parent_path() / name};
  copy.needed = !same_place(copy.from, copy.to);
  if (!copy.needed) return copy;
  const std::string ply = input.string(), texture = copy.from.string();
  std::error_code ignored;
  if (*name.begin() == "..")
    fail_in(ply, "its texture {} cannot be copied, because it is outside of the folder of the mesh",
            texture);
  if (!fs::is_regular_file(copy.from, ignored)) fail_in(ply, "its texture {} is missing", texture);
  if (!fs::exists(copy.to, ignored)) return copy;
  copy.needed = false;
  if (!fs::is_regular_file(copy.to, ignored) || !same_bytes(copy.from, copy.to))
    fail_in(copy.to, "exists and differs from {}, the texture of {}, which would replace it",
            texture, ply);
  return copy;
}

}  // namespace

std::vector<TextureCopy> texture_copies(const fs::path& input, const fs::path& output) {
  std::set<fs::path> names;
  for (const std::string& name : io::textures_of_ply(input))
    if (!name.empty()) names.insert(fs::path(name).lexically_normal());
  std::vector<TextureCopy> copies;
  for (const fs::path& name : names) copies.push_back(copy_of(name, input, output));
  return copies;
}

}  // namespace axial::apps
