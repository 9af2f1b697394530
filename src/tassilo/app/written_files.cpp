#include "tassilo/app/written_files.h"

#include <filesystem>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

bool is_same(const NamedFile& a, const NamedFile& b) {
  if (a.path.empty() || b.path.empty() || a.path == "-" || b.path == "-") return false;
  std::error_code failed;
  const fs::path first = fs::weakly_canonical(a.path, failed);
  if (failed) return false;
  const fs::path second = fs::weakly_canonical(b.path, failed);
  if (failed) return false;
  const fs::file_status status = fs::status(first, failed);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return false;
  return first == second || fs::equivalent(first, second, failed);
}

/// Is `written` one of the pictures in a folder that is read? Other files may stand beside them.
bool is_picture_in(const NamedFile& written, const NamedFile& folder) {
  std::error_code failed;
  const fs::path path = written.path;
  if (path.empty() || folder.path.empty() || !fs::is_directory(folder.path, failed) ||
      !fs::is_regular_file(path, failed))
    return false;
  const std::string extension = path.extension().string();
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") return false;
  return fs::equivalent(path.has_parent_path() ? path.parent_path() : fs::path("."), folder.path, failed);
}

}  // namespace

void check_written_files(std::span<const NamedFile> read, std::span<const NamedFile> written) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    for (const NamedFile& input : read)
      if (is_same(written[i], input))
        throw Error(written[i].role, "is " + written[i].path + ", which is read as " + input.role +
                                         " and would be lost, must be another");
    for (const NamedFile& input : read)
      if (is_picture_in(written[i], input))
        throw Error(written[i].role, "is " + written[i].path + ", a picture of the folder that is read as " +
                                         input.role + ", and would be lost, must be another");
    for (std::size_t k = 0; k < i; ++k)
      if (is_same(written[i], written[k]))
        throw Error(written[i].role, "is " + written[i].path + " like " + written[k].role + ", must be another");
  }
}

}  // namespace tassilo
