#include "io/system/http_request.hpp"

#include <algorithm>
#include <set>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr std::string_view line_end = "\r\n";

bool is_token(std::string_view text)
{
  constexpr std::string_view others = "!#$%&'*+-.^_`|~";  // RFC 9110, 5.6.2
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || others.find(static_cast<char>(c)) != others.npos;
  });
}

bool is_visible(std::string_view text)
{
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == ' ' || c == '\t' || (c > 0x20 && c != 0x7F); });
}

std::string_view trimmed(std::string_view text)
{
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// Removes and returns the first line; its line end is removed too.
std::string_view take_line(std::string_view& text)
{
  const std::string_view line = text.substr(0, text.find(line_end));
  text.remove_prefix(std::min(line.size() + line_end.size(), text.size()));
  return line;
}

}  // namespace

HttpRequest parse_http_request(std::string_view head)
{
  HttpRequest request;
  std::string_view line = take_line(head);
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == line.npos || last == first || !is_token(line.substr(0, first)))
    throw Error("the first line is no request");
  const std::string_view target = line.substr(first + 1, last - first - 1), version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0")
    throw Error("the version is neither HTTP/1.1 nor HTTP/1.0");
  if (!target.starts_with('/') || !is_visible(target) || target.find_first_of(" \t") != target.npos)
    throw Error("the address is no path");
  request.method = line.substr(0, first);
  request.path = target.substr(0, target.find('?'));
  std::set<std::string> once;
  while (!head.empty()) {
    line = take_line(head);
    const std::size_t colon = line.find(':');
    if (colon == line.npos || !is_token(line.substr(0, colon)) || !is_visible(line))
      throw Error("a line of the head is no field");
    std::string name(line.substr(0, colon));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name == "host" || name == "content-length" || name == "transfer-encoding")
      if (!once.insert(name).second)
        throw Error("the field " + name + " is there twice");
    if (name == "host")
      request.host = value;
  }
  return request;
}

}  // namespace talus
