// What the server of talus watch answers, and whom.
#include <gmock/gmock.h>
#include <httplib.h>

#include "core/error.hpp"
#include "io/http_server.hpp"

namespace talus::http_server_test {

namespace {

std::optional<HttpAnswer> hello(const std::string& path)
{
  if (path == "/broken")
    throw EnvironmentError("the disk is gone");
  if (path != "/")
    return std::nullopt;
  return HttpAnswer{"text/html; charset=utf-8", std::make_shared<const std::string>("<p>" + std::string(100'000, 'x'))};
}

TEST(HttpServer, AnswersGetAndHeadOnlyAndWithHeadersThatKeepOthersOut)
{
  const HttpServer server(0, hello);
  httplib::Client client("127.0.0.1", server.port());
  client.set_keep_alive(true);
  const auto got = client.Get("/");
  ASSERT_TRUE(got);
  EXPECT_EQ(got->status, 200);
  EXPECT_EQ(got->body.size(), 100'003u);
  EXPECT_EQ(got->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(got->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(got->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(got->get_header_value("X-Frame-Options"), "DENY");
  EXPECT_FALSE(got->has_header("Access-Control-Allow-Origin"));
  EXPECT_FALSE(got->has_header("Content-Encoding"));
  const auto head = client.Head("/");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->body, "");
  EXPECT_EQ(head->get_header_value("Content-Length"), "100003");
  EXPECT_EQ(client.Post("/", "x", "text/plain")->status, 405);
  EXPECT_EQ(client.Delete("/")->status, 405);
  EXPECT_EQ(client.Options("/")->status, 405);
  EXPECT_EQ(client.Get("/else")->status, 404);
  EXPECT_EQ(client.Get("/../etc/passwd")->status, 404);
  const auto broken = client.Get("/broken");
  EXPECT_EQ(broken->status, 500);
  EXPECT_EQ(broken->body, "the disk is gone\n");
}

TEST(HttpServer, AForeignNameIsRefused)
{
  const HttpServer server(0, hello);
  httplib::Client client("127.0.0.1", server.port());
  const auto status = [&](const std::string& host) { return client.Get("/", httplib::Headers{{"Host", host}})->status; };
  EXPECT_EQ(status("localhost:" + std::to_string(server.port())), 200);
  EXPECT_EQ(status("evil.example:" + std::to_string(server.port())), 403);
  EXPECT_EQ(status("127.0.0.1.evil.example"), 403);
  EXPECT_EQ(status("127.0.0.1"), 403) << "of another server";
  EXPECT_EQ(client.Get("/", httplib::Headers{{"Host", "evil.example"}})->body,
            "this page is for http://127.0.0.1 and http://localhost only\n");
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
