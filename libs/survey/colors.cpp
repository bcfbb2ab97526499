// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/colors.h"

#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/first_error.h"
#include "base/parallel.h"
#include "io/images/folder_ends.h"

namespace axial::survey {
namespace {

namespace fs = std::filesystem;

// The subfolders of the colours, in the order in which they are searched, by photographs' folders.
using Subfolders = std::map<fs::path, std::vector<fs::path>>;

fs::path colors_of(const fs::path& photograph, const fs::path& folder, Subfolders& subfolders) {
  const fs::path parent = photograph.parent_path(), name = restored_name(photograph).filename();
  auto searched = subfolders.find(parent);
  if (searched == subfolders.end())
    searched = subfolders.emplace(parent, io::folder_ends(folder, parent)).first;
  for (const fs::path& end : searched->second) {
    const fs::path file = end.empty() ? folder / name : folder / end / name;
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  fail("{} {}: no colours for image {}: looked for {}", setting("color_folder"), folder.string(),
       photograph.string(), (parent.filename() / name).string());
}

void refuse_shared_colors(const std::vector<View>& views) {
  std::map<fs::path, const View*> owners;
  for (const View& view : views) {
    const auto [owner, is_first] = owners.emplace(view.colors, &view);
    if (!is_first)
      fail_in(view.colors, "would give the colours of both {} and {}", owner->second->file.string(),
              view.file.string());
  }
}

void read_colors_header(View& view) {
  view.colors_header = io::read_image_header(view.colors);
  const cv::Size size = view.colors_header.size, wanted = view.header.size;
  if (size != wanted)
    fail_in(view.colors, "is {}x{}, but its photograph {} is {}x{}", size.width, size.height,
            view.file.string(), wanted.width, wanted.height);
}

}  // namespace

fs::path restored_name(const fs::path& photograph) {
  fs::path name = photograph;
  if (!is_jpeg_name(name) && lower_extension(name) != ".png") name.replace_extension(".png");
  return name;
}

void find_colors(Survey& survey) {
  const fs::path& folder = survey.options.color_folder;
  if (folder.empty()) return;
  std::error_code error;
  if (!fs::is_directory(folder, error))
    fail("{} {}: is not a folder", setting("color_folder"), folder.string());
  Subfolders subfolders;
  for (View& view : survey.views) view.colors = colors_of(view.file, folder, subfolders);
  refuse_shared_colors(survey.views);
  FirstError first;
  parallel_for(survey.views.size(),
               [&](std::size_t v) { first.run(v, [&] { read_colors_header(survey.views[v]); }); });
  first.rethrow();
}

}  // namespace axial::survey
