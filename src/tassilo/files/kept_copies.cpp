#include "tassilo/files/kept_copies.h"

#include <chrono>
#include <ctime>
#include <system_error>

#include "tassilo/base/error.h"

namespace tassilo {

namespace fs = std::filesystem;

std::string time_for_names() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H-%M-%SZ", &utc);
  return text;
}

fs::path history_folder(const fs::path& file) { return file.parent_path() / (file.stem().string() + "_history"); }

fs::path unused_file(const fs::path& folder, const std::string& name, std::string_view extension) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string(), "cannot be created: " + error.message());
  fs::path file = folder / (name + std::string(extension));
  for (int n = 2; fs::exists(file, error); ++n)
    file = folder / (name + "-" + std::to_string(n) + std::string(extension));
  return file;
}

}  // namespace tassilo
