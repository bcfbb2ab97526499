// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_copies.h"

#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "map/stated_kind.h"
#include "private/gdal_calls.h"
#include "private/map_metadata.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

struct Source {
  fs::path MapFiles::*file;
  const char* name;
  bool is_measured;  // whether copies of other widths and for TagLab are made
};

constexpr Source kSources[] = {{&MapFiles::colors, "ortho", true},
                               {&MapFiles::heights, "dem", true},
                               {&MapFiles::counts, "views", false},
                               {&MapFiles::errors, "sigma", false},
                               {&MapFiles::shades, "hillshade", false}};

using Words = std::vector<std::string>;

void add(Words& words, std::initializer_list<std::string> more) {
  words.insert(words.end(), more);
}

Words format_of(Preset preset, bool is_float) {
  const std::string predictor = is_float ? "PREDICTOR=3" : "PREDICTOR=2";
  Words words{"-co", "BIGTIFF=IF_SAFER"};
  if (preset == Preset::gis) {
    add(words, {"-of", "COG", "-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=YES", "-co",
                "BLOCKSIZE=512", "-co", "OVERVIEWS=IGNORE_EXISTING", "-co",
                "OVERVIEW_RESAMPLING=AVERAGE", "-co", "OVERVIEW_PREDICTOR=YES"});
    return words;
  }
  add(words, {"-of", "GTiff", "-co", "TILED=YES", "-co", "BLOCKXSIZE=512", "-co", "BLOCKYSIZE=512",
              "-co", "INTERLEAVE=PIXEL"});
  if (preset == Preset::taglab)
    add(words, {"-co", "COMPRESS=LZW"});
  else
    add(words, {"-co", "COMPRESS=DEFLATE", "-co", predictor});
  return words;
}

// A copy of the pixels `block` of a map that is reduced to `size`.
struct Copy {
  Preset preset;
  cv::Size size;
  cv::Rect block;
  std::string source;  // the name of the map
};

// The pixels of the map that the copy shows, and their number in the copy.
Words window_of(const Copy& copy, const MapGrid& grid) {
  const double scale = static_cast<double>(grid.columns) / copy.size.width;
  Words words{"-srcwin"};
  for (const int side : {copy.block.x, copy.block.y, copy.block.width, copy.block.height})
    words.push_back(fmt::format("{}", side * scale));
  if (copy.size.width == grid.columns) return words;
  add(words, {"-outsize", std::to_string(copy.block.width), std::to_string(copy.block.height), "-r",
              "average"});
  return words;
}

struct TranslateOptions {
  explicit TranslateOptions(const Words& words) {
    char** list = nullptr;
    for (const std::string& word : words) list = CSLAddString(list, word.c_str());
    options = GDALTranslateOptionsNew(list, nullptr);
    CSLDestroy(list);
  }
  ~TranslateOptions() { GDALTranslateOptionsFree(options); }
  TranslateOptions(const TranslateOptions&) = delete;
  TranslateOptions& operator=(const TranslateOptions&) = delete;

  GDALTranslateOptions* options;
};

// A world file has the centre of the upper left pixel.
std::string world_file_of(const MapGrid& grid) {
  return fmt::format("{}\n0\n0\n{}\n{}\n{}\n", grid.pixel, -grid.pixel, grid.left + grid.pixel / 2,
                     grid.top - grid.pixel / 2);
}

void write_copy(const Copy& copy, const fs::path& map, std::span<const fs::path> paths) {
  const GdalErrors errors;
  // Means of the reduced copies in the file would not be exact means.
  const GdalOptions exact{{"OVERVIEW_LEVEL", "NONE"}};
  const DatasetPtr source(
      GDALOpenEx(map.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, exact.list(), nullptr));
  errors.require_read(source != nullptr, map);
  const bool is_float = GDALGetRasterDataType(GDALGetRasterBand(source.get(), 1)) == GDT_Float32;
  Words words = format_of(copy.preset, is_float);
  const Words window = window_of(copy, grid_of(source.get()));
  words.insert(words.end(), window.begin(), window.end());
  add(words, {"-mo", fmt::format("{}={}", kCopyItem, copy.source)});
  const TranslateOptions options(words);
  int is_wrong = 0;
  DatasetPtr made(GDALTranslate(paths[0].c_str(), source.get(), options.options, &is_wrong));
  errors.require_written(made != nullptr && is_wrong == 0, paths[0]);
  const MapGrid grid = grid_of(made.get());
  made.reset();
  errors.require_written(true, paths[0]);
  if (paths.size() > 1) write_atomically(paths[1], world_file_of(grid));
}

std::string word_of(Preset preset) {
  return preset == Preset::gis ? "" : preset == Preset::taglab ? ".taglab" : ".archive";
}

// Beginnings and length of `count` parts of a side that share `overlap` pixels.
std::vector<cv::Range> parts_of(int side, int most, int overlap) {
  if (side <= most) return {{0, side}};
  const int step = most - overlap;
  const int count = (side - overlap + step - 1) / step;
  const int length = (side + (count - 1) * overlap + count - 1) / count;
  std::vector<cv::Range> parts;
  for (int i = 0; i < count; ++i) {
    const int begin = std::min(i * (length - overlap), side - length);
    parts.emplace_back(begin, begin + length);
  }
  return parts;
}

// "_r1_c2", with as many digits as the last block, so that the names are in order.
std::string place_of(const CopyBlock& block, const CopyBlock& last) {
  const auto digits = [](int number) { return std::to_string(number).size(); };
  return fmt::format("_r{:0{}}_c{:0{}}", block.row, digits(last.row), block.column,
                     digits(last.column));
}

void add_copies(const Source& source, const MapFiles& maps, cv::Size size, const std::string& begin,
                const CopyOptions& options, std::vector<FurtherFiles>& copies) {
  const int most = options.preset == Preset::taglab ? options.most : 1 << 30;
  const std::vector<CopyBlock> blocks = blocks_of(size, most, options.overlap);
  for (const CopyBlock& block : blocks) {
    const std::string name = begin + (blocks.size() > 1 ? place_of(block, blocks.back()) : "");
    FurtherFiles files;
    files.paths.emplace_back(name + ".tif");
    if (options.preset == Preset::archive) files.paths.emplace_back(name + ".tfw");
    const Copy copy{options.preset, size, block.pixels, (maps.*source.file).filename().string()};
    files.write = [copy, member = source.file](const MapFiles& written,
                                               std::span<const fs::path> paths) {
      write_copy(copy, written.*member, paths);
    };
    copies.push_back(std::move(files));
  }
}

}  // namespace

std::vector<CopyBlock> blocks_of(cv::Size size, int most, int overlap) {
  std::vector<CopyBlock> blocks;
  const std::vector<cv::Range> columns = parts_of(size.width, most, overlap);
  int row = 0;
  for (const cv::Range& y : parts_of(size.height, most, overlap)) {
    ++row;
    int column = 0;
    for (const cv::Range& x : columns)
      blocks.push_back({row, ++column, {x.start, y.start, x.size(), y.size()}});
  }
  return blocks;
}

cv::Size size_of_copy(const MapGrid& grid, int width) {
  constexpr double kRounding = 1e-6;  // [px]
  const double rows = static_cast<double>(grid.rows) * width / grid.columns;
  return {width, std::max(1, static_cast<int>(std::ceil(rows - kRounding)))};
}

void require_widths(const CopyOptions& options, const MapGrid& grid) {
  constexpr double kLess = 0.995;  // the printed number is rounded, and a grid has a margin
  for (const int width : options.widths)
    if (width > grid.columns)
      fail(
          "{} {}: the map has {} columns of {:.4g} m, and wider copies would show nothing new; a "
          "map of this width needs {} {:.3g}",
          setting("widths"), width, grid.columns, grid.pixel, setting("ground_sample_distance"),
          kLess * grid.pixel * std::max(1, grid.columns - 2) / width);
}

std::vector<FurtherFiles> copies_of(const MapFiles& maps, const MapGrid& grid,
                                    const fs::path& output, const CopyOptions& options) {
  std::vector<FurtherFiles> copies;
  for (const Source& source : kSources) {
    if ((maps.*source.file).empty()) continue;
    const std::string begin = output.string() + word_of(options.preset) + "." + source.name;
    if (options.preset == Preset::archive ||
        (options.preset == Preset::taglab && source.is_measured))
      add_copies(source, maps, {grid.columns, grid.rows}, begin, options, copies);
    if (!source.is_measured) continue;
    for (const int width : options.widths)
      add_copies(source, maps, size_of_copy(grid, width), fmt::format("{}_{}", begin, width),
                 options, copies);
  }
  return copies;
}

}  // namespace axial::map
