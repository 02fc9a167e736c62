#pragma once
// A server for the browser of this machine's user: it only reads, and answers only those who ask for it by the name of this machine.
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace talus {

struct HttpAnswer {
  std::string type;  ///< such as "text/html; charset=utf-8"
  std::shared_ptr<const std::string> body;
};

/// Answers GET and HEAD on 127.0.0.1, on threads of its own, while it lives.  Requests under another name than 127.0.0.1 or localhost are
/// refused: a page from elsewhere may have had its own name point here.
class HttpServer {
 public:
  /// What stands at a path such as "/stamp"; nothing: not found.  Called by several threads at once; what it throws is told as its message.
  using Answer = std::function<std::optional<HttpAnswer>(const std::string& path)>;

  /// Port 0: any that is free.  EnvironmentError: the port is taken.
  HttpServer(int port, Answer answer);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace talus
