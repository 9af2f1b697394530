#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

// What the server and those who answer its requests have in common; no library shows.

namespace tassilo {

/// One request, its access already checked. Text as it came, at most as long as the server allows.
struct WebRequest {
  std::string method;  ///< "GET", "PUT", ...
  std::string path;    ///< Decoded, begins with "/", without query.
  std::string query;   ///< After the "?", as it came.
  std::string body;
};

struct WebResponse {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
};

/// Says why not, in plain text.
WebResponse refusal(int status, std::string_view why);

/// Answers what is no file and no channel. Called on a thread of its own, one request after the other: who takes long
/// keeps other requests waiting, but neither files nor channels. What it throws is told as status 500.
using WebHandler = std::function<WebResponse(const WebRequest&)>;

/// "%2F" becomes "/"; nothing when an escape is broken or stands for a control character.
std::optional<std::string> percent_decoded(std::string_view text);
/// The first value of a key in a query, "a=1&b=2"; nothing when the key is missing or its value is broken.
std::optional<std::string> query_value(std::string_view query, std::string_view key);
/// What a browser shall take a file for, by its ending: "text/html; charset=utf-8"; bytes when it is unknown.
std::string_view content_type_of(std::string_view file_name);

}  // namespace tassilo
