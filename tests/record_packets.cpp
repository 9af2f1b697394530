// Writes down what a program sends over UDP, for tests that send it again, spoiled: preloaded, this library passes
// every call of sendmsg on and adds the bytes to the file that the environment variable TASSILO_RECORD_PACKETS names,
// each packet after its length in 4 bytes (little endian); the first 20000 of them.
#include <dlfcn.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace {

class Record {
 public:
  Record() {
    if (const char* const file = std::getenv("TASSILO_RECORD_PACKETS"); file != nullptr) out_ = std::fopen(file, "we");
  }
  void sent(const msghdr& message) {
    std::string bytes;
    for (std::size_t i = 0; i < message.msg_iovlen; ++i)
      bytes.append(static_cast<const char*>(message.msg_iov[i].iov_base), message.msg_iov[i].iov_len);
    const std::lock_guard lock(mutex_);
    if (out_ == nullptr || count_ == 20'000) return;
    ++count_;
    const auto size = static_cast<std::uint32_t>(bytes.size());
    for (int shift = 0; shift < 32; shift += 8) std::fputc(static_cast<int>(size >> shift & 255), out_);
    std::fwrite(bytes.data(), 1, bytes.size(), out_);
    std::fflush(out_);
  }

 private:
  std::mutex mutex_;
  std::FILE* out_ = nullptr;
  int count_ = 0;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) ssize_t sendmsg(int descriptor, const msghdr* message, int flags) {
  static auto* const next = reinterpret_cast<ssize_t (*)(int, const msghdr*, int)>(dlsym(RTLD_NEXT, "sendmsg"));
  static Record& record = *new Record;  // never destroyed: threads send to the very end
  const ssize_t sent = next(descriptor, message, flags);
  if (sent > 0) record.sent(*message);
  return sent;
}
