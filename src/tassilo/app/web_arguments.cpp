#include "tassilo/app/web_arguments.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tassilo/app/terminal_qr.h"
#include "tassilo/web/access.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

/// The first folder of pages that is there: what the environment says, beside the installed program, where this was
/// built.
fs::path pages_folder() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("TASSILO_WEBUI")) folders.emplace_back(named);
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error)
    folders.push_back(program.parent_path().parent_path() / "share/tassilo/webui");
  folders.emplace_back(TASSILO_INSTALLED_WEBUI);
  folders.emplace_back(TASSILO_BUILT_WEBUI);
  for (const fs::path& folder : folders)
    if (fs::exists(folder / "index.html", error)) return folder;
  return {};
}

}  // namespace

void WebArguments::add_to(CLI::App& command) {
  command.add_option("--address", web.address, "IP address to listen at; beyond 127.0.0.1 with a token")
      ->capture_default_str();
  command.add_option("--port", web.port, "port to listen at; 0: any")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--token", web.token, "secret that every request must carry; made when it is needed")
      ->check([](const std::string& token) {
        constexpr std::size_t least = 16;
        const bool is_plain =
            token.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_") ==
            std::string::npos;
        return is_plain && token.size() >= least ? "" : "must be 16 or more of a-z, A-Z, 0-9, - and _";
      });
  command.add_option("--pages", pages, "folder with pages, instead of the installed ones")
      ->check(CLI::ExistingDirectory);
}

WebOptions WebArguments::options() const {
  WebOptions options = web;
  options.pages = pages.empty() ? pages_folder() : fs::path(pages);
  // Who can reach it from elsewhere must have been told.
  if (!is_loopback(options.address) && options.token.empty()) options.token = new_token();
  return options;
}

void tell_address(const WebOptions& web, const std::string& url) {
  fmt::print("{} {} {}{}; Ctrl-C ends\n", web.pages.empty() ? "serving at" : "open", url,
             web.pages.empty() ? "for programs" : "in a browser",
             is_loopback(web.address) ? "" : " (the address of this machine instead of " + web.address + ")");
  if (web.pages.empty())
    fmt::print(
        "without pages, only the interface for programs: they are built by `make release` where node and npm are\n");
  if (!is_loopback(web.address) && isatty(STDOUT_FILENO) == 1) fmt::print("{}", terminal_qr(url));
  std::fflush(stdout);
}

}  // namespace tassilo
