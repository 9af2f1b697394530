#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tassilo/camera/mount.h"
#include "tassilo/color/color_class.h"
#include "tassilo/field/field_model.h"
#include "tassilo/image/frame.h"
#include "tassilo/sim/world_state.h"

// The simulated camera: what a robot's camera shows of the world, by ray tracing with the project's own camera models.
// docs/conventions.md has pixels, frames and labels.

namespace tassilo {

/// A lamp that shines downwards, a ball of light. Field frame.
struct SimLamp {
  double x = 0, y = 0, z = 3.5;  ///< [m], z > 0
  double intensity = 1;          ///< 0: off; all lamps at 1 light the floor with 1 - ambient on average. >= 0
  double temperature = 4300;     ///< Color; the camera's white balance is for 4300. [K], 1500..15000
  double radius = 0.25;          ///< Large ones have soft shadows. [m], >= 0
  friend bool operator==(const SimLamp&, const SimLamp&) = default;
};

enum class RenderQuality {
  fast,  ///< For real time: only what moves casts shadows, and on the floor alone.
  full,  ///< Everything within the field shades everything.
};

/// Light, lens and sensor of a simulated camera, and what stands around the field.
struct RenderOptions {
  std::vector<SimLamp> lamps;  ///< Empty: six above the field, as in a hall.
  double ambient = 0.3;        ///< Light from all sides at the floor, of which lamps give the rest. 0..1
  double exposure = 1.1;       ///< What light becomes at the sensor; 1 is where it saturates. > 0

  double shot_noise = 0.018;  ///< One standard deviation at saturation; grows with the square root of light. >= 0
  double read_noise = 0.003;  ///< The same everywhere. >= 0, 1 is saturation
  double vignetting = 0.25;   ///< Share of light that image corners lose. 0..1
  double blur_px = 0.55;      ///< Of lens and focus, one standard deviation. [px], 0..8
  bool flat = false;   ///< No light and shade, and no tone curve: R'G'B' are exposure times paint. For measuring.
  double shutter = 0;  ///< How long light is collected, about the state's time: motion blur. [s], 0..0.2
  int sub_frames = 1;  ///< Moments of that time that are rendered; 1: no motion blur. 1..64

  double carpet = 0.12;              ///< Contrast of the carpet's grain. 0..1
  double clutter = 0.6;              ///< Crates and posters in the hall. 0: none, 1: full
  double people = 0.6;               ///< Around the field. 0..1
  bool ball_colored_people = false;  ///< Some wear shirts of the ball's color.
  std::uint64_t seed = 1;            ///< Of people, clutter, noise.

  RenderQuality quality = RenderQuality::full;
  int rays_per_side = 3;  ///< A pixel's square is looked at n x n times. 1..8
  ColorRange range = ColorRange::limited;
  PixelFormat format = PixelFormat::yuv422p;  ///< yuv422p or yuv420p; chroma is the mean of the pixels that share it.

  void check() const;  ///< Throws Error naming the first value out of range.
};

/// For real time, as a camera of the recordings sees.
RenderOptions fast_rendering();
/// No noise, blur, texture, vignetting, people or clutter: what tests measure in.
RenderOptions plain_rendering();

/// How a robot of the simulated world is painted: a body with a band all around of its team's color, some with a mast
/// and a black head on top.
struct RobotLook {
  ColorClass body = ColorClass::black;
  std::optional<ColorClass> marker;        ///< None where the field's robots have none of this color.
  double marker_low = 0, marker_high = 0;  ///< [m]
  double mast = 0;                         ///< Above the body; 0: none. [m]
};
RobotLook robot_look(const SimRobot& robot, const FieldModel& field);

/// How much of an object shows.
struct SimVisibility {
  int visible_px = 0;                               ///< Pixels that show it.
  int silhouette_px = 0;                            ///< Pixels that would if there were nothing else.
  std::optional<std::array<int, 4>> box, full_box;  ///< Of both: c_min, r_min, c_max, r_max, all inclusive.
  bool truncated = false;                           ///< The silhouette touches the image's border.
};

/// What is where in an image; by the rays of the pixels' centres, at the state's time.
struct SimView {
  int width = 0, height = 0;
  std::vector<std::uint8_t> labels;  ///< 0..8 by paint, 255 ignored: colored things outside the field.
  SimVisibility ball;
  std::vector<SimVisibility> goals;   ///< Of the field's goals: panels seen through the mouth.
  std::vector<SimVisibility> robots;  ///< Of the state's robots; nothing for the one that looks.
};

/// A robot's camera in the simulated world.
///
/// Rays are those of the camera model at every pixel, computed once; edges are where they are to a few thousandths of a
/// pixel. The same options, state and camera give the same bytes.
///
/// cost     construction up to a second. No allocation a frame but for the first ones, for more robots than before, and
///          two that Embree makes when things move. 3 to 7 ms a frame of 384x172 in fast quality; see
///          bench/sim_bench.cpp.
/// threads  one at a time.
class Renderer {
 public:
  /// Throws Error for options out of range or when ray tracing is not possible here.
  Renderer(const FieldModel& field, const MountedCamera& camera, const RenderOptions& options = {});
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  const RenderOptions& options() const;
  /// Lamps that go on and off, and exposure; takes as long as construction. Throws Error.
  void set_light(const std::vector<SimLamp>& lamps, double exposure);

  /// What the camera of `observer`, a robot of the state, sees; that robot itself does not show. t is the state's.
  Frame render(const SimState& state, int observer);
  /// The truth about it. Valid until the next call.
  const SimView& look(const SimState& state, int observer);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace tassilo
