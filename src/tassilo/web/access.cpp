#include "tassilo/web/access.h"

#include <algorithm>
#include <array>
#include <random>

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCookie = "tassilo_token=";

/// The value of our cookie among "a=1; b=2".
std::string_view token_in(std::string_view cookies) {
  while (!cookies.empty()) {
    std::string_view one = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(cookies.size(), one.size() + 1));
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(kCookie)) return one.substr(kCookie.size());
  }
  return {};
}

bool names_this_machine(std::string_view host, std::string_view address, int port) {
  const std::string port_text = std::to_string(port);
  const auto is = [&](std::string_view name) {
    constexpr int left_out = 80;  // browsers do not name the usual port
    if (port == left_out && host == name) return true;
    return host.size() == name.size() + 1 + port_text.size() && host.starts_with(name) && host[name.size()] == ':' &&
           host.ends_with(port_text);
  };
  return is("localhost") || is("127.0.0.1") || is("[::1]") || is(address);
}

}  // namespace

std::string new_token() {
  std::random_device random;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    const unsigned value = random();
    for (int shift = 0; shift < 32; shift += 4) token += "0123456789abcdef"[value >> shift & 15];
  }
  return token;
}

bool is_loopback(std::string_view address) { return address.starts_with("127.") || address == "::1"; }

bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k) difference |= static_cast<unsigned char>(a[k] ^ b[k]);
  return difference == 0;
}

Access access_of(const AccessRequest& request, std::string_view address, int port, std::string_view token) {
  if (is_loopback(address) && !names_this_machine(request.host, address, port)) return Access::wrong_host;
  if (!request.origin.empty() && request.origin != "http://" + std::string(request.host)) return Access::wrong_origin;
  if (request.origin.empty() && request.fetch_site == "cross-site") return Access::wrong_origin;
  constexpr std::string_view bearer = "Bearer ";
  const std::string_view given = request.authorization.starts_with(bearer) ? request.authorization.substr(bearer.size())
                                                                           : token_in(request.cookie);
  return token.empty() || same_secret(given, token) ? Access::granted : Access::no_token;
}

std::optional<fs::path> served_file(const fs::path& folder, std::string_view path) {
  if (folder.empty() || !path.starts_with('/') || path.find('\\') != std::string_view::npos) return std::nullopt;
  if (path.find("/.") != std::string_view::npos) return std::nullopt;
  std::error_code error;
  const fs::path root = fs::canonical(folder, error);
  if (error) return std::nullopt;
  fs::path file = fs::canonical(root / fs::path(path.substr(1)), error);
  if (error) return std::nullopt;
  if (fs::is_directory(file, error)) file = fs::canonical(file / "index.html", error);
  if (error || !fs::is_regular_file(file, error)) return std::nullopt;
  const auto [end_of_root, inside] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
  return end_of_root == root.end() && inside != file.end() ? std::optional(file) : std::nullopt;
}

}  // namespace tassilo
