#pragma once
// A read-only web server for the browser on this machine, which answers requests to the name of this machine only.
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace talus {

struct HttpAnswer {
  std::string type;  ///< for example "text/html; charset=utf-8"
  std::shared_ptr<const std::string> body;
};

/// Answers GET and HEAD on 127.0.0.1, on its own thread, as long as it exists, with one request per connection.  Requests for other host
/// names than 127.0.0.1 or localhost are refused, because another page may have redirected its name to this machine.  No client can block
/// the others: a request that is not complete after 2 s is dropped, an answer that is not taken after 30 s too, and with more than 32
/// connections, or 16 from one address, the oldest one is closed.
class HttpServer {
 public:
  /// The answer for a path such as "/stamp"; nothing means not found.  Called on the thread of the server; the message of an exception
  /// becomes the answer.
  using Answer = std::function<std::optional<HttpAnswer>(const std::string& path)>;

  /// Port 0 selects any free port.  Throws EnvironmentError if the port is in use.
  HttpServer(int port, Answer answer);
  /// Completes answers that have begun, for 2 s at most.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace talus
