// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/calibmar.h"

#include <fmt/ranges.h>

#include <map>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "private/bytes/text_reader.h"
#include "private/colmap/colmap_parts.h"

namespace axial::io {
namespace {

using Words = std::vector<std::string>;

std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] == '#' && (i == 0 || kBlanks.find(line[i - 1]) != std::string_view::npos))
      return line.substr(0, i);
  return line;
}

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == text.back() &&
                      (text.front() == '"' || text.front() == '\'');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// The subset of YAML that these files use: a key with one word or with a list, in brackets or with
// a dash before each item.
class YamlKeys {
 public:
  explicit YamlKeys(const std::filesystem::path& path) : file_(path.string()) {
    constexpr std::uintmax_t kLargest = 1u << 20;
    std::string text = read_file(path, kLargest);
    if (!text.ends_with('\n')) text += '\n';  // some writers omit the last newline
    TextReader reader(text, file_);
    while (const auto line = reader.line()) add(without_comment(line->rest()), line->where());
    if (open_) fail_in(file_, "the list of {} has no end: the file is truncated", key_);
  }

  bool has(const std::string& key) const { return values_.contains(key); }

  const Words& words(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) fail_in(file_, "key '{}' is missing", key);
    return found->second;
  }

  std::string word(const std::string& key) const {
    const Words& all = words(key);
    if (all.size() != 1) fail_in(file_, "{} is [{}], expected one word", key, fmt::join(all, ", "));
    return all.front();
  }

  template <class T>
  std::vector<T> numbers(const std::string& key) const {
    std::vector<T> result;
    for (const std::string& text : words(key)) {
      const auto value = parse_finite<T>(text);
      if (!value) fail_in(file_, "{} has '{}', which is not a valid number", key, text);
      result.push_back(*value);
    }
    return result;
  }

  template <class T>
  T number(const std::string& key) const {
    const std::vector<T> all = numbers<T>(key);
    if (all.size() != 1) fail_in(file_, "{} has {} numbers, expected one", key, all.size());
    return all.front();
  }

 private:
  void add(std::string_view line, const std::string& where) {
    line = trimmed(line);
    if (line.empty() || line == "---" || line == "...") return;
    if (open_) return add_listed(line, where);
    if (line.front() == '-' && !key_.empty() && (line.size() == 1 || line[1] == ' '))
      return add_word(line.substr(1));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) fail_in(where, "'{}' is not 'key: value'", line);
    key_ = unquoted(trimmed(line.substr(0, colon)));
    if (!values_.try_emplace(key_).second) fail_in(where, "key '{}' occurs twice", key_);
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!value.starts_with('[')) return add_word(value);
    open_ = true;
    add_listed(value.substr(1), where);
  }

  void add_listed(std::string_view text, const std::string& where) {
    const std::size_t end = text.find(']');
    if (end != std::string_view::npos) {
      if (!trimmed(text.substr(end + 1)).empty())
        fail_in(where, "unexpected '{}' after the list of {}", trimmed(text.substr(end + 1)), key_);
      open_ = false;
      text = text.substr(0, end);
    }
    for (std::size_t comma = text.find(','); comma != std::string_view::npos;
         comma = text.find(',')) {
      add_word(text.substr(0, comma));
      text.remove_prefix(comma + 1);
    }
    add_word(text);
  }

  void add_word(std::string_view word) {
    if (const auto bare = unquoted(trimmed(word)); !bare.empty()) values_[key_].emplace_back(bare);
  }

  std::string file_, key_;
  bool open_ = false;  // within brackets
  std::map<std::string, Words> values_;
};

refractive::Port<double> read_port(const YamlKeys& yaml, const std::string& file) {
  const std::string word = yaml.word("non_svp_model");
  if (!is_port_word(
          word))  // before its numbers: an unknown kind of port may have another number of them
    fail_in(file, "non_svp_model: the port '{}' is not FLATPORT, DOMEPORT or NONE", word);
  const std::vector<double> values = yaml.numbers<double>("non_svp_parameters");
  if (values.size() != kPortNumbers)
    fail_in(file, "non_svp_parameters has {} numbers, expected {}", values.size(), kPortNumbers);
  PortNumbers numbers;
  std::copy(values.begin(), values.end(), numbers.begin());
  return port_from(word, numbers, file + ": non_svp_parameters");
}

bool without_port(const YamlKeys& yaml) {
  const Words& words = yaml.words("non_svp_model");
  return words.empty() || (words.size() == 1 && words.front() == "NONE");
}

template <class Numbers>
std::string listed(const Numbers& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}

}  // namespace

bool is_calibmar(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".yaml" || extension == ".yml";
}

ColmapCamera read_calibmar(const std::filesystem::path& path) {
  const YamlKeys yaml(path);
  ColmapCamera camera;
  camera.id = 1;
  camera.model = yaml.word("model");
  camera.width = yaml.number<std::uint64_t>("width");
  camera.height = yaml.number<std::uint64_t>("height");
  camera.params = yaml.numbers<double>("parameters");
  check_colmap_camera(camera, path.string());
  if (yaml.has("non_svp_model") && !without_port(yaml))
    camera.port = read_port(yaml, path.string());
  return camera;
}

bool says_no_port(const std::filesystem::path& path) {
  const YamlKeys yaml(path);
  return yaml.has("non_svp_model") && without_port(yaml);
}

void write_calibmar(const std::filesystem::path& path, const ColmapCamera& camera,
                    std::span<const std::string> comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += fmt::format("model: {}\nparameters: {}\n", camera.model, listed(camera.params));
  if (camera.port)
    text += fmt::format("non_svp_model: {}\nnon_svp_parameters: {}\n", port_word(*camera.port),
                        listed(port_numbers(*camera.port)));
  text += fmt::format("width: {}\nheight: {}\n", camera.width, camera.height);
  write_atomically(path, text);
}

}  // namespace axial::io
