// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/steps.h"

#include <sys/resource.h>

#include <algorithm>

#include "base/hash.h"
#include "base/subprocess.h"

namespace axial::experiments {

namespace fs = std::filesystem;

Words& operator+=(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

bool run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const fs::path& log, const Words& excuses) {
  Words command{(program_folder() / program).string()};
  command += arguments;
  command += {"--max-threads", std::to_string(chain.max_threads)};
  return run_unless_excused(command, log, excuses);
}

double children_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::vector<fs::path> files_ending_in(const fs::path& folder, const std::string& end) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().string().ends_with(end)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content_of(const fs::path& file_or_folder) {
  const bool folder = fs::is_directory(file_or_folder);
  Fingerprint print;
  for (const fs::path& file :
       folder ? files_ending_in(file_or_folder, "") : std::vector{file_or_folder})
    print.add(file.filename().string()).add(read_file(file));
  return print.hex();
}

Json content_of_programs(const Words& programs) {
  Json contents;
  for (const std::string& program : programs)
    contents[program] = content_of(program_folder() / program);
  return contents;
}

}  // namespace axial::experiments
