// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_database.h"

#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <set>
#include <span>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// The number of pairs that COLMAP's numbering of pairs has for each image.
constexpr std::int64_t kPairBase = 2147483647;
// COLMAP's numbers for two-view geometries: below kVerified none was found.
constexpr std::int64_t kVerified = 2, kWatermark = 7;

[[noreturn]] void fail_of(const std::string& file, sqlite3* database) {
  const int code = database ? sqlite3_errcode(database) : SQLITE_NOMEM;
  if (code == SQLITE_NOMEM) throw std::bad_alloc();
  fail_in(file, "is no database of COLMAP: {}", sqlite3_errmsg(database));
}

// A path as SQLite's URI. SQLite then neither creates files beside the database nor changes it,
// unless a program was killed and left the file of its last changes.
std::string uri_of(const fs::path& file) {
  std::string uri = "file:";
  for (const char c : fs::absolute(file).string())
    uri += c == '?' || c == '#' || c == '%' ? fmt::format("%{:02X}", c) : std::string(1, c);
  std::error_code error;
  const auto left = fs::file_size(file.string() + "-wal", error);
  return uri + (error || left == 0 ? "?immutable=1" : "");
}

class Database {
 public:
  explicit Database(const fs::path& file) : file_(file.string()) {
    if (!fs::is_regular_file(file)) fail_in(file_, "file not found");
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(uri_of(file).c_str(), &opened,
                                       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) fail_of(file_, opened);
  }

  const std::string& file() const { return file_; }
  sqlite3* get() const { return database_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> database_;
};

// The rows of a query. `table`: whose rows they are, for messages.
class Rows {
 public:
  Rows(const Database& database, std::string table, const std::string& query)
      : database_(database), table_(std::move(table)) {
    sqlite3_stmt* statement = nullptr;
    const int result = sqlite3_prepare_v2(database.get(), query.c_str(), -1, &statement, nullptr);
    statement_.reset(statement);
    if (result != SQLITE_OK) fail_of(database.file(), database.get());
  }

  bool next() {
    const int result = sqlite3_step(statement_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail_of(database_.file(), database_.get());
    return result == SQLITE_ROW;
  }

  std::int64_t integer(int column) const {
    require(column, SQLITE_INTEGER, "an integer");
    return sqlite3_column_int64(statement_.get(), column);
  }

  // An integer from `least` to `most`.
  std::int64_t integer(int column, std::int64_t least, std::int64_t most) const {
    const std::int64_t value = integer(column);
    if (value < least || value > most) fail("{} is {}", where(column), value);
    return value;
  }

  std::uint32_t id(int column) const {
    return static_cast<std::uint32_t>(integer(column, 0, kPairBase));
  }

  std::string text(int column) const {
    require(column, SQLITE_TEXT, "a text");
    const auto* const bytes = sqlite3_column_text(statement_.get(), column);
    return {reinterpret_cast<const char*>(bytes),
            static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
  }

  // The numbers of a blob. An empty column has none.
  template <class Number>
  std::vector<Number> numbers(int column) const {
    if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return {};
    require(column, SQLITE_BLOB, "a blob");
    const void* const data = sqlite3_column_blob(statement_.get(), column);
    const auto bytes = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    if (bytes % sizeof(Number) != 0) fail("{} has {} bytes", where(column), bytes);
    std::vector<Number> numbers(bytes / sizeof(Number));
    if (bytes > 0) std::memcpy(numbers.data(), data, bytes);
    return numbers;
  }

  // A matrix with its numbers of rows and of columns in the two columns before it.
  template <class Number>
  std::vector<Number> matrix(int column) const {
    const std::int64_t rows = integer(column - 2, 0, kPairBase);
    const std::int64_t columns = integer(column - 1, 0, kPairBase);
    std::vector<Number> read = numbers<Number>(column);
    // No product overflows: both are below 2^31.
    if (static_cast<std::int64_t>(read.size()) != rows * columns)
      fail("{} has {} numbers, but {} rows of {}", where(column), read.size(), rows, columns);
    return read;
  }

  // "FILE: TABLE FIRST-VALUE: COLUMN", for messages.
  std::string where(int column) const {
    const auto* const key = sqlite3_column_text(statement_.get(), 0);
    return fmt::format("{}: {} {}: {}", database_.file(), table_,
                       key ? reinterpret_cast<const char*>(key) : "",
                       sqlite3_column_name(statement_.get(), column));
  }

 private:
  void require(int column, int type, const char* name) const {
    if (sqlite3_column_type(statement_.get(), column) != type)
      fail("{} is not {}", where(column), name);
  }

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const Database& database_;
  std::string table_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// A view with the name of a table could run for ever.
void require_tables(const Database& database) {
  for (const char* const table : {"cameras", "images", "keypoints", "two_view_geometries"}) {
    Rows rows(
        database, "sqlite_master",
        fmt::format("SELECT name FROM sqlite_master WHERE type = 'table' AND name = '{}'", table));
    if (!rows.next()) fail_in(database.file(), "is no database of COLMAP: has no table {}", table);
  }
}

std::vector<ColmapCamera> read_cameras(const Database& database) {
  std::vector<ColmapCamera> cameras;
  Rows rows(database, "camera",
            "SELECT camera_id, model, width, height, params FROM cameras ORDER BY camera_id");
  while (rows.next()) {
    ColmapCamera camera;
    camera.id = rows.id(0);
    const auto model = static_cast<int>(rows.integer(1, -1, kPairBase));
    camera.model = colmap_model_name(model, Dialect::colmap);
    if (camera.model.empty()) fail("{} is {}", rows.where(1), model);
    camera.width = static_cast<std::uint64_t>(rows.integer(2, 1, kPairBase));
    camera.height = static_cast<std::uint64_t>(rows.integer(3, 1, kPairBase));
    camera.params = rows.numbers<double>(4);
    check_colmap_camera(camera, database.file());
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

// The scale of a feature [px] from its further numbers: scale and orientation, or an affine shape.
// 0: not known.
float size_of(std::span<const float> more) {
  const float size = more.size() == 2   ? more[0]
                     : more.size() == 4 ? std::sqrt(std::abs(more[0] * more[3] - more[1] * more[2]))
                                        : 0;
  return std::isfinite(size) && size > 0 ? size : 0;
}

// COLMAP stores features as rows of x, y and further numbers.
std::vector<ColmapPoint2D> features_in(const Rows& rows, int column) {
  const std::vector<float> numbers = rows.matrix<float>(column);
  const auto columns = static_cast<std::size_t>(rows.integer(column - 1));
  if (!numbers.empty() && columns < 2) fail("{} is {}", rows.where(column - 1), columns);
  std::vector<ColmapPoint2D> features;
  for (std::size_t i = 0; i < numbers.size(); i += columns) {
    if (!std::isfinite(numbers[i]) || !std::isfinite(numbers[i + 1]))
      fail_in(rows.where(column), "feature {} is at {} {}", i / columns, numbers[i],
              numbers[i + 1]);
    features.push_back({numbers[i], numbers[i + 1], kNoPoint3D,
                        size_of(std::span(numbers).subspan(i + 2, columns - 2))});
  }
  return features;
}

DatabaseImage* find(std::vector<DatabaseImage>& images, std::int64_t id) {
  const auto found = std::ranges::lower_bound(images, id, {}, &DatabaseImage::id);
  return found == images.end() || found->id != id ? nullptr : &*found;
}

void read_features(const Database& database, std::vector<DatabaseImage>& images) {
  Rows rows(database, "keypoints", "SELECT image_id, rows, cols, data FROM keypoints");
  while (rows.next()) {
    DatabaseImage* const image = find(images, rows.integer(0));
    if (!image) fail_in(rows.where(0), "there is no image with this id");
    image->features = features_in(rows, 3);
  }
}

std::vector<DatabaseImage> read_images(const Database& database,
                                       const std::vector<ColmapCamera>& cameras) {
  std::vector<DatabaseImage> images;
  std::set<std::string> names;
  Rows rows(database, "image", "SELECT image_id, camera_id, name FROM images ORDER BY image_id");
  while (rows.next()) {
    DatabaseImage image{rows.id(0), rows.id(1), rows.text(2), {}};
    if (std::ranges::find(cameras, image.camera, &ColmapCamera::id) == cameras.end())
      fail("{} is {}, which is no camera", rows.where(1), image.camera);
    if (!names.insert(image.name).second)
      fail("{} is '{}', as that of another image", rows.where(2), image.name);
    images.push_back(std::move(image));
  }
  read_features(database, images);
  return images;
}

DatabasePair pair_in(const Rows& rows, std::vector<DatabaseImage>& images) {
  const std::int64_t id = rows.integer(0);
  DatabasePair pair;
  const DatabaseImage* const first = find(images, id / kPairBase);
  const DatabaseImage* const second = find(images, id % kPairBase);
  if (!first || !second || first == second) fail("{} is no pair of images", rows.where(0));
  pair.first = first->id;
  pair.second = second->id;
  const std::vector<std::uint32_t> numbers = rows.matrix<std::uint32_t>(3);
  if (!numbers.empty() && rows.integer(2) != 2) fail("{} is {}", rows.where(2), rows.integer(2));
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (numbers[i] >= first->features.size() || numbers[i + 1] >= second->features.size())
      fail_in(rows.where(3), "match {} has the features {} and {}, but the images have {} and {}",
              i / 2, numbers[i], numbers[i + 1], first->features.size(), second->features.size());
    pair.matches.push_back({numbers[i], numbers[i + 1]});
  }
  return pair;
}

std::vector<DatabasePair> read_pairs(const Database& database, std::vector<DatabaseImage>& images) {
  std::vector<DatabasePair> pairs;
  Rows rows(database, "two_view_geometries",
            "SELECT pair_id, rows, cols, data, config FROM two_view_geometries ORDER BY pair_id");
  while (rows.next()) {
    const std::int64_t geometry = rows.integer(4);
    DatabasePair pair = pair_in(rows, images);
    if (geometry >= kVerified && geometry != kWatermark && !pair.matches.empty())
      pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

ColmapDatabase read_colmap_database(const fs::path& file) {
  const Database database(file);
  require_tables(database);
  ColmapDatabase read;
  read.cameras = read_cameras(database);
  read.images = read_images(database, read.cameras);
  read.pairs = read_pairs(database, read.images);
  return read;
}

}  // namespace axial::io
