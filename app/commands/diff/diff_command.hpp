#pragma once
// Command talus diff.
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct DiffOptions {
  std::filesystem::path a, b;       ///< folders of two runs
  Real relative = 0, absolute = 0;  ///< values differ where |a - b| > absolute + relative * largest value of their field
  std::vector<std::string> fields;  ///< empty: all
  bool last = false;                ///< only the last time that both have
};
/// Compares the results in two folders and prints a table; whether they are the same.  Error for what cannot be read, and for words that
/// mean nothing: a status of 1 says that results differ.
bool same_results(const DiffOptions& options);

}  // namespace talus
