#pragma once
// The head of a request to the server of talus watch.
#include <string>
#include <string_view>

namespace talus {

struct HttpRequest {
  std::string method;  ///< "GET"
  std::string path;    ///< from its slash up to a question mark, as sent
  std::string host;    ///< empty if missing
};

/// Parses a head from the first line up to the empty one.  Everything ambiguous is an error, such as two hosts, two lengths or a continued
/// line.  Throws Error with the reason.
HttpRequest parse_http_request(std::string_view head);

}  // namespace talus
