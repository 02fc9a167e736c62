#pragma once
// The head of a request to the server of talus watch.
#include <string>
#include <string_view>

namespace talus {

struct HttpRequest {
  std::string method;  ///< "GET"
  std::string path;    ///< from its slash up to a question mark, as it was sent
  std::string host;    ///< empty: there is none
};

/// `head`: from the first line up to the empty one.  Strict: whatever two readers could understand in two ways is an error, such as two hosts, two
/// lengths or a line that goes on in the next.  Error, in words, of what is wrong.
HttpRequest parse_http_request(std::string_view head);

}  // namespace talus
