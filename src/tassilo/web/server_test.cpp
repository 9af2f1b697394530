#include "tassilo/web/server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A connection that sends bytes as they are, well or badly behaved.
class Connection {
 public:
  explicit Connection(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  bool send(const std::string& text) { return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) > 0; }
  /// What comes until `enough`, or until the other side closes; at most `ms` of silence.
  std::string receive(const std::function<bool(const std::string&)>& enough, int ms = 5000) {
    std::string got;
    while (!enough(got)) {
      pollfd waiting{socket_, POLLIN, 0};
      if (poll(&waiting, 1, ms) <= 0) break;
      char buffer[4096];
      const ssize_t count = recv(socket_, buffer, sizeof buffer, 0);
      if (count <= 0) {
        closed_ = true;
        break;
      }
      got.append(buffer, static_cast<std::size_t>(count));
    }
    return got;
  }
  std::string receive_all(int ms = 5000) {
    return receive([](const std::string&) { return false; }, ms);
  }
  bool closed() const { return closed_; }
  bool is_open() const { return is_open_; }

 private:
  int socket_;
  bool is_open_ = false, closed_ = false;
};

class Server : public testing::Test {
 protected:
  static WebOptions options() {
    WebOptions options;
    options.port = 0;
    options.channels = {"scene", "picture"};
    options.idle_s = 1;
    options.max_body = 1000;
    options.max_clients = 4;
    return options;
  }
  static WebResponse echo(const WebRequest& request) {
    if (request.path == "/api/fail") throw std::runtime_error("as asked");
    if (request.path != "/api/echo") return {404, "text/plain", "nothing\n"};
    return {200, "application/json",
            "{\"method\":\"" + request.method + "\",\"query\":\"" + request.query +
                "\",\"body\":" + std::to_string(request.body.size()) + "}"};
  }
  static std::string head(const std::string& line, int port, const std::string& more = "") {
    return line + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n" + more + "\r\n";
  }
  /// One request, one answer.
  static std::string ask(int port, const std::string& line, const std::string& more = "",
                         const std::string& body = "") {
    Connection connection(port);
    const std::string length = body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n";
    connection.send(head(line, port, "Connection: close\r\n" + length + more) + body);
    return connection.receive_all();
  }
  static std::string upgrade(int port, const std::string& channel, const std::string& more = "") {
    return head("GET /ws/" + channel, port,
                "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                    more);
  }
  static void wait_until(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!holds() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ASSERT_TRUE(holds());
  }
};

TEST_F(Server, AnswersRequests) {
  const WebServer server(options(), echo);
  const std::string answer = ask(server.port(), "PUT /api/echo?a=1", "", "12345");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("{\"method\":\"PUT\",\"query\":\"a=1\",\"body\":5}"));
  for (const char* header : {"X-Content-Type-Options: nosniff", "X-Frame-Options: DENY", "Content-Security-Policy:"})
    EXPECT_THAT(answer, HasSubstr(header));
  EXPECT_THAT(ask(server.port(), "GET /api/other"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(ask(server.port(), "GET /api/fail"), testing::AllOf(StartsWith("HTTP/1.1 500"), HasSubstr("as asked")));
  EXPECT_EQ(server.counts().requests, 3);
}

TEST_F(Server, ManyRequestsGoThroughOneConnection) {
  const WebServer server(options(), echo);
  Connection connection(server.port());
  for (int k = 0; k < 10; ++k) {
    connection.send(head("GET /api/echo?k=" + std::to_string(k), server.port()));
    const std::string ending = "k=" + std::to_string(k) + "\",\"body\":0}";
    EXPECT_THAT(connection.receive([&](const std::string& got) { return got.ends_with(ending); }), HasSubstr(ending));
  }
}

TEST_F(Server, RefusesWhatIsTooMuchOrNoRequest) {
  const WebServer server(options(), echo);
  EXPECT_THAT(ask(server.port(), "PUT /api/echo", "", std::string(1001, 'x')), StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(ask(server.port(), "PUT /api/echo", "", std::string(1000, 'x')), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(ask(server.port(), "GET /api/echo", "X-Long: " + std::string(20000, 'x') + "\r\n"),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(ask(server.port(), "GET /%zz"), StartsWith("HTTP/1.1 400"));
  Connection noise(server.port());
  noise.send("\x16\x03\x01 this is no HTTP\r\n\r\n");
  EXPECT_THAT(noise.receive_all(), StartsWith("HTTP/1.1 400"));
  // A length that is claimed and never sent, and one that does not fit a number.
  EXPECT_THAT(ask(server.port(), "PUT /api/echo", "Content-Length: 99999999999999999999999\r\n"),
              testing::AnyOf(StartsWith("HTTP/1.1 400"), StartsWith("HTTP/1.1 413")));
  EXPECT_THAT(ask(server.port(), "GET /api/echo"), StartsWith("HTTP/1.1 200")) << "and goes on";
}

TEST_F(Server, CutsWhoIsSlow) {
  const WebServer server(options(), echo);
  Connection silent(server.port()), half(server.port());
  half.send("GET /api/echo HTTP/1.1\r\nHost: ");
  EXPECT_EQ(silent.receive_all(5000), "");
  EXPECT_TRUE(silent.closed());
  half.receive_all(5000);
  EXPECT_TRUE(half.closed());
  wait_until([&] { return server.counts().clients == 0; });
}

TEST_F(Server, TurnsAwayMoreThanItsClients) {
  const WebServer server(options(), echo);
  std::vector<std::unique_ptr<Connection>> connections;
  for (int k = 0; k < 4; ++k) connections.push_back(std::make_unique<Connection>(server.port()));
  wait_until([&] { return server.counts().clients == 4; });
  Connection more(server.port());
  EXPECT_THAT(more.receive_all(), StartsWith("HTTP/1.1 503"));
  connections.clear();
  wait_until([&] { return server.counts().clients == 0; });
  EXPECT_THAT(ask(server.port(), "GET /api/echo"), StartsWith("HTTP/1.1 200"));
}

TEST_F(Server, TheTokenOpensTheDoorOnce) {
  WebOptions with_token = options();
  with_token.address = "0.0.0.0";
  EXPECT_THROW(WebServer(with_token, echo), Error) << "open to others without a token";
  with_token.token = "0123456789abcdef";
  const WebServer server(with_token, echo);
  EXPECT_THAT(server.url(), HasSubstr("/?token=0123456789abcdef"));
  EXPECT_THAT(ask(server.port(), "GET /api/echo"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(ask(server.port(), "GET /?token=0123456789abcdee"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(
      ask(server.port(), "GET /?token=0123456789abcdef"),
      testing::AllOf(StartsWith("HTTP/1.1 303"),
                     HasSubstr("Set-Cookie: tassilo_token=0123456789abcdef; Path=/; HttpOnly; SameSite=Strict")));
  EXPECT_THAT(ask(server.port(), "GET /api/echo", "Cookie: tassilo_token=0123456789abcdef\r\n"),
              StartsWith("HTTP/1.1 200"));
  Connection listener(server.port());
  listener.send(upgrade(server.port(), "scene"));
  EXPECT_THAT(listener.receive([](const std::string& got) { return got.find("\r\n\r\n") != std::string::npos; }),
              StartsWith("HTTP/1.1 401"));
}

TEST_F(Server, PagesOfOthersAreRefused) {
  const WebServer server(options(), echo);
  EXPECT_THAT(ask(server.port(), "GET /api/echo", "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  Connection listener(server.port());
  listener.send(upgrade(server.port(), "scene", "Origin: http://evil.example\r\n"));
  EXPECT_THAT(listener.receive([](const std::string& got) { return got.find("\r\n\r\n") != std::string::npos; }),
              StartsWith("HTTP/1.1 403"));
  Connection other(server.port());
  other.send("GET /api/echo HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(other.receive_all(), StartsWith("HTTP/1.1 403"));
}

TEST_F(Server, ListenersGetWhatIsPublishedAndSlowOnesTheNewest) {
  WebServer server(options(), echo);
  server.publish("scene", std::make_shared<const std::string>("unheard"), WebServer::Message::text);
  Connection quick(server.port()), slow(server.port());
  for (Connection* one : {&quick, &slow}) {
    one->send(upgrade(server.port(), "scene"));
    EXPECT_THAT(one->receive([](const std::string& got) { return got.find("\r\n\r\n") != std::string::npos; }),
                StartsWith("HTTP/1.1 101"));
  }
  wait_until([&] { return server.listeners("scene") == 2; });
  server.publish("scene", std::make_shared<const std::string>("first"), WebServer::Message::text);
  EXPECT_EQ(quick.receive([](const std::string& got) { return got.size() >= 7; }),
            "\x81\x05"
            "first");
  // 400 MB of pictures for one that takes none of them: it costs neither time nor memory.
  const auto large = std::make_shared<const std::string>(1 << 20, 'x');
  for (int k = 0; k < 400; ++k) server.publish("scene", large, WebServer::Message::binary);
  wait_until([&] { return server.counts().dropped > 0; });
  EXPECT_EQ(server.listeners("picture"), 0);
  EXPECT_THAT(ask(server.port(), "GET /api/echo"), StartsWith("HTTP/1.1 200"));
  // Who takes nothing for longer than is decent is cut.
  wait_until([&] { return server.listeners("scene") == 0; });
}

TEST_F(Server, UnknownChannelsAndTakenPortsAreErrors) {
  const WebServer server(options(), echo);
  Connection listener(server.port());
  listener.send(upgrade(server.port(), "secret"));
  EXPECT_THAT(listener.receive([](const std::string& got) { return got.find("\r\n\r\n") != std::string::npos; }),
              StartsWith("HTTP/1.1 404"));
  WebOptions taken = options();
  taken.port = server.port();
  EXPECT_THROW(WebServer(taken, echo), Error);
  taken.address = "robot";
  EXPECT_THROW(WebServer(taken, echo), Error);
}

}  // namespace
}  // namespace tassilo
