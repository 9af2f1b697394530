// Any bytes on a connection are requests, or refused, or cut; no answer opens a file outside of the folder, and nobody
// without the token gets past the door. A server of the real kind on a port of this machine.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/web/access.h"
#include "tassilo/web/server.h"

namespace {

constexpr const char* kSecret = "what only those with the token may read";

tassilo::WebServer& server() {
  static tassilo::WebServer* const one = [] {
    tassilo::WebOptions options;
    options.port = 0;
    options.token = tassilo::new_token();
    options.channels = {"scene"};
    options.max_body = 4096;
    options.idle_s = 1;
    return new tassilo::WebServer(options, [](const tassilo::WebRequest& request) {
      tassilo::expects(request.path.starts_with('/'), "a path begins with /");
      return tassilo::WebResponse{200, "text/plain", kSecret};
    });
  }();
  return *one;
}

/// What the server says to these bytes.
std::string answer_to(const std::uint8_t* data, std::size_t size) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server().port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  tassilo::expects(connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0,
                   "the server goes on");
  for (std::size_t sent = 0; sent < size;) {
    const ssize_t count = send(connection, data + sent, size - sent, MSG_NOSIGNAL);
    if (count <= 0) break;
    sent += static_cast<std::size_t>(count);
  }
  shutdown(connection, SHUT_WR);
  std::string answer;
  char buffer[4096];
  for (ssize_t count = 0; (count = recv(connection, buffer, sizeof buffer, 0)) > 0;)
    answer.append(buffer, static_cast<std::size_t>(count));
  close(connection);
  return answer;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  using namespace tassilo;
  const std::string answer = answer_to(data, size);
  expects(answer.empty() || answer.starts_with("HTTP/1."), "an answer is HTTP");
  expects(answer.find(kSecret) == std::string::npos, "nothing without the token");

  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto decoded = percent_decoded(text)) {
    expects(decoded->size() <= text.size(), "decoding makes nothing longer");
    expects(!served_file("/proc/self/fdinfo", *decoded) || decoded->find("..") == std::string::npos,
            "no path climbs out of the folder");
  }
  query_value(text, "token");
  return 0;
}
