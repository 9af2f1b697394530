#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/web/http.h"

namespace tassilo {

struct WebOptions {
  std::string address = "127.0.0.1";  ///< To listen at; beyond this machine only with a token.
  int port = 8080;                    ///< 0: any that is free. 0..65535
  std::string token;                  ///< Every request must carry it; empty: none.
  std::filesystem::path pages;        ///< Folder whose files are served; empty: none.
  std::string front = "index.html";   ///< File in there that is the page at "/".
  std::vector<std::string> channels;  ///< Messages at /ws/<channel>.
  std::size_t max_body = 1 << 20;     ///< Of a request. [B]
  int max_clients = 32;               ///< Connections at a time; more are turned away.
  int idle_s = 20;                    ///< Whoever neither sends nor takes anything for so long is cut. [s], > 0
  void check() const;                 ///< Throws Error naming the first field out of range.
};

/// What has happened so far.
struct WebCounts {
  std::int64_t clients = 0;   ///< Connections now.
  std::int64_t requests = 0;  ///< Answered, whatever the answer.
  std::int64_t refused = 0;   ///< Of them: 401, 403, 413, ..., and connections beyond max_clients.
  std::int64_t sent = 0;      ///< Messages of channels, each client for itself.
  std::int64_t dropped = 0;   ///< Messages that a slow client, or the server, passed over for newer ones.
};

/// Serves pages, requests and channels over HTTP/1.1 and WebSocket, in a thread of its own; requests are answered in
/// another.
///
/// A channel's message goes to each of its listeners; one that has not yet taken the message before gets the newest
/// when it is ready, and nobody waits for it. Access is checked by `access_of` for every request; `/?token=...` sets
/// the cookie. Bodies, headers and times are bounded.
///
/// threads  publish, listeners and counts from any; they do not wait for clients
class WebServer {
 public:
  /// Listens at once. Throws Error when it cannot: the address is not ours, the port is taken.
  WebServer(const WebOptions& options, WebHandler handler);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  /// Where to look: "http://127.0.0.1:8080/", with the token as a query where there is one.
  std::string url() const;

  enum class Message { text, binary };
  /// To all listeners of a channel that the options name.
  void publish(std::string_view channel, std::shared_ptr<const std::string> message, Message kind);
  /// How many listen to a channel: what nobody wants need not be made.
  int listeners(std::string_view channel) const;
  WebCounts counts() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tassilo
