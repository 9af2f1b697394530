#include "tassilo/files/colors_history.h"

#include <algorithm>
#include <system_error>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

fs::path history_folder(const fs::path& colors_file) {
  return colors_file.parent_path() / (colors_file.stem().string() + "_history");
}

}  // namespace

std::vector<FormerColors> read_history(const fs::path& colors_file) {
  std::vector<FormerColors> history;
  std::error_code error;
  for (auto at = fs::directory_iterator(history_folder(colors_file), error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    const fs::directory_entry& entry = *at;
    if (entry.path().extension() != ".yaml") continue;
    FormerColors former{entry.path().stem().string(), {}, ""};
    try {
      former.colors = read_colors(entry.path());
    } catch (const Error& reason) {
      former.fault = reason.what();
    }
    history.push_back(std::move(former));
  }
  std::ranges::sort(history, std::greater<>{}, &FormerColors::id);
  return history;
}

std::string keep_in_history(const fs::path& colors_file, const ColorsFile& colors, const std::string& now) {
  const fs::path folder = history_folder(colors_file);
  const std::vector<FormerColors> history = read_history(colors_file);
  for (const FormerColors& former : history)
    if (former.fault.empty() && former.colors == colors) return former.id;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string(), "cannot be created: " + error.message());
  std::string id = now;
  for (int n = 2; fs::exists(folder / (id + ".yaml"), error); ++n) id = now + "-" + std::to_string(n);
  write_colors(folder / (id + ".yaml"), colors);
  return id;
}

}  // namespace tassilo
