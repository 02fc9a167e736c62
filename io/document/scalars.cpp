#include "io/document/scalars.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace talus {

namespace {

constexpr std::size_t longest_quote = 60;  // characters of a wrong value that a message repeats

std::string in_quotes(std::string_view text) { return text.size() <= longest_quote ? fmt::format("\"{}\"", text) : "this long text"; }

std::string in_unit(std::string_view unit) { return unit == "-" ? "" : fmt::format(" {}", unit); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number's text without a plus sign, which from_chars does not accept.
std::string_view without_plus(std::string_view text)
{
  return text.starts_with('+') && text.size() > 1 && text[1] != '-' && text[1] != '+' ? text.substr(1) : text;
}

/// The reason why a text is not a number, if one can be found.
std::string not_a_number(std::string_view text, std::string_view kind, std::string_view unit)
{
  Real number = 0;
  const std::string_view digits = without_plus(text);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const std::string_view rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
  std::string hint;
  if (error == std::errc() && rest.size() > 1 && rest.front() == ',' && is_digit(rest[1]))
    hint = "; decimals are written with a point";
  else if (error == std::errc() && rest.starts_with(' ') && unit != "-")
    hint = fmt::format("; write it in {}, without the unit", unit);
  return fmt::format("{} is not a {}{}", in_quotes(text), kind, hint);
}

/// Whether a number has a leading zero: some readers take it as octal, others as decimal.
bool looks_octal(std::string_view text)
{
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return text.size() > sign + 1 && text[sign] == '0' && is_digit(text[sign + 1]);
}

/// Whether the text is ".nan", "-.inf" or a similar word of other formats.
bool names_no_finite_number(std::string_view text)
{
  std::string word;
  for (const char c : text)
    if (c != '+' && c != '-' && c != '.')
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word == "nan" || word == "inf" || word == "infinity";
}

Complaint refused_text(const Node& node, std::string_view kind)
{
  if (node.quoted)
    return fmt::format("{} is text, not a {}: leave out the quotes", in_quotes(node.text), kind);
  if (names_no_finite_number(node.text))
    return fmt::format("{} is not a finite number", node.text);
  if (looks_octal(node.text))
    return fmt::format("{} begins with a zero, which may mean octal: write it without", in_quotes(node.text));
  return std::nullopt;
}

Complaint outside(std::string_view text, Real value, const Asked& asked)
{
  if (asked.range.holds(value))
    return std::nullopt;
  const bool bounded = std::isfinite(asked.range.low) && std::isfinite(asked.range.high);
  return fmt::format("{} {} {}{}", text, bounded ? "is outside" : "must be", to_string(asked.range), in_unit(asked.unit));
}

}  // namespace

Complaint read_scalar(const Node& node, const Asked& asked, Real& value)
{
  if (auto refused = refused_text(node, "number"))
    return refused;
  const std::string_view text = without_plus(node.text);
  const char* const last = text.data() + text.size();
  Real number = 0;
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error == std::errc::result_out_of_range && end == last)
    return fmt::format("{} is too {} for a number of double precision", in_quotes(node.text),
                       text.find("e-") == text.npos && text.find("E-") == text.npos ? "large" : "small");
  if (error != std::errc() || end != last)
    return not_a_number(node.text, "number", asked.unit);
  if (auto refused = outside(node.text, number, asked))
    return refused;
  value = number;
  return std::nullopt;
}

Complaint read_scalar(const Node& node, const Asked& asked, Index& value)
{
  if (auto refused = refused_text(node, "whole number"))
    return refused;
  const std::string_view text = without_plus(node.text);
  const char* const last = text.data() + text.size();
  Index number = 0;
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error == std::errc::result_out_of_range && end == last)
    return fmt::format("{} is too large; the largest whole number is {}", in_quotes(node.text), std::numeric_limits<Index>::max());
  if (error != std::errc() || end != last)
    return not_a_number(node.text, "whole number", asked.unit);
  if (auto refused = outside(node.text, number, asked))
    return refused;
  value = number;
  return std::nullopt;
}

Complaint read_scalar(const Node& node, const Asked&, bool& value)
{
  if (node.quoted || (node.text != "true" && node.text != "false"))
    return fmt::format("{} is neither true nor false", in_quotes(node.text));
  value = node.text == "true";
  return std::nullopt;
}

Complaint read_scalar(const Node& node, const Asked&, std::string& value)
{
  if (node.text.empty())
    return "this text is empty";
  if (const auto control = first_control(node.text); control != node.text.end())
    return *control == '\n' ? std::string("this text has more than one line")
                            : fmt::format("this text holds a character that does not print, {:#04x}", static_cast<unsigned char>(*control));
  value = node.text;
  return std::nullopt;
}

}  // namespace talus
