// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/calibmar.h"

#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <map>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/parse_number.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

using Words = std::vector<std::string>;

// The keys of a file with their values, which are a word or a list of words. A map has no words.
class YamlKeys {
 public:
  explicit YamlKeys(const std::filesystem::path& path) : file_(path.string()) {
    constexpr std::uintmax_t kLargest = 1u << 20;
    const YAML::Node root = parsed(read_file(path, kLargest));
    if (root.IsScalar()) fail_in(where(root), "'{}' is not 'key: value'", root.Scalar());
    if (root.IsSequence()) fail_in(where(root), "a list instead of 'key: value'");
    for (const auto& entry : root) {
      const YAML::Node& key = entry.first;
      if (!key.IsScalar()) continue;
      if (!values_.try_emplace(key.Scalar(), words_of(entry.second)).second)
        fail_in(where(key), "key '{}' occurs twice", key.Scalar());
    }
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
  YAML::Node parsed(const std::string& text) const {
    try {
      return YAML::Load(text);
    } catch (const YAML::Exception& error) {
      fail_in(where(error.mark), "no YAML, or truncated: {}", error.msg);
    }
  }

  std::string where(const YAML::Mark& mark) const {
    return fmt::format("{}: line {}", file_, mark.line + 1);
  }
  std::string where(const YAML::Node& node) const { return where(node.Mark()); }

  static Words words_of(const YAML::Node& value) {
    Words words;
    if (value.IsScalar() && !value.Scalar().empty()) words.push_back(value.Scalar());
    if (value.IsSequence())
      for (const YAML::Node& item : value)
        words.push_back(item.IsScalar() ? item.Scalar() : "[...]");  // no number
    return words;
  }

  std::string file_;
  std::map<std::string, Words> values_;
};

refractive::Port<double> read_port(const YamlKeys& yaml, const std::string& file,
                                   const Context& context) {
  const std::string word = yaml.word("non_svp_model");
  if (!is_port_word(
          word))  // before its numbers: an unknown kind of port may have another number of them
    fail_in(file, "non_svp_model: the port '{}' is not FLATPORT, DOMEPORT or NONE", word);
  const std::vector<double> values = yaml.numbers<double>("non_svp_parameters");
  if (values.size() != kPortNumbers)
    fail_in(file, "non_svp_parameters has {} numbers, expected {}", values.size(), kPortNumbers);
  PortNumbers numbers;
  std::copy(values.begin(), values.end(), numbers.begin());
  return port_from(word, numbers, file + ": non_svp_parameters", context);
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

ColmapCamera read_calibmar(const std::filesystem::path& path, const Context& context) {
  const YamlKeys yaml(path);
  ColmapCamera camera;
  camera.id = 1;
  camera.model = yaml.word("model");
  camera.width = yaml.number<std::uint64_t>("width");
  camera.height = yaml.number<std::uint64_t>("height");
  camera.params = yaml.numbers<double>("parameters");
  check_colmap_camera(camera, path.string());
  if (yaml.has("non_svp_model") && !without_port(yaml))
    camera.port = read_port(yaml, path.string(), context);
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
