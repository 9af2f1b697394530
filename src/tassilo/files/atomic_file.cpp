#include "tassilo/files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

[[noreturn]] void fail(const std::filesystem::path& target, const char* what) {
  throw Error(target.string(), std::string("cannot be ") + what + ": " + std::strerror(errno));
}

void write_all(const std::filesystem::path& target, int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR) fail(target, "written");
    if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// What exists and is no file must stay what it is: a device, a pipe.
bool is_no_file(const std::filesystem::path& target) {
  struct stat status;
  return stat(target.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

/// An open descriptor of something that is no file.
class Stream {
 public:
  explicit Stream(const std::filesystem::path& target) : descriptor_(open(target.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail(target, "written");
  }
  ~Stream() { close(descriptor_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Removes the temporary file unless it became the real one.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target) : target_(target) {
    static std::atomic<unsigned> counter{0};
    path_ = target.string() + ".tmp" + std::to_string(getpid()) + "_" + std::to_string(counter++);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(target_, "created");
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!done_) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void keep_permissions_of_target() {
    struct stat status;
    if (stat(target_.c_str(), &status) == 0 && fchmod(descriptor_, status.st_mode & 07777) != 0)
      fail(target_, "written");
  }
  void fill(std::string_view bytes) { write_all(target_, descriptor_, bytes); }
  void become_target() {
    if (fsync(descriptor_) != 0) fail(target_, "written");
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 || rename(path_.c_str(), target_.c_str()) != 0) fail(target_, "written");
    done_ = true;
  }

 private:
  std::filesystem::path target_;
  std::string path_;
  int descriptor_ = -1;
  bool done_ = false;
};

/// The name itself survives a power cut only once its folder is on the disk; not all file systems can, so no error.
void flush_folder_of(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

void write_atomically(const std::filesystem::path& file, std::string_view bytes) {
  if (is_no_file(file)) return write_all(file, Stream(file).descriptor(), bytes);
  std::error_code ignored;
  std::filesystem::path target = file;
  if (std::filesystem::is_symlink(file, ignored)) target = std::filesystem::weakly_canonical(file, ignored);
  if (ignored) target = file;
  TemporaryFile temporary(target);
  temporary.keep_permissions_of_target();
  temporary.fill(bytes);
  temporary.become_target();
  flush_folder_of(target);
}

}  // namespace tassilo
