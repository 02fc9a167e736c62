// One thread and non-blocking sockets, so that a slow client does not block the others.
#include "io/system/http_server.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <list>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "io/files/file_descriptor.hpp"
#include "io/system/http_request.hpp"

namespace talus {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto loopback = "127.0.0.1";
constexpr std::size_t most_connections = 32, most_of_address = 16;  // a browser opens six connections
constexpr std::size_t longest_head = 8192;                          // in bytes
constexpr auto time_for_request = 2s, time_for_answer = 30s, time_for_goodbye = 1s, time_to_end = 2s;

constexpr std::string_view headers =
    "Cache-Control: no-store\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "X-Frame-Options: DENY\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Connection: close\r\n";

/// The head and body of an answer.
struct Reply {
  std::string head;
  std::shared_ptr<const std::string> body;
};

Reply reply(int status, std::string_view words, std::string_view type, std::shared_ptr<const std::string> body, bool head_only = false,
            std::string_view more = "")
{
  std::string head =
      fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}{}\r\n", status, words, type, body->size(), headers, more);
  return {std::move(head), head_only ? nullptr : std::move(body)};
}

Reply refusal(int status, std::string_view words, const std::string& why, bool head_only = false, std::string_view more = "")
{
  return reply(status, words, "text/plain", std::make_shared<const std::string>(why + '\n'), head_only, more);
}

/// The connection of one client.
struct Connection {
  enum class State : std::uint8_t { asks, takes, leaves };

  Connection(int number, std::uint32_t from) : socket(number), address(from) {}
  FileDescriptor socket;
  std::uint32_t address;
  State state = State::asks;
  Clock::time_point until = Clock::now() + time_for_request;  ///< deadline after which it is closed
  std::string request;
  Reply answer;
  std::size_t sent = 0;  ///< bytes of the answer sent so far

  /// Receives; false if the connection is closed.
  bool receive()
  {
    std::array<char, 4096> block{};
    constexpr int at_a_time = 64;  // limit of reads, so that a client that sends without end does not block the others
    for (int n = 0; n < at_a_time; ++n) {
      const ssize_t got = ::recv(socket.number(), block.data(), block.size(), 0);
      if (got < 0)
        return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
      if (got == 0)
        return false;
      if (state != State::asks)
        continue;  // the client does not take it
      request.append(block.data(), static_cast<std::size_t>(got));
      if (is_complete())
        return true;
    }
    return true;
  }
  bool is_complete() const { return request.size() > longest_head || request.find("\r\n\r\n") != request.npos; }

  void begin_answer(Reply reply)
  {
    answer = std::move(reply);
    state = State::takes;
    until = Clock::now() + time_for_answer;
  }
  /// Sends; false if the connection is closed.
  bool send()
  {
    for (;;) {
      const bool in_head = sent < answer.head.size();
      const std::string_view part = in_head       ? std::string_view(answer.head).substr(sent)
                                    : answer.body ? std::string_view(*answer.body).substr(sent - answer.head.size())
                                                  : std::string_view();
      if (part.empty())
        break;
      const ssize_t gone = ::send(socket.number(), part.data(), part.size(), MSG_NOSIGNAL);
      if (gone < 0)
        return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
      sent += static_cast<std::size_t>(gone);
    }
    // If it were closed at once with unread input, the connection would be reset and the answer lost.
    ::shutdown(socket.number(), SHUT_WR);
    state = State::leaves;
    until = Clock::now() + time_for_goodbye;
    return true;
  }
};

FileDescriptor listening_socket(int port)
{
  FileDescriptor door(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (door.is_open() && ::setsockopt(door.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      ::bind(door.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 && ::listen(door.number(), SOMAXCONN) == 0)
    return door;
  throw EnvironmentError(port == 0
                             ? fmt::format("no port of {} is free", loopback)
                             : fmt::format("--port {}: another program has it, or it is not allowed: choose another, or leave it out for "
                                           "any that is free",
                                           port));
}

int port_of(int number)
{
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (::getsockname(number, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw EnvironmentError(fmt::format("no port of {} is free", loopback));
  return ntohs(address.sin_port);
}

std::array<int, 2> pipe_ends()
{
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0)
    throw EnvironmentError("no pipe can be made for the server of the page");
  return ends;
}

}  // namespace

struct HttpServer::Inside {
  Inside(int wanted_port, Answer give) : answer(std::move(give)), door(listening_socket(wanted_port)), port(port_of(door.number())) {}

  Answer answer;
  FileDescriptor door;
  int port;
  std::array<int, 2> wake = pipe_ends();
  FileDescriptor wake_read{wake[0]}, wake_write{wake[1]};  ///< closed last: the thread has ended by then
  std::list<Connection> connections;                       ///< the oldest first
  std::thread thread;

  bool is_ours(const std::string& host) const
  {
    return host == fmt::format("{}:{}", loopback, port) || host == fmt::format("localhost:{}", port);
  }

  Reply respond(const std::string& text) const
  {
    const std::size_t end = text.find("\r\n\r\n");
    if (end == text.npos || end > longest_head)
      return refusal(431, "Request Header Fields Too Large", fmt::format("a request has at most {} bytes", longest_head));
    HttpRequest request;
    try {
      request = parse_http_request(std::string_view(text).substr(0, end + 2));
    } catch (const Error& wrong) {
      return refusal(400, "Bad Request", wrong.what());
    }
    const bool head_only = request.method == "HEAD";
    if (!is_ours(request.host))
      return refusal(403, "Forbidden", "this page is for http://127.0.0.1 and http://localhost only", head_only);
    if (request.method != "GET" && !head_only)
      return refusal(405, "Method Not Allowed", "nothing can be changed here", false, "Allow: GET, HEAD\r\n");
    try {
      const auto found = answer(request.path);
      if (!found || found->body->empty())
        return refusal(404, "Not Found", "there is nothing here", head_only);
      return reply(200, "OK", found->type, found->body, head_only);
    } catch (const std::exception& e) {
      return refusal(500, "Internal Server Error", e.what(), head_only);
    }
  }

  /// Closes the oldest connection; the request of a browser is received and answered within milliseconds.
  void make_room(std::uint32_t address)
  {
    const auto same = [&](const Connection& one) { return one.address == address; };
    if (static_cast<std::size_t>(std::count_if(connections.begin(), connections.end(), same)) >= most_of_address)
      connections.erase(std::find_if(connections.begin(), connections.end(), same));
    else if (connections.size() >= most_connections)
      connections.pop_front();
  }

  void let_in()
  {
    for (std::size_t n = 0; n < most_connections; ++n) {  // limit of new connections at a time: the present ones are served next
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const int number = ::accept4(door.number(), reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
      if (number >= 0) {
        make_room(from.sin_addr.s_addr);
        connections.emplace_back(number, from.sin_addr.s_addr);
        if (!serve(connections.back()))
          connections.pop_back();
        continue;
      }
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {  // the process has no descriptors or memory left
        if (!connections.empty())
          connections.pop_front();
        std::this_thread::sleep_for(20ms);
      }
      return;
    }
  }

  /// Serves one connection; false if it is closed or has to be closed.
  bool serve(Connection& one) const
  {
    if (one.state != Connection::State::takes && !one.receive())
      return false;
    if (one.state == Connection::State::asks && one.is_complete())
      one.begin_answer(respond(one.request));
    if (one.state == Connection::State::takes && !one.send())
      return false;
    return Clock::now() < one.until;
  }

  void run()
  {
    std::optional<Clock::time_point> end;
    while (!end || (Clock::now() < *end && !connections.empty())) {
      std::vector<pollfd> asked{{wake_read.number(), POLLIN, 0}, {door.number(), POLLIN, 0}};
      for (const Connection& one : connections)
        asked.push_back({one.socket.number(), static_cast<short>(one.state == Connection::State::takes ? POLLOUT : POLLIN), 0});
      constexpr int at_least_every = 200;  // interval of the check for deadlines [ms]
      if (end) {
        asked[0].fd = -1;  // ignored
        asked[1].fd = -1;
      }
      const int ready = ::poll(asked.data(), asked.size(), connections.empty() && !end ? -1 : at_least_every);
      if (ready < 0 && errno != EINTR)
        return;
      if (asked[0].revents != 0) {
        end = Clock::now() + time_to_end;
        connections.remove_if([](const Connection& one) { return one.state == Connection::State::asks; });
        continue;
      }
      std::size_t i = 2;
      for (auto one = connections.begin(); one != connections.end(); ++i) {
        // Input that arrived while an answer was made is read before a client is dropped for being late.
        const bool stays = asked[i].revents == 0 && Clock::now() < one->until ? true : serve(*one);
        one = stays ? std::next(one) : connections.erase(one);
      }
      if (asked[1].revents != 0)
        let_in();
    }
  }
};

HttpServer::HttpServer(int port, Answer answer) : inside_(std::make_unique<Inside>(port, std::move(answer)))
{
  inside_->thread = std::thread([inside = inside_.get()] { inside->run(); });
}

HttpServer::~HttpServer()
{
  const char stop = 0;
  while (::write(inside_->wake_write.number(), &stop, 1) < 0 && errno == EINTR) {
  }
  inside_->thread.join();
}

int HttpServer::port() const noexcept { return inside_->port; }

}  // namespace talus
