// The only file that knows cpp-httplib.
#include "io/http_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <thread>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr auto loopback = "127.0.0.1";
constexpr std::size_t threads_of_server = 8;  // a browser keeps several connections open
constexpr std::time_t patience = 5;           // s, for a request that has begun, and between two of one connection

void refuse(int status, const std::string& why, httplib::Response& response)
{
  response.status = status;
  response.set_content(why + '\n', "text/plain");
}

/// In pieces: as a whole the library would compress it, for a way that costs nothing.
void give(const HttpAnswer& answer, httplib::Response& response)
{
  response.status = 200;
  response.set_content_provider(answer.body->size(), answer.type,
                                [body = answer.body](std::size_t at, std::size_t n, httplib::DataSink& sink) {
                                  sink.write(body->data() + at, n);
                                  return true;
                                });
}

}  // namespace

struct HttpServer::Inside {
  httplib::Server server;
  Answer answer;
  int port = 0;
  std::thread thread;

  bool is_ours(const std::string& host) const
  {
    return host == fmt::format("{}:{}", loopback, port) || host == fmt::format("localhost:{}", port);
  }

  void respond(const httplib::Request& request, httplib::Response& response) const
  try {
    if (!is_ours(request.get_header_value("Host")))
      return refuse(403, "this page is for http://127.0.0.1 and http://localhost only", response);
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      response.set_header("Connection", "close");  // what else the request holds is not read
      return refuse(405, "nothing can be changed here", response);
    }
    const auto found = answer(request.path);
    if (!found || found->body->empty())
      return refuse(404, "there is nothing here", response);
    give(*found, response);
  } catch (const std::exception& e) {
    refuse(500, e.what(), response);
  }
};

HttpServer::HttpServer(int port, Answer answer) : inside_(std::make_unique<Inside>())
{
  Inside& inside = *inside_;
  inside.answer = std::move(answer);
  httplib::Server& server = inside.server;
  server.new_task_queue = [] { return new httplib::ThreadPool(threads_of_server); };
  server.set_socket_options([](socket_t socket) {  // without SO_REUSEPORT, which the library sets: two servers would share a port
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_read_timeout(patience);
  server.set_keep_alive_timeout(patience);
  server.set_payload_max_length(1);
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"},
                              {"Referrer-Policy", "no-referrer"},
                              {"Cross-Origin-Resource-Policy", "same-origin"}});
  server.set_pre_routing_handler([&inside](const httplib::Request& request, httplib::Response& response) {
    inside.respond(request, response);
    return httplib::Server::HandlerResponse::Handled;
  });
  inside.port = port == 0 ? server.bind_to_any_port(loopback) : server.bind_to_port(loopback, port) ? port : -1;
  if (inside.port <= 0)
    throw EnvironmentError(port == 0
                               ? fmt::format("no port of {} is free", loopback)
                               : fmt::format("--port {}: another program has it, or it is not allowed: choose another, or leave it out for "
                                             "any that is free",
                                             port));
  inside.thread = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running())  // until then it could not be stopped
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

HttpServer::~HttpServer()
{
  inside_->server.stop();
  inside_->thread.join();
}

int HttpServer::port() const noexcept { return inside_->port; }

}  // namespace talus
