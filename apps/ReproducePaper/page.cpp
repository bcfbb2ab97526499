// SPDX-License-Identifier: GPL-3.0-or-later
#include "page.h"

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial {
namespace {

using experiments::Document;

std::string with_table(std::string page, const Document& table, const std::string& page_name) {
  const std::string begin = "<!-- " + table.file + " -->\n";
  const std::string end = "<!-- end -->";
  const std::size_t found = page.find(begin);
  if (found == std::string::npos) return page;
  const std::size_t from = found + begin.size();
  const std::size_t to = page.find(end, from);
  if (to == std::string::npos || page.substr(from, to - from).find("<!--") != std::string::npos)
    fail("{}: '{}' has no '{}' after its table", page_name, begin.substr(0, begin.size() - 1), end);
  return page.replace(from, to - from, "\n" + table.text + "\n");
}

}  // namespace

void update_page(const std::filesystem::path& page, const std::vector<Document>& documents) {
  std::string text = read_file(page);
  for (const Document& document : documents) {
    if (document.file.ends_with(".md"))
      text = with_table(std::move(text), document, page.string());
    else if (text.find("images/" + document.file) != std::string::npos)
      write_atomically(page.parent_path() / "images" / document.file, document.text);
  }
  write_atomically(page, text);
}

}  // namespace axial
