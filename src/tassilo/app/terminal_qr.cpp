#include "tassilo/app/terminal_qr.h"

#include <qrencode.h>

#include <memory>

namespace tassilo {

std::string terminal_qr(const std::string& text) {
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_L, QR_MODE_8, 1), QRcode_free);
  if (!code) return "";
  const auto dark = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= code->width || y >= code->width) return false;
    return (code->data[y * code->width + x] & 1) != 0;
  };
  constexpr int margin = 2;  // readers want a light rim
  std::string out;
  for (int y = -margin; y < code->width + margin; y += 2) {
    out += "\033[30;107m";  // black on bright white
    for (int x = -margin; x < code->width + margin; ++x)
      out += dark(x, y) ? (dark(x, y + 1) ? "\u2588" : "\u2580") : (dark(x, y + 1) ? "\u2584" : " ");
    out += "\033[0m\n";
  }
  return out;
}

}  // namespace tassilo
