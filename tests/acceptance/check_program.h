// SPDX-License-Identifier: GPL-3.0-or-later
// What the main functions of the programs of tests/acceptance have in common.
#pragma once

#include <exception>
#include <iostream>
#include <string>

namespace axial {

// Calls run(argc, argv) and returns its exit code. Prints the usage, which begins with the name of
// the program, and returns 1 if there are fewer than `least` or more than `most` arguments besides
// this name. Prints one line and returns 1 if run() throws an exception.
template <class Run>
int check_program(int argc, char** argv, int least, int most, const std::string& usage, Run run) {
  if (argc - 1 < least || argc - 1 > most) {
    std::cerr << "usage: " << usage << "\n";
    return 1;
  }
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << usage.substr(0, usage.find(' ')) << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace axial
