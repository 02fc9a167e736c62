#pragma once
// Command talus diff.
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct DiffOptions {
  std::filesystem::path a, b;       ///< results folders of two runs
  Real relative = 0, absolute = 0;  ///< values differ where |a - b| > absolute + relative * largest value of their field
  std::vector<std::string> fields;  ///< fields to compare; empty: all
  bool last = false;                ///< compares only the last time that both have
};
/// Compares the results in two folders and prints a table; returns whether they are equal.  Throws Error for unreadable results and invalid
/// options, so that the exit code 1 always means different results.
bool same_results(const DiffOptions& options);

}  // namespace talus
