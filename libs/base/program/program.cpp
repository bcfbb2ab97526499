// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program/program.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/program_options.hpp>
#include <cctype>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <typeinfo>

#include "base/byte_order_mark.h"
#include "base/error.h"
#include "base/log.h"
#include "base/log_file.h"
#include "base/message.h"
#include "base/program/console.h"
#include "base/program/newer_options.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"

namespace axial {
namespace po = boost::program_options;
namespace fs = std::filesystem;

namespace {

po::options_description common_options(CommonOptions& common, const ProgramOptions& program,
                                       std::string& working_folder) {
  const std::string verbosity =
      "0: warnings only; 1: also the result of each stage; 2: also the progress; 3 and above: also "
      "details" +
      program.when_verbose;
  po::options_description generic("Generic options");
  generic.add_options()("help,h", "print this help")("version", "print the version")(
      "working-folder,w", po::value(&working_folder),
      "folder for relative paths (default: current folder)")(
      "config-file,c", po::value(&common.config_file)->default_value(program.name + ".cfg"),
      "file with option values, one 'name = value' per line")(
      "archive-type", po::value(&common.archive_type)->default_value(-1),
      "scene format: -1 (interchange .mvs), which is also written for 0 to 3")(
      "log-file", po::value(&common.log_file),
      "file to which the lines of the log are added, including errors")(
      "process-priority", po::value(&common.process_priority)->default_value(-1),
      "below 0: lowers the priority of the process")(
      "max-threads", po::value(&common.max_threads)->default_value(0), "threads (0: all cores)")(
      "verbosity,v", po::value(&common.verbosity)->default_value(2), verbosity.c_str());
  return generic;
}

template <class T>
std::string default_text(const T& value) {
  if constexpr (std::is_same_v<T, bool>)
    return value ? "1" : "0";
  else
    return fmt::format("{}", value);
}

// The type of the text of an option, from which the type T of its target is made.
template <class T>
struct Given {
  using type = T;
};
template <>
struct Given<fs::path> {
  using type = std::string;
};
template <>
struct Given<std::vector<fs::path>> {
  using type = std::vector<std::string>;
};
template <class T>
struct Given<std::optional<T>> {
  using type = T;
};

// Binds an option to its target. A target of another type than the text gets its value by a
// notifier.
template <class T>
auto bound(const Option& option, T* target) {
  using Text = typename Given<T>::type;
  constexpr bool kIsList = std::is_same_v<Text, std::vector<std::string>>;
  po::typed_value<Text>* value = po::value<Text>();
  value->notifier([target](const Text& text) {
    if constexpr (kIsList)
      target->assign(text.begin(), text.end());
    else
      *target = text;
  });
  if constexpr (kIsList)
    value->composing();
  else if constexpr (std::is_same_v<Text, T>)
    if (option.shows_default) value->default_value(*target, default_text(*target));
  if constexpr (std::is_same_v<T, bool>)
    if (option.is_switch) value->implicit_value(true);
  return value;
}

po::options_description described(const OptionList& list) {
  po::options_description description(list.title());
  for (const Option& option : list.options())
    std::visit(
        [&](auto* target) {
          description.add_options()(option.name.c_str(), bound(option, target),
                                    option.help.c_str());
        },
        option.target);
  return description;
}

// Without this test boost would convert "-1" to a large unsigned number.
void refuse_negative(const po::parsed_options& parsed, const po::options_description& known) {
  for (const po::option& option : parsed.options) {
    const po::option_description* description = known.find_nothrow(option.string_key, false);
    if (!description || option.value.empty() || !option.value[0].starts_with('-')) continue;
    const auto* value = dynamic_cast<const po::typed_value_base*>(description->semantic().get());
    if (value &&
        (value->value_type() == typeid(unsigned) || value->value_type() == typeid(unsigned long) ||
         value->value_type() == typeid(unsigned long long)))
      fail("--{} {}: must not be negative", option.string_key, option.value[0]);
  }
}

// Refuses arguments that belong to no option. Without the option input-file, boost parses
// positional arguments and ignores them: if the user forgets "--preset" before its value, the
// program would run with the default. With the option, boost would blame the input file.
void refuse_stray_arguments(const po::parsed_options& parsed) {
  bool has_input = false;
  for (const po::option& option : parsed.options) {
    if (option.string_key.empty())
      fail("command line: '{}' belongs to no option", option.value.front());
    if (option.string_key != "input-file") continue;
    if (option.value.front().empty()) fail("command line: the name of the input-file is empty");
    if (has_input && option.position_key >= 0)
      fail("command line: '{}' belongs to no option, and the input-file is given already",
           option.value.front());
    has_input = true;
  }
}

bool is_boolean(std::string word) {
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
  constexpr std::array kWords{"0", "1", "false", "true", "no", "yes", "off", "on"};
  return std::ranges::find(kWords, word) != kWords.end();
}

// Returns null for an unknown or ambiguous name; boost reports such names later.
const po::option_description* find_option(const po::options_description& known,
                                          const std::string& name) {
  try {
    return known.find_nothrow(name, true);
  } catch (const po::error&) {
    return nullptr;
  }
}

// The option that a word names: "--name", "--name=value", "-n" or "-nvalue".
const po::option_description* option_named_by(const po::options_description& known,
                                              const std::string& word) {
  if (word.size() > 2 && word.starts_with("--"))
    return find_option(known, word.substr(2, word.find('=') - 2));
  if (word.size() < 2 || word[0] != '-' || word[1] == '-') return nullptr;
  return known.find_nothrow(word.substr(0, 2), false);
}

// Refuses an option without its value: boost would take the next option for the value.
void refuse_missing_values(const std::vector<std::string>& words,
                           const po::options_description& known,
                           const std::set<std::string>& switches) {
  for (std::size_t i = 0; i + 1 < words.size() && words[i] != "--"; ++i) {
    const bool is_long = words[i].starts_with("--");
    const bool bare = is_long ? words[i].find('=') == std::string::npos : words[i].size() == 2;
    const auto* option = bare ? option_named_by(known, words[i]) : nullptr;
    const bool takes_value =
        option && option->semantic()->max_tokens() > 0 && !switches.contains(option->long_name());
    if (takes_value && option_named_by(known, words[i + 1]))
      fail("command line: {} has no value: {} is an option", words[i], words[i + 1]);
  }
}

// The words of the command line. Appends "=1" to a switch if the next word is not a boolean,
// because boost would take any next word for the value.
std::vector<std::string> words_of(int argc, const char* const* argv,
                                  const po::options_description& known, const OptionList& visible) {
  std::set<std::string> switches;
  for (const Option& option : visible.options())
    if (option.is_switch) switches.insert(option.name.substr(0, option.name.find(',')));
  refuse_missing_values({argv + 1, argv + argc}, known, switches);
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    const bool bare =
        word.size() > 2 && word.starts_with("--") && word.find('=') == std::string::npos;
    const auto* option = bare ? find_option(known, word.substr(2)) : nullptr;
    const bool has_value = i + 1 < argc && is_boolean(argv[i + 1]);
    if (option && switches.contains(option->long_name()) && !has_value) word += "=1";
    words.push_back(std::move(word));
  }
  return words;
}

// Ignores a byte order mark at the start.
po::parsed_options parse_config(std::istream& in, const po::options_description& known) {
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::istringstream text{std::string(without_byte_order_mark(bytes))};
  return po::parse_config_file(text, known);
}

void apply(CommonOptions& common) {
  if (!common.log_file.empty()) {
    refuse_control_characters(common.log_file, "--log-file");
    try {
      log_to_file_too(in_working_folder(common, common.log_file));
    } catch (const Error& error) {
      fail("--log-file {}", error.text());
    }
  }
  if (common.archive_type < -1 || common.archive_type > 3)
    fail("--archive-type {}: must be from -1 to 3", common.archive_type);
  if (common.archive_type != -1)
    log_warning(
        "--archive-type {}: OpenMVS's own projects are not written, scenes are interchange .mvs "
        "(-1)",
        common.archive_type);
  common.archive_type = -1;
  if (common.max_threads > 1024) fail("--max-threads {}: must be at most 1024", common.max_threads);
  if (common.process_priority < 0) ::setpriority(PRIO_PROCESS, 0, 10);
  constexpr std::array kLevelOfVerbosity{LogLevel::warning, LogLevel::info, LogLevel::debug,
                                         LogLevel::trace};
  set_log_level(kLevelOfVerbosity[static_cast<std::size_t>(std::clamp(common.verbosity, 0, 3))]);
}

bool given_in(const po::variables_map& values, const std::string& name) {
  return values.count(name) > 0 && !values[name].defaulted();
}

// All options of a program, by the places that may give them.
struct KnownOptions {
  KnownOptions(CommonOptions& common, const ProgramOptions& program) {
    const po::options_description visible = described(program.visible);
    const po::options_description hidden = described(program.hidden);
    command_line.add(common_options(common, program, working_folder)).add(visible).add(hidden);
    config.add(visible).add(hidden);
  }
  KnownOptions(const KnownOptions&) = delete;  // common_options() refers to working_folder

  bool has_input() const { return command_line.find_nothrow("input-file", false) != nullptr; }
  bool lacks_input(const po::variables_map& values, const ProgramOptions& program) const {
    const bool may_lack =
        !program.instead_of_input.empty() && values.count(program.instead_of_input) > 0;
    return has_input() && !values.count("input-file") && !may_lack;
  }

  std::string working_folder;
  po::options_description command_line, config;
};

void read_command_line(int argc, const char* const* argv, const ProgramOptions& program,
                       const KnownOptions& known, po::variables_map& values) {
  po::positional_options_description positional;
  positional.add("input-file", -1);
  po::command_line_parser parser(words_of(argc, argv, known.command_line, program.visible));
  parser.options(known.command_line);
  if (known.has_input()) parser.positional(positional);
  const po::parsed_options arguments = parser.run();
  refuse_stray_arguments(arguments);
  refuse_negative(arguments, known.command_line);
  po::store(arguments, values);
}

fs::path working_folder_of(const po::variables_map& values) {
  std::string name;
  if (values.count("working-folder")) name = values["working-folder"].as<std::string>();
  fs::path folder = fs::absolute(name.empty() ? "." : name);
  std::error_code error;
  if (!fs::is_directory(folder, error)) fail("--working-folder {}: is not a folder", name);
  return folder;
}

// Adds the values of the cfg file that the command line does not give.
void read_config(const fs::path& working_folder, const po::options_description& config,
                 po::variables_map& values) {
  const fs::path cfg = working_folder / values["config-file"].as<std::string>();
  std::error_code ignored;
  // The kind comes first: to open a pipe would wait for its writer.
  std::ifstream in;
  if (fs::is_regular_file(cfg, ignored)) in.open(cfg);
  if (in.is_open()) {
    try {
      const po::parsed_options in_file = parse_config(in, config);
      refuse_negative(in_file, config);
      po::store(in_file, values);
    } catch (const po::error& error) {
      fail_in(cfg, "{}", as_message(error.what()));
    }
  } else if (given_in(values, "config-file")) {
    fail_in(cfg, "cannot be opened");
  }
}

void print_help(const ProgramOptions& program) {
  po::options_description shown;
  std::string unused_folder;
  CommonOptions unused;
  shown.add(common_options(unused, program, unused_folder)).add(described(program.visible));
  std::cout << program.name << ": " << program.description << "\n\n" << shown << std::flush;
}

// The options of the settings in the tables of the program.
SettingNames options_of_settings(const ProgramOptions& program) {
  SettingNames names{{"working_folder", "--working-folder"}};
  for (const OptionList* list : {&program.visible, &program.hidden})
    for (const Option& option : list->options()) {
      std::string field = option.long_name();
      std::ranges::replace(field, '-', '_');
      names.emplace(std::move(field), "--" + option.long_name());
      for (const OptionSetting& setting : option.settings)
        names[setting.name] = "--" + option.long_name() + setting.value;
    }
  return names;
}

}  // namespace

Context program_context(const ParsedOptions& parsed) {
  return Context(console_events(), {}, {parsed.memory, parsed.common.max_threads});
}

ParsedOptions parse_options(int argc, const char* const* argv, const ProgramOptions& program) {
  ParsedOptions parsed;
  KnownOptions known(parsed.common, program);
  po::variables_map values;
  try {
    read_command_line(argc, argv, program, known, values);
    if (values.count("version")) {
      std::cout << program.version << std::endl;
      return parsed;
    }
    parsed.common.working_folder = working_folder_of(values);
    read_config(parsed.common.working_folder, known.config, values);
    po::notify(values);
    for (const auto& [name, value] : values)
      if (given_in(values, name)) parsed.given.insert(name);
    if (const bool help = values.count("help") > 0; help || known.lacks_input(values, program)) {
      print_help(program);
      parsed.exit_code = help ? 0 : 1;
      if (!help) std::cerr << program.name << ": no input file given (-i FILE)\n";
      return parsed;
    }
  } catch (const po::unknown_option& error) {
    refuse_newer_option(program.name, error.get_option_name());
    fail("command line: {}", as_message(error.what()));
  } catch (const po::error& error) {
    fail("command line: {}", as_message(error.what()));
  }
  name_settings(options_of_settings(program));
  apply(parsed.common);
  parsed.memory = program.visible.memory();
  take_values(std::array{&program.visible, &program.hidden}, parsed);
  parsed.run = true;
  return parsed;
}

}  // namespace axial
