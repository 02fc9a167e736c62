#pragma once
// Commands talus info and talus manual: what the program knows and what a scene may say.
#include <string>
#include <vector>

namespace talus {

void print_info();

/// Prints every key of a scene as Markdown or JSON Schema, or the entries for words.  Throws Error if a word has no entry.
void print_manual(bool schema, const std::vector<std::string>& words);

}  // namespace talus
