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

/// Answers GET and HEAD on 127.0.0.1, on a thread of its own, while it lives, one request for each connection.  Requests under another name than
/// 127.0.0.1 or localhost are refused: a page from elsewhere may have had its own name point here.
///
/// No client can block the others: a request that is not complete after 2 s is dropped, an answer that is not taken after 30 s too, and
/// where there are more than 32 connections, or 16 from one address, the oldest of them makes room.
class HttpServer {
 public:
  /// What stands at a path such as "/stamp"; nothing: not found.  Called on the thread of the server; what it throws is the answer, as its message.
  using Answer = std::function<std::optional<HttpAnswer>(const std::string& path)>;

  /// Port 0: any that is free.  EnvironmentError: the port is taken.
  HttpServer(int port, Answer answer);
  /// Answers that have begun are given, for 2 s at most.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace talus
