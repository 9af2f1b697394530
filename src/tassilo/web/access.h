#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Who may ask for what. Pure functions of the headers; an absent header is an empty text.

namespace tassilo {

/// A secret of 128 random bits as text, from the system's generator. Throws std::exception when there is none.
std::string new_token();

/// Is this address one that only this machine can reach? "127.0.0.1", "::1".
bool is_loopback(std::string_view address);

/// What of a request decides on access.
struct AccessRequest {
  std::string_view host, origin, fetch_site, cookie, authorization;  ///< Headers of these names (Sec-Fetch-Site).
};

/// Who was let in how, or why not.
enum class Access {
  granted,
  no_token,      ///< 401
  wrong_host,    ///< 403: a page elsewhere whose name was bent to point here.
  wrong_origin,  ///< 403: a page elsewhere.
};

/// A request is let in when it names this server as its host (on loopback; elsewhere names are not known), comes from a
/// page of this server or from no page, and carries the token as cookie or `Authorization: Bearer`, where there is one.
///
/// address, port   that the server listens at
/// token           empty: none is needed
/// cost            the token is compared in a time that does not depend on where it differs
Access access_of(const AccessRequest& request, std::string_view address, int port, std::string_view token);
/// Are both the same, in a time that depends on their lengths only?
bool same_secret(std::string_view a, std::string_view b);

/// The file below `folder` that a request's path means; "/" and folders mean their index.html. Nothing when there is
/// none, or it lies elsewhere, whatever ".." or links say; and for hidden files.
std::optional<std::filesystem::path> served_file(const std::filesystem::path& folder, std::string_view path);

}  // namespace tassilo
