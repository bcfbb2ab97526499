// SPDX-License-Identifier: GPL-3.0-or-later
#include "folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/atomic_file.h"
#include "base/base64.h"
#include "base/error.h"
#include "base/subprocess.h"
#include "io/artifacts/written_files.h"
#include "io/bytes/json.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "data/files.json";
constexpr std::size_t kFileBytes = 6'000'000;  // of data; a third more in base64

void write(const fs::path& path, std::string_view text, std::ios::openmode mode) {
  std::ofstream out(path, std::ios::binary | mode);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) fail_in(path, "cannot be written");
}

// The list of the files that ViewScene wrote into `folder`. Empty if there is none.
nlohmann::json list_of(const fs::path& folder) {
  const nlohmann::json list = io::read_object(folder / kList);
  const bool is_ours = list.contains("viewer.js") && list.contains("data/scene.js");
  return is_ours ? list : nlohmann::json();
}

}  // namespace

fs::path page_folder() {
  fs::path folder = program_folder().parent_path() / "share/axialmvs/view";
  if (!fs::exists(folder / "viewer.js"))
    fail(
        "--report: the viewer was not built, because {} is missing; docs/view.md tells what the "
        "build needs",
        (folder / "viewer.js").string());
  return folder;
}

void require_own_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    fail("--report {}: is a file, not a folder", folder.string());
  require_writable_folder(folder);  // removes what a killed run left
  if (fs::exists(folder, error) && !fs::is_empty(folder, error) && list_of(folder).empty())
    fail("--report {}: contains other files: give an empty or a new folder", folder.string());
}

void write_own_folder(const fs::path& folder,
                      const std::function<void(const fs::path& staging)>& write) {
  const bool is_new = !fs::exists(folder);
  nlohmann::json now;
  write_folder(folder, [&](const fs::path& staging) {
    write(staging);
    now = io::list_files(staging);
    if (is_new) {
      io::write_json(staging / kList, now);
      return;
    }
    // While the files are replaced, the list names those of both runs. So a killed run leaves a
    // folder that the next run knows.
    nlohmann::json both = list_of(folder);
    both.update(now);
    fs::create_directories((folder / kList).parent_path());
    io::write_json(folder / kList, both);
  });
  if (is_new) return;
  std::vector<fs::path> old = io::find_written(folder, list_of(folder)).unchanged;
  std::erase_if(old, [&](const fs::path& file) { return now.contains(file.generic_string()); });
  io::remove_below(folder, old);
  io::write_json(folder / kList, now);
}

DataFiles::DataFiles(fs::path staging, std::string kind)
    : staging_(std::move(staging)), kind_(std::move(kind)) {}

std::string DataFiles::add(std::string_view bytes) {
  if (room_ < bytes.size()) {
    ++files_;
    room_ = std::max(kFileBytes, bytes.size());
  }
  room_ -= bytes.size();
  std::string name = fmt::format("data/{}-{:04}.js", kind_, files_ - 1);
  write(staging_ / name,
        fmt::format("axialData.put(\"{}\",{},\"{}\");\n", kind_, entries_++, base64(bytes)),
        std::ios::app);
  return name;
}

void write_scene_file(const fs::path& staging, const nlohmann::ordered_json& scene) {
  write(staging / "data/scene.js", "axialData.scene(" + io::to_text(scene) + ");\n",
        std::ios::trunc);
}

}  // namespace axial::apps
