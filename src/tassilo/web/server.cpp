#include "tassilo/web/server.h"

#include <utility>  // before asio, which forgets it

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/web/access.h"

namespace tassilo {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
using ErrorCode = boost::system::error_code;

constexpr std::size_t kMaxHeader = 16 * 1024;       // [B]
constexpr std::size_t kMaxPage = 16 * 1024 * 1024;  // [B]
constexpr std::size_t kMaxFromSocket = 4 * 1024;    // listeners have little to say [B]
constexpr std::string_view kChannelPath = "/ws/";

std::string text_of(boost::beast::string_view text) { return {text.data(), text.size()}; }
std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Does one thing after the other in a thread of its own.
class Worker {
 public:
  Worker() : thread_([this] { work(); }) {}
  /// Ends with what is being done; what waits is dropped.
  ~Worker() { end(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void add(std::function<void()> task) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    wanted_.notify_one();
  }
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wanted_.notify_one();
    if (thread_.joinable()) thread_.join();
    tasks_.clear();
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      wanted_.wait(lock, [&] { return ending_ || !tasks_.empty(); });
      if (ending_) return;
      const auto task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      try {
        task();
      } catch (const std::exception&) {  // there is no memory for the answer, say: this connection is without one
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable wanted_;
  std::deque<std::function<void()>> tasks_;  ///< At most one of each connection.
  bool ending_ = false;
  std::thread thread_;
};

/// What all sessions share; on the server's thread but for the atomics and what the mutex guards.
struct Shared {
  WebOptions options;
  WebHandler handler;
  Worker* worker = nullptr;
  int port = 0;
  std::atomic<std::int64_t> clients = 0, requests = 0, refused = 0, sent = 0, dropped = 0;
};

/// Counts a connection while it lives.
class ClientCount {
 public:
  explicit ClientCount(Shared& shared) : shared_(shared) { ++shared_.clients; }
  ~ClientCount() { --shared_.clients; }
  ClientCount(const ClientCount&) = delete;
  ClientCount& operator=(const ClientCount&) = delete;

 private:
  Shared& shared_;
};

struct Outgoing {
  std::shared_ptr<const std::string> message;
  bool is_text = true;
};

/// One listener of a channel.
class Listener : public std::enable_shared_from_this<Listener> {
 public:
  Listener(tcp::socket&& socket, Shared& shared, std::set<Listener*>& channel, std::atomic<int>& count,
           std::shared_ptr<ClientCount> client)
      : socket_(std::move(socket)), shared_(shared), channel_(channel), count_(count), client_(std::move(client)) {}
  ~Listener() { leave(); }

  void run(const Request& request) {
    websocket::stream_base::timeout timeout{};
    timeout.handshake_timeout = timeout.idle_timeout = std::chrono::seconds(shared_.options.idle_s);
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.read_message_max(kMaxFromSocket);
    socket_.auto_fragment(false);  // a picture in one piece
    socket_.async_accept(request, [self = shared_from_this()](ErrorCode error) {
      if (error) return;
      self->channel_.insert(self.get());
      ++self->count_;
      self->joined_ = true;
      self->read();
    });
  }

  void send(Outgoing outgoing) {
    if (writing_) {
      shared_.dropped += waiting_.has_value();
      waiting_ = std::move(outgoing);
      return;
    }
    write(std::move(outgoing));
  }

 private:
  void write(Outgoing outgoing) {
    writing_ = true;
    socket_.text(outgoing.is_text);
    const asio::const_buffer bytes(outgoing.message->data(), outgoing.message->size());
    socket_.async_write(
        bytes, [self = shared_from_this(), message = std::move(outgoing.message)](ErrorCode error, std::size_t) {
          self->writing_ = false;
          if (error) return self->leave();
          ++self->shared_.sent;
          if (self->waiting_) self->write(*std::exchange(self->waiting_, std::nullopt));
        });
  }
  /// Takes what comes, so that pings and good-byes are answered; nothing of it is asked for.
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->leave();
      self->buffer_.clear();
      self->read();
    });
  }
  void leave() {
    if (!std::exchange(joined_, false)) return;
    channel_.erase(this);
    --count_;
  }

  websocket::stream<beast::tcp_stream> socket_;
  Shared& shared_;
  std::set<Listener*>& channel_;
  std::atomic<int>& count_;
  std::shared_ptr<ClientCount> client_;
  beast::flat_buffer buffer_{kMaxFromSocket};
  bool joined_ = false, writing_ = false;
  std::optional<Outgoing> waiting_;
};

struct Channel {
  std::set<Listener*> listeners;  ///< On the server's thread.
  std::atomic<int> count = 0;
  std::mutex mutex;
  std::optional<Outgoing> latest;  ///< Guarded: not yet handed to the listeners.
};

Response plain(http::status status, const std::string& text) {
  Response response{status, 11};
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.body() = text + "\n";
  return response;
}

/// One HTTP connection, request after request.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket&& socket, Shared& shared, std::map<std::string, Channel, std::less<>>& channels)
      : stream_(std::move(socket)),
        shared_(shared),
        channels_(channels),
        client_(std::make_shared<ClientCount>(shared)) {}

  void read() {
    parser_.emplace();
    parser_->body_limit(shared_.options.max_body);
    parser_->header_limit(kMaxHeader);
    expire();
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error == http::error::body_limit)
        return self->refuse(
            http::status::payload_too_large,
            "the body is too large, must be at most " + std::to_string(self->shared_.options.max_body) + " bytes");
      if (error == http::error::header_limit)
        return self->refuse(http::status::request_header_fields_too_large, "the headers are too large");
      if (error && error.category() == make_error_code(http::error::bad_method).category() &&
          error != http::error::end_of_stream && error != http::error::partial_message)
        return self->refuse(http::status::bad_request, "this is no HTTP request");
      if (error) return self->close();
      self->answer(self->parser_->release());
    });
  }

  /// Says no, and hangs up.
  void refuse(http::status status, const std::string& why) {
    ++shared_.refused;
    Response response = plain(status, why);
    response.keep_alive(false);
    write(std::move(response));
  }

 private:
  void expire() { stream_.expires_after(std::chrono::seconds(shared_.options.idle_s)); }

  void answer(Request request) {
    const Request& asked = request;
    const auto header = [&](auto name) { return view_of(asked[name]); };
    const std::string target = text_of(asked.target());
    const std::size_t mark = target.find('?');
    const auto path = percent_decoded(std::string_view(target).substr(0, mark));
    const std::string query = mark == std::string::npos ? "" : target.substr(mark + 1);
    const auto said = [&](Response response, bool is_refusal = false) {
      shared_.refused += is_refusal;
      say(std::move(response), Manner{asked.version(), asked.keep_alive(), asked.method() == http::verb::head});
    };
    if (!path || !path->starts_with('/')) return said(plain(http::status::bad_request, "the path is broken"), true);

    AccessRequest access{header(http::field::host), header(http::field::origin), view_of(asked["Sec-Fetch-Site"]),
                         header(http::field::cookie), header(http::field::authorization)};
    const std::string& token = shared_.options.token;
    const auto given = asked.method() == http::verb::get ? query_value(query, "token") : std::nullopt;
    if (!token.empty() && given && *path == "/" && same_secret(*given, token)) {
      // From now on as a cookie, and out of the address line.
      Response response = plain(http::status::see_other, "welcome");
      response.set(http::field::location, "/");
      response.set(http::field::set_cookie, "tassilo_token=" + token + "; Path=/; HttpOnly; SameSite=Strict");
      return said(std::move(response));
    }
    switch (access_of(access, shared_.options.address, shared_.port, token)) {
      case Access::granted:
        break;
      case Access::no_token:
        return said(plain(http::status::unauthorized,
                          "the token is missing or wrong: open the address that the program has printed"),
                    true);
      case Access::wrong_host:
        return said(plain(http::status::forbidden, "this server is not known by that name"), true);
      case Access::wrong_origin:
        return said(plain(http::status::forbidden, "only pages of this server may ask"), true);
    }

    if (websocket::is_upgrade(asked)) {
      const auto channel =
          path->starts_with(kChannelPath) ? channels_.find(path->substr(kChannelPath.size())) : channels_.end();
      if (channel == channels_.end()) return said(plain(http::status::not_found, "there is no such channel"), true);
      stream_.expires_never();  // the listener has times of its own
      std::make_shared<Listener>(stream_.release_socket(), shared_, channel->second.listeners, channel->second.count,
                                 client_)
          ->run(asked);
      return;
    }
    const bool reads = asked.method() == http::verb::get || asked.method() == http::verb::head;
    if (reads)
      if (const auto file = served_file(shared_.options.pages, *path == "/" ? "/" + shared_.options.front : *path))
        return said(page(*file));
    // The answer may take its time; until then nothing is read, so there is one at a time.
    stream_.expires_never();
    const Manner manner{asked.version(), asked.keep_alive(), asked.method() == http::verb::head};
    shared_.worker->add([self = shared_from_this(), manner,
                         asked = WebRequest{text_of(asked.method_string()), *path, query, request.body()}] {
      auto response = std::make_shared<Response>(self->handled(asked));
      asio::post(self->stream_.get_executor(), [self, manner, response] { self->say(std::move(*response), manner); });
    });
  }

  /// How a request wants to be answered.
  struct Manner {
    unsigned version = 11;
    bool keep_alive = true, is_head = false;
  };
  void say(Response response, const Manner& manner) {
    response.version(manner.version);
    response.keep_alive(manner.keep_alive);
    if (manner.is_head) response.body().clear();
    write(std::move(response));
  }

  Response handled(const WebRequest& request) const {
    WebResponse answer;
    try {
      answer = shared_.handler ? shared_.handler(request) : WebResponse{404, "text/plain", "there is nothing here\n"};
    } catch (const std::exception& error) {
      answer = {500, "text/plain; charset=utf-8", std::string(error.what()) + "\n"};
    }
    Response response{static_cast<http::status>(answer.status), 11};
    response.set(http::field::content_type, answer.content_type);
    response.set(http::field::cache_control, "no-store");
    response.body() = std::move(answer.body);
    return response;
  }

  static Response page(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    if (std::error_code error; std::filesystem::file_size(file, error) <= kMaxPage && !error) content << stream.rdbuf();
    if (!stream || content.str().empty()) return plain(http::status::not_found, "the page cannot be read");
    Response response{http::status::ok, 11};
    response.set(http::field::content_type, std::string(content_type_of(file.string())));
    // What the build named by its content may stay; all else may change with the program.
    const bool is_asset = file.parent_path().filename() == "assets";
    response.set(http::field::cache_control, is_asset ? "max-age=31536000, immutable" : "no-cache");
    response.body() = std::move(content).str();
    return response;
  }

  void write(Response response) {
    ++shared_.requests;
    response.set("X-Content-Type-Options", "nosniff");
    response.set("X-Frame-Options", "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set(
        "Content-Security-Policy",
        "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'");
    response.prepare_payload();
    expire();
    auto kept = std::make_shared<Response>(std::move(response));
    http::async_write(stream_, *kept, [self = shared_from_this(), kept](ErrorCode error, std::size_t) {
      if (error || kept->need_eof()) return self->close();
      self->read();
    });
  }

  void close() {
    ErrorCode ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.close();
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  std::map<std::string, Channel, std::less<>>& channels_;
  std::shared_ptr<ClientCount> client_;
  beast::flat_buffer buffer_{65536};
  std::optional<http::request_parser<http::string_body>> parser_;
};

}  // namespace

void WebOptions::check() const {
  const auto range = [](const std::string& name, std::int64_t value, std::int64_t low, std::int64_t high) {
    if (value < low || value > high)
      throw Error("web." + name,
                  "is " + std::to_string(value) + ", must be " + std::to_string(low) + ".." + std::to_string(high));
  };
  range("port", port, 0, 65535);
  range("max_body", static_cast<std::int64_t>(max_body), 1, 1 << 30);
  range("max_clients", max_clients, 1, 10000);
  range("idle_s", idle_s, 1, 3600);
  if (token.empty() && !is_loopback(address))
    throw Error("web.address", "is " + address + ", which others can reach, so it must have a token");
}

class WebServer::Implementation {
 public:
  Implementation(const WebOptions& options, WebHandler handler) : acceptor_(context_), pause_(context_) {
    options.check();
    shared_.options = options;
    shared_.handler = std::move(handler);
    for (const std::string& channel : options.channels) channels_[channel];
    ErrorCode error;
    const auto address = asio::ip::make_address(options.address, error);
    if (error) throw Error("web.address", "is " + options.address + ", must be an IP address such as 127.0.0.1");
    const tcp::endpoint endpoint(address, static_cast<std::uint16_t>(options.port));
    const auto must = [&] {
      if (error) throw Error(options.address + ":" + std::to_string(options.port), "cannot listen: " + error.message());
    };
    acceptor_.open(endpoint.protocol(), error), must();
    acceptor_.set_option(asio::socket_base::reuse_address(true), error), must();
    acceptor_.bind(endpoint, error), must();
    acceptor_.listen(asio::socket_base::max_listen_connections, error), must();
    shared_.port = acceptor_.local_endpoint().port();
    shared_.worker = &worker_;
    accept();
    thread_ = std::thread([this] { serve(); });
  }
  ~Implementation() {
    context_.stop();
    thread_.join();
    worker_.end();
  }

  const Shared& shared() const { return shared_; }

  void publish(std::string_view name, Outgoing outgoing) {
    const auto channel = channels_.find(name);
    expects(channel != channels_.end(), "WebServer::publish: a channel of the options");
    if (channel->second.count == 0) return;
    {
      const std::lock_guard lock(channel->second.mutex);
      const bool is_on_its_way = channel->second.latest.has_value();
      channel->second.latest = std::move(outgoing);
      shared_.dropped += is_on_its_way;
      if (is_on_its_way) return;
    }
    asio::post(context_, [&channel = channel->second] {
      std::optional<Outgoing> newest;
      {
        const std::lock_guard lock(channel.mutex);
        newest = std::exchange(channel.latest, std::nullopt);
      }
      // A listener may leave while it is written to.
      const std::vector<Listener*> listeners(channel.listeners.begin(), channel.listeners.end());
      for (Listener* listener : listeners)
        if (channel.listeners.contains(listener)) listener->send(*newest);
    });
  }

  int listeners(std::string_view name) const {
    const auto channel = channels_.find(name);
    return channel != channels_.end() ? channel->second.count.load() : 0;
  }

 private:
  /// A connection for which there is no memory, say, is dropped; the others go on.
  void serve() {
    for (;;) {
      try {
        context_.run();
        return;
      } catch (const std::exception&) {
        ++shared_.refused;
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](ErrorCode error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {
        // No file descriptor is left, say: it does not help to ask again at once.
        pause_.expires_after(std::chrono::milliseconds(100));
        pause_.async_wait([this](ErrorCode cancelled) {
          if (!cancelled) accept();
        });
        return;
      }
      {
        socket.set_option(tcp::no_delay(true), error);
        const bool is_full = shared_.clients >= shared_.options.max_clients;
        const auto session = std::make_shared<Session>(std::move(socket), shared_, channels_);
        if (is_full)
          session->refuse(http::status::service_unavailable, "too many connections");
        else
          session->read();
      }
      accept();
    });
  }

  Shared shared_;                                         // sessions in the context refer to these
  std::map<std::string, Channel, std::less<>> channels_;  //
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  Worker worker_;  ///< After the context: what waits in it holds sessions.
  std::thread thread_;
};

WebServer::WebServer(const WebOptions& options, WebHandler handler)
    : implementation_(std::make_unique<Implementation>(options, std::move(handler))) {}
WebServer::~WebServer() = default;

int WebServer::port() const { return implementation_->shared().port; }

std::string WebServer::url() const {
  const WebOptions& options = implementation_->shared().options;
  const bool is_v6 = options.address.find(':') != std::string::npos;
  std::string url =
      "http://" + (is_v6 ? "[" + options.address + "]" : options.address) + ":" + std::to_string(port()) + "/";
  return options.token.empty() ? url : url + "?token=" + options.token;
}

void WebServer::publish(std::string_view channel, std::shared_ptr<const std::string> message, Message kind) {
  implementation_->publish(channel, {std::move(message), kind == Message::text});
}

int WebServer::listeners(std::string_view channel) const { return implementation_->listeners(channel); }

WebCounts WebServer::counts() const {
  const Shared& shared = implementation_->shared();
  return {shared.clients, shared.requests, shared.refused, shared.sent, shared.dropped};
}

}  // namespace tassilo
