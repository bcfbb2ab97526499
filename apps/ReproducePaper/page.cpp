// SPDX-License-Identifier: GPL-3.0-or-later
#include "page.h"

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial::apps {
namespace {

using experiments::Document;

constexpr const char* kEnd = "<!-- end -->";

// The end of the table whose marker ends at `from`.
std::size_t end_of_table(const std::string& text, std::size_t from, const std::string& marker,
                         const std::filesystem::path& page) {
  const std::size_t to = text.find(kEnd, from);
  if (to == std::string::npos || text.substr(from, to - from).find("<!--") != std::string::npos)
    fail("{}: '{}' has no '{}' after its table", page.string(), marker, kEnd);
  return to;
}

std::string with_table(std::string text, const Document& table, const std::filesystem::path& page) {
  const std::string begin = "<!-- " + table.file + " -->";
  const std::size_t found = text.find(begin + "\n");
  if (found == std::string::npos) return text;
  const std::size_t from = found + begin.size() + 1;
  return text.replace(from, end_of_table(text, from, begin, page) - from, "\n" + table.text + "\n");
}

}  // namespace

void check_page(const std::filesystem::path& page,
                const std::vector<experiments::Experiment>& experiments) {
  const std::string text = read_file(page);
  require_writable(page);
  for (const experiments::Experiment& experiment : experiments) {
    const std::string begin = "<!-- " + experiment.name;
    std::size_t found = text.find(begin);
    if (found == std::string::npos)
      fail("{}: has no line such as '{}.md -->' for a table", page.string(), begin);
    for (; found != std::string::npos; found = text.find(begin, found + 1)) {
      const std::size_t from = text.find("-->", found);
      if (from == std::string::npos) fail("{}: '{}' is not closed", page.string(), begin);
      end_of_table(text, from + 3, text.substr(found, from + 3 - found), page);
    }
  }
}

void update_page(const std::filesystem::path& page, const std::vector<Document>& documents) {
  std::string text = read_file(page);
  for (const Document& document : documents) {
    if (document.file.ends_with(".md"))
      text = with_table(std::move(text), document, page);
    else if (text.find("images/" + document.file) != std::string::npos)
      write_atomically(page.parent_path() / "images" / document.file, document.text);
  }
  write_atomically(page, text);
}

}  // namespace axial::apps
