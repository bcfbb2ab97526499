// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a folder that a browser shows without a network: a reconstruction to look at and to
// measure on.

#include <filesystem>

#include "base/atomic_file.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/output_lock.h"
#include "contents.h"
#include "folder.h"
#include "options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const Context context = program_context(options.parsed);
  const fs::path page = page_folder();
  const OutputLock lock = lock_output(options.report);
  require_own_folder(options.report);
  const Contents contents = read_contents(options, context);
  write_own_folder(options.report, [&](const fs::path& staging) {
    for (const char* file : {"index.html", "style.css", "viewer.js"})
      fs::copy_file(page / file, staging / file);
    write_contents(contents, options, staging, context);
  });
  log_info("wrote {}", (options.report / "index.html").string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("ViewScene", [&] { return axial::apps::run(argc, argv); });
}
