// What the server of talus watch answers, and whom.
#include "io/system/http_server.hpp"

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <list>
#include <thread>

#include "core/error.hpp"
#include "io/system/http_request.hpp"

namespace talus::http_server_test {

namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::optional<HttpAnswer> hello(const std::string& path)
{
  if (path == "/broken")
    throw EnvironmentError("the disk is gone");
  if (path == "/large")
    return HttpAnswer{"text/plain", std::make_shared<const std::string>(std::string(20'000'000, 'x'))};
  if (path != "/")
    return std::nullopt;
  return HttpAnswer{"text/html; charset=utf-8", std::make_shared<const std::string>("<p>" + std::string(100'000, 'x'))};
}

/// A connection to a server on this machine.
class Visitor {
 public:
  explicit Visitor(int port, std::uint32_t from = INADDR_LOOPBACK) : socket_(::socket(AF_INET, SOCK_STREAM, 0))
  {
    sockaddr_in own{}, other{};
    own.sin_family = other.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(from);
    other.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    other.sin_port = htons(static_cast<std::uint16_t>(port));
    const timeval patience{10, 0};
    EXPECT_EQ(::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience), 0);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&other), sizeof other), 0);
  }
  ~Visitor() { ::close(socket_); }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  bool say(std::string_view text) const
  {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  /// All that comes until the server closes the connection.
  std::string listen() const
  {
    std::string all(1 << 16, '\0'), heard;
    for (;;) {
      const ssize_t got = ::recv(socket_, all.data(), all.size(), 0);
      if (got <= 0)
        return heard;
      heard.append(all, 0, static_cast<std::size_t>(got));
    }
  }

 private:
  int socket_;
};

std::string request(int port, const std::string& first_line, const std::string& more = "")
{
  return first_line + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more + "\r\n";
}

std::string asked(int port, const std::string& text)
{
  const Visitor visitor(port);
  EXPECT_TRUE(visitor.say(text));
  return visitor.listen();
}

double seconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(HttpServer, AnswersGetAndHeadOnlyAndWithHeadersThatKeepOthersOut)
{
  const HttpServer server(0, hello);
  const int port = server.port();
  const std::string got = asked(port, request(port, "GET /"));
  EXPECT_THAT(got, StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\nContent-Length: 100003\r\n"));
  EXPECT_EQ(got.size() - got.find("\r\n\r\n") - 4, 100'003u);
  for (const char* header : {"X-Content-Type-Options: nosniff", "Cache-Control: no-store", "X-Frame-Options: DENY"})
    EXPECT_THAT(got, HasSubstr(header));
  EXPECT_THAT(got, Not(HasSubstr("Access-Control-Allow-Origin")));
  const std::string head = asked(port, request(port, "HEAD /"));
  EXPECT_THAT(head, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(head, HasSubstr("Content-Length: 100003\r\n"));
  EXPECT_THAT(head, testing::EndsWith("\r\n\r\n"));
  for (const char* method : {"POST", "DELETE", "OPTIONS", "get"})
    EXPECT_THAT(asked(port, request(port, std::string(method) + " /", "Content-Length: 1\r\n") + "x"), StartsWith("HTTP/1.1 405 "))
        << method;
  EXPECT_THAT(asked(port, request(port, "GET /else")), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(asked(port, request(port, "GET /../etc/passwd")), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(asked(port, request(port, "GET /?again")), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(asked(port, request(port, "GET /broken")),
              testing::AllOf(StartsWith("HTTP/1.1 500 "), HasSubstr("\r\n\r\nthe disk is gone\n")));
}

TEST(HttpServer, AForeignNameIsRefusedAndSoAreTwo)
{
  const HttpServer server(0, hello);
  const int port = server.port();
  const auto status = [&](const std::string& fields) { return asked(port, "GET / HTTP/1.1\r\n" + fields + "\r\n").substr(9, 3); };
  const std::string ours = "localhost:" + std::to_string(port);
  EXPECT_EQ(status("Host: " + ours + "\r\n"), "200");
  EXPECT_EQ(status("host:" + ours + "\r\n"), "200");
  EXPECT_EQ(status("Host: evil.example:" + std::to_string(port) + "\r\n"), "403");
  EXPECT_EQ(status("Host: 127.0.0.1.evil.example\r\n"), "403");
  EXPECT_EQ(status("Host: 127.0.0.1\r\n"), "403") << "of another server";
  EXPECT_EQ(status(""), "403");
  EXPECT_EQ(status("Host: " + ours + "\r\nHost: evil.example\r\n"), "400");
  EXPECT_EQ(status("Host: " + ours + "\r\nhost: " + ours + "\r\n"), "400");
  EXPECT_EQ(status("Host: " + ours + "\r\n continued\r\n"), "400");
  EXPECT_EQ(status("Host : " + ours + "\r\n"), "400");
  EXPECT_THAT(asked(port, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              HasSubstr("\r\n\r\nthis page is for http://127.0.0.1 and http://localhost only\n"));
}

TEST(HttpServer, WhatIsNoRequestIsRefused)
{
  const HttpServer server(0, hello);
  const int port = server.port();
  for (const std::string line : {"GET http://127.0.0.1/", "GET", "GET  /", "GET / /", "G\x01T /", "GET /\x7f", "GET *"})
    EXPECT_THAT(asked(port, request(port, line)), StartsWith("HTTP/1.1 400 ")) << line;
  EXPECT_THAT(asked(port, "GET / HTTP/2.0\r\n\r\n"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(asked(port, std::string(100, '\0') + "\r\n\r\n"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(asked(port, request(port, "GET /", "X: " + std::string(9000, 'x') + "\r\n")), StartsWith("HTTP/1.1 431 "));
  EXPECT_THROW(parse_http_request(""), Error);
}

TEST(HttpServer, RequestsThatDoNotEndKeepNobodyWaiting)
{
  const HttpServer server(0, hello);
  const int port = server.port();
  const std::string half = "GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\nX: ";
  std::list<Visitor> idle;
  for (int i = 0; i < 100; ++i)
    EXPECT_TRUE(idle.emplace_back(port, i % 3 == 0 ? INADDR_LOOPBACK : INADDR_LOOPBACK + 1 + static_cast<std::uint32_t>(i)).say(half));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(asked(port, request(port, "GET /")), StartsWith("HTTP/1.1 200 "));
  EXPECT_LT(seconds_since(begin), 1);
}

TEST(HttpServer, ARequestThatDripsIsDropped)
{
  const HttpServer server(0, hello);
  const Visitor slow(server.port());
  const auto begin = std::chrono::steady_clock::now();
  while (slow.say("a") && seconds_since(begin) < 8)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_LT(seconds_since(begin), 5);
  EXPECT_GT(seconds_since(begin), 1.5);
}

TEST(HttpServer, AnswersThatNobodyTakesKeepNobodyWaiting)
{
  const HttpServer server(0, hello);
  const int port = server.port();
  std::list<Visitor> deaf;
  for (int i = 0; i < 40; ++i)
    EXPECT_TRUE(deaf.emplace_back(port, INADDR_LOOPBACK + static_cast<std::uint32_t>(i)).say(request(port, "GET /large")));
  EXPECT_THAT(asked(port, request(port, "GET /")), StartsWith("HTTP/1.1 200 "));
}

TEST(HttpServer, WhatHasBegunIsGivenToItsEndAfterTheServerHasGone)
{
  std::optional<HttpServer> server(std::in_place, 0, hello);
  const int port = server->port();
  const Visitor visitor(port);
  ASSERT_TRUE(visitor.say(request(port, "GET /large")));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  std::thread end([&] { server.reset(); });
  EXPECT_GT(visitor.listen().size(), 20'000'000u);
  end.join();
}

TEST(HttpServer, APortThatIsTakenIsToldAndOneThatIsFreedIsFree)
{
  std::optional<HttpServer> server(std::in_place, 0, hello);
  const int port = server->port();
  EXPECT_THROW(HttpServer(port, hello), EnvironmentError);
  server.reset();
  EXPECT_EQ(HttpServer(port, hello).port(), port);
}

}  // namespace

}  // namespace talus::http_server_test
