// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/transform_file.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/parse_number.h"
#include "cameras/private/checked_rotation.h"

namespace axial::io {
namespace {

std::vector<double> numbers_in(std::string_view text, const std::string& file) {
  constexpr std::string_view kBlank = " \t\r\n,;";
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = text.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return numbers;
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find_first_of(kBlank));
    text.remove_prefix(word.size());
    const auto number = parse_number<double>(word);
    if (number && !std::isfinite(*number)) fail_in(file, "contains {}", word);
    if (number) numbers.push_back(*number);
  }
}

}  // namespace

Similarity read_transform(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = 1 << 20;
  const std::string file = path.string(), bytes = read_file(path, kMostBytes);
  const std::vector<double> m = numbers_in(without_byte_order_mark(bytes), file);
  if (m.size() != 12 && m.size() != 16)
    fail_in(file, "contains {} numbers, expected 12 or 16: the rows of a matrix", m.size());
  if (m.size() == 16 && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1))
    fail_in(file, "the last row is {} {} {} {}, expected 0 0 0 1", m[12], m[13], m[14], m[15]);
  Eigen::Matrix3d scaled;
  scaled << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  Similarity result;
  result.scale = std::cbrt(scaled.determinant());
  if (!(result.scale > 0) || !std::isfinite(result.scale))
    fail_in(file, "the matrix mirrors or flattens: it is not a rotation with a positive scale");
  result.rotation =
      checked_rotation(scaled / result.scale, file + ": the matrix, without its scale,");
  result.translation = {m[3], m[7], m[11]};
  return result;
}

}  // namespace axial::io
