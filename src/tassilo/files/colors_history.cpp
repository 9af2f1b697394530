#include "tassilo/files/colors_history.h"

#include <algorithm>
#include <system_error>

#include "tassilo/base/error.h"
#include "tassilo/files/kept_copies.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

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

std::string keep_in_history(const fs::path& colors_file, const ColorsFile& colors, const std::string& now,
                            std::vector<FormerColors>& history) {
  for (const FormerColors& former : history)
    if (former.fault.empty() && former.colors == colors) return former.id;
  const fs::path file = unused_file(history_folder(colors_file), now, ".yaml");
  write_colors(file, colors);
  history.push_back({file.stem().string(), read_colors(file), ""});
  std::ranges::sort(history, std::greater<>{}, &FormerColors::id);
  return file.stem().string();
}

}  // namespace tassilo
