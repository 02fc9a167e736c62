#pragma once
// The scenes that `talus new` copies.
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A file of scenes/templates, with its text when the program was built.
struct TemplateText {
  std::string_view name, text;
};
std::span<const TemplateText> shipped_templates();
std::vector<std::string> template_names();

}  // namespace talus
