// Writes down what a program does to files, for tests of what a power cut leaves: preloaded, this library passes every
// call on and adds a line to the file that the environment variable TASSILO_RECORD_WRITES names:
//   open ID PATH        a file was created or opened to be written; ID stands for its descriptor while it is open
//   write ID HEX        bytes were added at its end
//   sync ID | sync DIRECTORY
//   rename FROM TO | unlink PATH | mkdir PATH
// Paths are absolute, and have no blanks in tests. Only what is done below TASSILO_RECORD_FOLDER is written down.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

namespace {

template <class Function>
Function* next_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

class Record {
 public:
  Record() {
    const char* const file = std::getenv("TASSILO_RECORD_WRITES");
    const char* const folder = std::getenv("TASSILO_RECORD_FOLDER");
    folder_ = folder != nullptr ? folder : "";
    if (file != nullptr) out_ = std::fopen(file, "ae");
  }

  void opened(int descriptor, const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (descriptor < 0 || !is_of_interest(path)) return;
    names_[descriptor] = std::to_string(next_++);
    say("open " + names_[descriptor] + " " + path);
  }
  void opened_folder(int descriptor, const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (descriptor >= 0 && is_of_interest(path)) names_[descriptor] = path;
  }
  void written(int descriptor, const void* bytes, ssize_t count) {
    const std::lock_guard lock(mutex_);
    const auto name = names_.find(descriptor);
    if (name == names_.end() || count <= 0) return;
    std::string line = "write " + name->second + " ";
    for (ssize_t i = 0; i < count; ++i) {
      char hex[3];
      std::snprintf(hex, sizeof hex, "%02x", static_cast<const unsigned char*>(bytes)[i]);
      line += hex;
    }
    say(line);
  }
  void synced(int descriptor) {
    const std::lock_guard lock(mutex_);
    if (const auto name = names_.find(descriptor); name != names_.end()) say("sync " + name->second);
  }
  void closed(int descriptor) {
    const std::lock_guard lock(mutex_);
    names_.erase(descriptor);
  }
  void changed(const std::string& what, const std::string& path, const std::string& to = "") {
    const std::lock_guard lock(mutex_);
    if (!is_of_interest(path)) return;
    std::string line = what + " " + path;
    if (!to.empty()) line.append(" ").append(absolute(to));
    say(line);
  }

  static std::string absolute(const std::string& path) {
    if (path.starts_with('/')) return path;
    char folder[PATH_MAX];
    return getcwd(folder, sizeof folder) != nullptr ? std::string(folder) + "/" + path : path;
  }

 private:
  bool is_of_interest(const std::string& path) const {
    return out_ != nullptr && !folder_.empty() && path.starts_with(folder_);
  }
  void say(const std::string& line) {
    std::fprintf(out_, "%s\n", line.c_str());
    std::fflush(out_);
  }

  std::mutex mutex_;
  std::FILE* out_ = nullptr;
  std::string folder_;
  std::map<int, std::string> names_;
  int next_ = 0;
};

/// Lives as long as the process: others write after what is static is gone.
Record& record() {
  static Record* const one = new Record;
  return *one;
}

int open_as(const char* function, const char* path, int flags, mode_t mode) {
  const int descriptor = next_function<int(const char*, int, ...)>(function)(path, flags, mode);
  const std::string name = Record::absolute(path);
  if ((flags & O_DIRECTORY) != 0)
    record().opened_folder(descriptor, name);
  else if ((flags & O_ACCMODE) != O_RDONLY)
    record().opened(descriptor, name);
  return descriptor;
}

mode_t mode_of(int flags, va_list arguments) { return (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0; }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_as("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_as("open64", path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  const ssize_t done = next_function<ssize_t(int, const void*, size_t)>("write")(descriptor, bytes, count);
  const int error = errno;
  record().written(descriptor, bytes, done);
  errno = error;
  return done;
}

int fsync(int descriptor) {
  const int done = next_function<int(int)>("fsync")(descriptor);
  if (done == 0) record().synced(descriptor);
  return done;
}

int close(int descriptor) {
  record().closed(descriptor);
  return next_function<int(int)>("close")(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  const int done = next_function<int(const char*, const char*)>("rename")(from, to);
  if (done == 0) record().changed("rename", Record::absolute(from), to);
  return done;
}

int unlink(const char* path) noexcept {
  const int done = next_function<int(const char*)>("unlink")(path);
  if (done == 0) record().changed("unlink", Record::absolute(path));
  return done;
}

int remove(const char* path) noexcept {
  const int done = next_function<int(const char*)>("remove")(path);
  if (done == 0) record().changed("unlink", Record::absolute(path));
  return done;
}

int mkdir(const char* path, mode_t mode) noexcept {
  const int done = next_function<int(const char*, mode_t)>("mkdir")(path, mode);
  if (done == 0) record().changed("mkdir", Record::absolute(path));
  return done;
}
}
