#include "tassilo/source/internal/v4l2_controls.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <optional>

namespace tassilo {
namespace {

/// One setting: its value, and the switch that lets the camera choose.
struct Setting {
  const char* name;
  const char* unit;
  __u32 value_id, switch_id;
  std::array<int, 2> automatic;  ///< Switch positions that mean automatic, tried in this order.
  int fixed;
  CameraControl CameraOptions::*wanted;
};

constexpr std::array kSettings{Setting{"exposure",
                                       "",
                                       V4L2_CID_EXPOSURE_ABSOLUTE,
                                       V4L2_CID_EXPOSURE_AUTO,
                                       {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY},
                                       V4L2_EXPOSURE_MANUAL,
                                       &CameraOptions::exposure},
                               Setting{"gain", "", V4L2_CID_GAIN, V4L2_CID_AUTOGAIN, {1, 1}, 0, &CameraOptions::gain},
                               Setting{"white balance",
                                       " K",
                                       V4L2_CID_WHITE_BALANCE_TEMPERATURE,
                                       V4L2_CID_AUTO_WHITE_BALANCE,
                                       {1, 1},
                                       0,
                                       &CameraOptions::white_balance}};

class Controls {
 public:
  explicit Controls(V4l2Device& device) : device_(device) {}

  /// Nothing: the camera has no such control.
  std::optional<v4l2_queryctrl> range(__u32 id) const {
    v4l2_queryctrl query{};
    query.id = id;
    if (ask(VIDIOC_QUERYCTRL, &query) != 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) return std::nullopt;
    return query;
  }
  /// 0 or the errno.
  int set(__u32 id, int value) const {
    v4l2_control control{id, value};
    return ask(VIDIOC_S_CTRL, &control);
  }
  std::optional<int> get(__u32 id) const {
    v4l2_control control{id, 0};
    if (ask(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
    return control.value;
  }
  [[noreturn]] void lacks(const std::string& what) const {
    throw Error(device_.path() + " (" + device_.name() + ")", "has no " + what + "; leave it out");
  }

 private:
  int ask(unsigned long request, void* argument) const {
    const int code = device_.try_ask(request, argument);
    if (is_gone(code)) throw DeviceError(device_.path(), "be set", code);
    return code;
  }
  V4l2Device& device_;
};

bool is_automatic(const Setting& setting, int position) {
  return std::ranges::find(setting.automatic, position) != setting.automatic.end();
}

/// "" or " (why it is not as asked)".
std::string set_switch(const Controls& controls, const Setting& setting, bool automatic) {
  int code = controls.set(setting.switch_id, automatic ? setting.automatic[0] : setting.fixed);
  if (automatic && code != 0) code = controls.set(setting.switch_id, setting.automatic[1]);
  return code == 0 ? "" : " (the switch cannot be set: " + reason_of(code) + ")";
}

std::string apply(const Controls& controls, const Setting& setting, const CameraControl& wanted) {
  const auto range = controls.range(setting.value_id);
  const bool has_switch = controls.range(setting.switch_id).has_value();
  if (wanted.automatic && !has_switch) controls.lacks(std::string("automatic ") + setting.name);
  if (wanted.value && !range) controls.lacks(std::string(setting.name) + " that can be set");
  if (!range && !has_switch) return std::string("no ") + setting.name;

  std::string remark = has_switch ? set_switch(controls, setting, wanted.automatic) : "";
  if (wanted.value) {
    const int code = controls.set(setting.value_id, std::clamp(*wanted.value, range->minimum, range->maximum));
    if (code != 0) remark += " (cannot be set: " + reason_of(code) + ")";
  }
  const auto value = range ? controls.get(setting.value_id) : std::nullopt;
  const auto position = has_switch ? controls.get(setting.switch_id) : std::nullopt;
  if (wanted.value && value && value != wanted.value)
    remark += " (asked for " + std::to_string(*wanted.value) + ", must be " + std::to_string(range->minimum) + ".." +
              std::to_string(range->maximum) +
              (range->step > 1 ? " in steps of " + std::to_string(range->step) : std::string()) + ")";
  std::string text = setting.name;
  if (value) text.append(" ").append(std::to_string(*value)).append(setting.unit);
  return text + (position && is_automatic(setting, *position) ? " automatic" : " fixed") + remark;
}

}  // namespace

std::string apply_controls(V4l2Device& device, const CameraOptions& options) {
  const Controls controls(device);
  std::string text;
  for (const Setting& setting : kSettings)
    text.append(text.empty() ? "" : ", ").append(apply(controls, setting, options.*setting.wanted));
  // With automatic exposure a camera may lower the rate in the dark: the rate is what was agreed on.
  if (options.exposure.automatic && controls.range(V4L2_CID_EXPOSURE_AUTO_PRIORITY))
    controls.set(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
  return text;
}

}  // namespace tassilo
