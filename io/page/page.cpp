#include "io/page/page.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr std::string_view template_place = "<!--TALUS-RUN-->";

/// JSON text with escapes for characters that must not appear inside a script of HTML.
std::string inside_script(const std::string& json)
{
  std::string text;
  text.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

}  // namespace

BlockId Page::add(PageBlock block)
{
  blocks.push_back(std::move(block));
  return blocks.size() - 1;
}

std::size_t Page::block_bytes() const
{
  constexpr std::size_t frame = 75;  // bytes of the surrounding element
  std::size_t bytes = 0;
  for (const PageBlock& block : blocks)
    bytes += block.base64.size() + frame;
  return bytes;
}

PageTable table_of(const std::vector<CsvColumn>& columns, const std::vector<std::vector<Real>>& values, std::size_t most, Page& page)
{
  const std::size_t rows = values.empty() ? 0 : values.front().size(), stride = rows / (most + 1) + 1;
  std::vector<std::size_t> saved;
  for (std::size_t r = 0; r < rows; r += stride)
    saved.push_back(r);
  if (!saved.empty() && saved.back() + 1 != rows)
    saved.push_back(rows - 1);
  std::vector<float> numbers;
  for (const std::vector<Real>& column : values)
    for (const std::size_t r : saved)
      numbers.push_back(static_cast<float>(column[r]));
  return {columns, static_cast<std::int64_t>(saved.size()), static_cast<std::int64_t>(stride), page.add(packed(numbers))};
}

std::string filled(const std::string& text, const std::filesystem::path& template_file, const Page& page)
{
  const auto at = text.find(template_place);
  if (at == text.npos || text.find(template_place, at + 1) != text.npos)
    throw EnvironmentError(
        fmt::format("{} is no template of a page: the line {} must stand in it once", template_file.string(), template_place));
  std::string whole;
  whole.reserve(text.size() + page.block_bytes() + (std::size_t{1} << 20U));
  whole.append(text, 0, at);
  whole += fmt::format("<script id=\"run\" type=\"application/json\">{}</script>", inside_script(to_json(page)));
  for (std::size_t b = 0; b < page.blocks.size(); ++b)
    whole.append(fmt::format("\n<script id=\"block-{}\" type=\"application/octet-stream\">", b))
        .append(page.blocks[b].base64)
        .append("</script>");
  return whole.append(text, at + template_place.size());
}

}  // namespace talus
