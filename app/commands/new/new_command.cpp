// talus new
#include "app/commands/new/new_command.hpp"

#include <fmt/format.h>

#include "core/display_text.hpp"
#include "core/word_match.hpp"
#include "io/document/document.hpp"
#include "io/files/atomic_file.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The first comment of a template, apart from comments for editors.
std::string_view summary_of(std::string_view text)
{
  for (const std::string_view line : lines_of(text))
    if (line.starts_with("# ") && !line.starts_with("# yaml-language-server"))
      return line.substr(2);
  return {};
}

void list_templates()
{
  for (const TemplateText& one : shipped_templates())
    fmt::print("{:<8}  {}\n", one.name, summary_of(one.text));
}

/// The text of the template of that name, or of a file.
std::string text_of(const std::string& name_or_file)
{
  for (const TemplateText& one : shipped_templates())
    if (one.name == name_or_file)
      return std::string(one.text);
  std::error_code unknown;
  if (name_or_file.find_first_of("./") != name_or_file.npos || fs::exists(name_or_file, unknown))
    return read_text(name_or_file);
  throw Error(fmt::format("there is no template \"{}\"{}; a scene of your own is given by its file", name_or_file,
                          suggestion(name_or_file, template_names())));
}

}  // namespace

std::vector<std::string> template_names()
{
  std::vector<std::string> names;
  for (const TemplateText& one : shipped_templates())
    names.emplace_back(one.name);
  return names;
}

void new_scene(const NewOptions& options)
{
  if (options.list)
    return list_templates();
  if (!options.from)
    throw Error(fmt::format("say which template: {}; talus new --list tells what they are", or_list(template_names())));
  const std::string text = with_values(*options.from, text_of(*options.from), options.set);
  const fs::path out = options.out.value_or(fs::path(*options.from).stem().string() + ".yaml");
  if (std::error_code unknown; !options.force && fs::exists(fs::symlink_status(out, unknown)))
    throw Error(fmt::format("{} is there already: choose another file with --out, or replace it with --force", out.string()));
  read_scene_text(out, text);  // invalid values throw before the file is written
  write_whole(out, text);
  const std::string scene = shell_word(out), results = shell_word("runs/" + out.stem().string());
  fmt::print("{} is written: edit it. Next:\n  talus check {}\n  talus run {} --out {}\n  talus render {}\n", out.string(), scene, scene,
             results, results);
}

}  // namespace talus
