#include "tassilo/sim/renderer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/geometry/pose2.h"
#include "tassilo/sim/internal/floor_marks.h"
#include "tassilo/sim/internal/lighting.h"
#include "tassilo/sim/internal/ray_world.h"
#include "tassilo/sim/internal/sensor.h"
#include "tassilo/sim/internal/stage.h"

namespace tassilo {
namespace {

using Eigen::Vector3f;

constexpr int kLanes = 8;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kLift = 1e-3F;  ///< Shadow rays start so far from surfaces. [m]
constexpr int kGrainSize = 256;
constexpr double kTuft = .012;  ///< Of the carpet. [m]

// Of cells of floor: what may darken them, and that marks are close.
constexpr std::uint16_t kSkyBit = 1, kMarkBit = 0x8000;
constexpr float kMarkReach = .1F;  ///< [m]

// Objects of a view: 0 nothing that counts, 1 ball, then goals, then robots.
constexpr int kBallObject = 1, kGoalObject = 2, kRobotObject = 16;

std::uint64_t mixed(std::uint64_t v) {  // splitmix64
  v += 0x9E3779B97F4A7C15U;
  v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27U)) * 0x94D049BB133111EBU;
  return v ^ (v >> 31U);
}

/// Directions of rays in the robot frame, eight beside each other; NaN where the camera shows nothing.
struct RayTable {
  struct alignas(32) Packet {
    float x[kLanes], y[kLanes], z[kLanes];
  };
  std::vector<Packet> packets;  ///< By rows, rows filled up.

  RayTable(const MountedCamera& camera, double column_offset, double row_offset) {
    const int width = camera.model().width, height = camera.model().height;
    for (int r = 0; r < height; ++r)
      for (int first = 0; first < width; first += kLanes) {
        Packet packet;
        for (int k = 0; k < kLanes; ++k) {
          const auto ray = first + k < width ? camera.ray({first + k + column_offset, r + row_offset}) : std::nullopt;
          packet.x[k] = ray ? static_cast<float>(ray->x) : kNone;
          packet.y[k] = ray ? static_cast<float>(ray->y) : kNone;
          packet.z[k] = ray ? static_cast<float>(ray->z) : kNone;
        }
        packets.push_back(packet);
      }
  }
};

/// Where a pixel's square is looked at; none for its centre alone. Steps of the golden ratio beside even ones: edges of
/// any direction, level and upright ones too, have about as many steps as there are places.
std::vector<PixelPoint> sub_pixels(int count) {
  std::vector<PixelPoint> places;
  if (count == 1) return places;
  double mean = 0;
  for (int k = 0; k < count; ++k) {
    places.push_back({(k + .5) / count - .5, std::fmod(.5 + k * .6180339887498949, 1) - .5});
    mean += places.back().y / count;
  }
  for (PixelPoint& place : places) place.y -= mean;
  return places;
}

/// What a step from one ray to the next is on the floor, robot frame; large where the floor is not seen. [m]
struct Footprint {
  float cx, cy, rx, ry;
  float size;   ///< [m]
  float grain;  ///< Of the carpet's contrast, what such steps resolve. [1/100]
};

std::vector<Footprint> footprints_of(const MountedCamera& camera, int rays_per_side) {
  std::vector<Footprint> footprints;
  const auto step = [&](PixelPoint a, PixelPoint b) {
    const auto p = camera.floor_point(a), q = camera.floor_point(b);
    return p && q ? (1. / rays_per_side) * (*q - *p) : FloorPoint{30, 30};
  };
  for (int r = 0; r < camera.model().height; ++r)
    for (int c = 0; c < camera.model().width; ++c) {
      const FloorPoint column = step({c - .5, double(r)}, {c + .5, double(r)}),
                       row = step({double(c), r - .5}, {double(c), r + .5});
      const double size = std::max(std::abs(column.x) + std::abs(row.x), std::abs(column.y) + std::abs(row.y));
      footprints.push_back({static_cast<float>(column.x), static_cast<float>(column.y), static_cast<float>(row.x),
                            static_cast<float>(row.y), static_cast<float>(size),
                            static_cast<float>(.01 * std::min(1., kTuft / size))});
    }
  return footprints;
}

/// Brightness of carpet by place: tufts and a coarser pattern, a tile that repeats. Mean 0; 100 is 1.
std::vector<std::int8_t> carpet_grain(std::uint64_t seed) {
  std::mt19937_64 engine(seed ^ 0xCA59E7U);
  const auto unit = [&] { return static_cast<float>(static_cast<double>(engine() >> 11U) * 0x1p-53 * 2 - 1); };
  std::vector<std::int8_t> grain(kGrainSize * kGrainSize);
  std::vector<float> coarse(32 * 32);
  for (float& v : coarse) v = unit();
  for (int r = 0; r < kGrainSize; ++r)
    for (int c = 0; c < kGrainSize; ++c) {
      const float x = static_cast<float>(c) / 8, y = static_cast<float>(r) / 8;
      const int cx = c / 8, cy = r / 8;
      const float fx = x - static_cast<float>(cx), fy = y - static_cast<float>(cy);
      const auto at = [&](int i, int j) {
        return coarse[static_cast<std::size_t>((cy + j) % 32 * 32 + (cx + i) % 32)];
      };
      const float smooth =
          (at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy;
      grain[static_cast<std::size_t>(r * kGrainSize + c)] =
          static_cast<std::int8_t>(100 * (.65F * unit() + .5F * smooth));
    }
  return grain;
}

ColorClass class_named(const std::string& name, ColorClass otherwise) {
  return color_class_from(name).value_or(otherwise);
}

/// Things some time later or earlier than they were, as they move.
void move(SimState& state, double dt) {
  state.ball.at = state.ball.at + dt * FieldPoint{state.ball.vx, state.ball.vy};
  for (SimRobot& robot : state.robots) {
    const double middle = robot.theta + .5 * dt * robot.turn;
    robot.at = robot.at + dt * robot.speed * FieldPoint{std::cos(middle), std::sin(middle)};
    robot.theta += dt * robot.turn;
  }
}

}  // namespace

void RenderOptions::check() const {
  check_between("render.ambient", ambient, 0, 1);
  check_between("render.exposure", exposure, 1e-3, 1e3);
  check_between("render.shot_noise", shot_noise, 0, 1);
  check_between("render.read_noise", read_noise, 0, 1);
  check_between("render.vignetting", vignetting, 0, 1);
  check_between("render.blur_px", blur_px, 0, 8);
  check_between("render.shutter", shutter, 0, .2);
  check_between("render.sub_frames", sub_frames, 1, 64);
  check_between("render.carpet", carpet, 0, 1);
  check_between("render.clutter", clutter, 0, 1);
  check_between("render.people", people, 0, 1);
  check_between("render.rays_per_side", rays_per_side, 1, 8);
  for (const SimLamp& lamp : lamps) {
    check_between("render.lamp.x", lamp.x, -1e3, 1e3);
    check_between("render.lamp.y", lamp.y, -1e3, 1e3);
    check_between("render.lamp.z", lamp.z, .01, 1e3);
    check_between("render.lamp.intensity", lamp.intensity, 0, 1e3);
    check_between("render.lamp.temperature", lamp.temperature, 1500, 15000);
    check_between("render.lamp.radius", lamp.radius, 0, 100);
  }
  if (format != PixelFormat::yuv422p && format != PixelFormat::yuv420p)
    throw Error("render.format", "is " + std::string(to_string(format)) + ", must be yuv422p or yuv420p");
}

RenderOptions fast_rendering() {
  RenderOptions options;
  options.quality = RenderQuality::fast;
  options.rays_per_side = 1;
  return options;
}

RenderOptions plain_rendering() {
  RenderOptions options;
  options.shot_noise = options.read_noise = options.vignetting = options.blur_px = 0;
  options.carpet = options.clutter = options.people = 0;
  return options;
}

RobotLook robot_look(const SimRobot& robot, const FieldModel& field) {
  RobotLook look;
  look.body = class_named(field.robots.body, ColorClass::black);
  if (robot.team != Team::unknown && std::ranges::count(field.robots.markers, to_string(robot.team)) > 0)
    look.marker = class_named(std::string(to_string(robot.team)), ColorClass::cyan);
  const double odd = std::fmod(robot.id * .618034, 1);
  look.marker_low = (.40 + .18 * odd) * robot.height;
  look.marker_high = (.84 + .10 * odd) * robot.height;
  if (robot.id % 4 == 2) look.mast = .24 * robot.height;
  return look;
}

class Renderer::Work {
 public:
  Work(const FieldModel& field, const MountedCamera& camera, const RenderOptions& options)
      : field_(field),
        camera_(camera),
        options_(options),
        stage_(make_stage(field, {options.clutter, options.people, options.ball_colored_people, options.seed})),
        world_(stage_, options.quality == RenderQuality::full),
        lighting_(stage_, world_, options),
        marks_(field),
        sensor_(camera.model(), options),
        centers_(camera, 0, 0),
        footprints_(footprints_of(camera, options.rays_per_side)),
        grain_(carpet_grain(options.seed)) {
    for (const PixelPoint& offset : sub_pixels(options.rays_per_side * options.rays_per_side))
      tables_.emplace_back(camera, offset.x, offset.y);
    const auto pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    light_.resize(pixels, Light::Zero());
    objects_.resize(pixels);
    for (int k = 0; k < static_cast<int>(field.goals.size()); ++k)
      goals_.push_back(std::make_unique<RayWorld>(make_goal(field, k)));
    const double cell = .1;
    near_x0_ = static_cast<float>(stage_.carpet_x.low - 1);
    near_y0_ = static_cast<float>(stage_.carpet_y.low - 1);
    near_columns_ = static_cast<int>((stage_.carpet_x.high - stage_.carpet_x.low + 2) / cell) + 1;
    near_rows_ = static_cast<int>((stage_.carpet_y.high - stage_.carpet_y.low + 2) / cell) + 1;
    marked_.resize(static_cast<std::size_t>(near_columns_) * static_cast<std::size_t>(near_rows_));
    for (int r = 0; r < near_rows_; ++r)
      for (int c = 0; c < near_columns_; ++c)
        if (marks_.exact({near_x0_ + (c + .5) * cell, near_y0_ + (r + .5) * cell}) < kMarkReach + .075)
          marked_[static_cast<std::size_t>(r * near_columns_ + c)] = kMarkBit;
    hall_floor_ = Light(.09F, .088F, .085F, 0);
    green_ = paint_of(ColorClass::green);
    white_ = 1.04F * paint_of(ColorClass::white);
  }

  const RenderOptions& options() const { return options_; }

  void set_light(const std::vector<SimLamp>& lamps, double exposure) {
    RenderOptions changed = options_;
    changed.lamps = lamps;
    changed.exposure = exposure;
    changed.check();
    const bool same = lamps == options_.lamps;
    options_ = std::move(changed);
    if (same) return;
    world_.place({});
    lighting_ = Lighting(stage_, world_, options_);
  }

  Frame render(const SimState& state, int observer) {
    const int moments = options_.shutter > 0 ? options_.sub_frames : 1;
    std::fill(light_.begin(), light_.end(), Light::Zero());
    const int samples = std::max<int>(1, static_cast<int>(tables_.size()));
    const float weight = 1.F / static_cast<float>(moments * samples);
    for (int m = 0; m < moments; ++m) {
      moment_ = state;
      if (moments > 1) move(moment_, ((m + .5) / moments - .5) * options_.shutter);
      set_scene(moment_, observer);
      for (int s = 0; s < samples; ++s)
        add_light(tables_.empty() ? centers_ : tables_[static_cast<std::size_t>(s)], m * samples + s, weight);
    }
    FrameBuffer buffer = free_buffer();
    sensor_.develop(light_, mixed(options_.seed) ^ mixed(std::bit_cast<std::uint64_t>(state.t)), options_, buffer);
    buffer.frame.t = state.t;
    return buffer.frame;
  }

  const SimView& look(const SimState& state, int observer) {
    set_scene(state, observer);
    view_.width = width();
    view_.height = height();
    view_.labels.assign(objects_.size(), 0);
    view_.ball = {};
    view_.goals.assign(field_.goals.size(), {});
    view_.robots.assign(state.robots.size(), {});
    const auto visibility = [&](int object) -> SimVisibility* {
      if (object == kBallObject) return &view_.ball;
      if (object >= kRobotObject) return &view_.robots[static_cast<std::size_t>(object - kRobotObject)];
      if (object >= kGoalObject) return &view_.goals[static_cast<std::size_t>(object - kGoalObject)];
      return nullptr;
    };
    const int per_row = packets_per_row();
    for (int r = 0; r < height(); ++r)
      for (int p = 0; p < per_row; ++p) {
        const std::size_t index = static_cast<std::size_t>(r * per_row + p);
        RTCRayHit8 rays;
        const LaneMask valid = aim(centers_.packets[index], rays);
        world_.intersect(valid, rays);
        for (int k = 0; k < kLanes; ++k) {
          const int c = p * kLanes + k;
          if (c >= width()) break;
          const Seen seen = what(rays, k);
          view_.labels[static_cast<std::size_t>(r * width() + c)] = seen.label;
          if (SimVisibility* of = visibility(seen.object)) {
            ++of->visible_px;
            extend(of->box, c, r);
          }
        }
        add_silhouettes(index, p * kLanes, r);
      }
    return view_;
  }

 private:
  struct Seen {
    int object = 0;
    std::uint8_t label = 0;
  };
  enum class Kind : std::uint8_t {
    nothing,     ///< The ray leaves the world.
    lit,         ///< `light` is all that it gets.
    floor_near,  ///< What moves may darken it.
    solid,       ///< Lamps add to it.
  };
  /// What a packet's rays hit; lanes beside each other, so that loops over them become vector instructions.
  struct alignas(32) Points {
    float x[kLanes], y[kLanes], z[kLanes], nx[kLanes], ny[kLanes], nz[kLanes], gloss[kLanes];
    Light albedo[kLanes], light[kLanes];
    std::uint16_t near[kLanes];  ///< Bits of what may darken a place of the floor.
    Kind kind[kLanes];
  };

  int width() const { return camera_.model().width; }
  int height() const { return camera_.model().height; }
  int packets_per_row() const { return (width() + kLanes - 1) / kLanes; }

  void set_scene(const SimState& state, int observer) {
    const SimRobot* const self = find_robot(state, observer);
    expects(self != nullptr, "Renderer: the observer is a robot of the state");
    pose_ = pose_of(*self);
    const FieldPoint eye = pose_ * FloorPoint{camera_.mount().x, camera_.mount().y};
    eye_ = {static_cast<float>(eye.x), static_cast<float>(eye.y), static_cast<float>(camera_.mount().z)};
    cos_ = static_cast<float>(pose_.cos);
    sin_ = static_cast<float>(pose_.sin);

    parts_.clear();
    const ColorClass ball = class_named(field_.ball.color, ColorClass::red);
    parts_.push_back({.shape = MovingPart::Shape::sphere,
                      .x = static_cast<float>(state.ball.at.x),
                      .y = static_cast<float>(state.ball.at.y),
                      .z = static_cast<float>(state.ball.radius),
                      .radius = static_cast<float>(state.ball.radius),
                      .object = kBallObject,
                      .paint = paint_of(ball),
                      .label = static_cast<std::uint8_t>(ball),
                      .gloss = .5F});
    for (std::size_t k = 0; k < state.robots.size(); ++k) {
      const SimRobot& robot = state.robots[k];
      if (robot.id == observer) continue;
      add_robot(robot, kRobotObject + static_cast<int>(k));
    }
    world_.place(parts_);
    mark_near();
  }

  void add_robot(const SimRobot& robot, int object) {
    const RobotLook look = robot_look(robot, field_);
    const auto height = static_cast<float>(robot.height);
    MovingPart body{.shape = MovingPart::Shape::cylinder,
                    .x = static_cast<float>(robot.at.x),
                    .y = static_cast<float>(robot.at.y),
                    .radius = static_cast<float>(robot.radius),
                    .height = height,
                    .object = object,
                    .paint = paint_of(look.body),
                    .label = static_cast<std::uint8_t>(look.body),
                    .gloss = .02F};
    if (look.marker) {
      body.band = paint_of(*look.marker);
      body.band_label = static_cast<std::uint8_t>(*look.marker);
      body.band_low = static_cast<float>(look.marker_low) / height;
      body.band_high = static_cast<float>(look.marker_high) / height;
    }
    parts_.push_back(body);
    if (look.mast <= 0) return;
    MovingPart mast = body;
    mast.z = height;
    mast.height = .6F * static_cast<float>(look.mast);
    mast.radius = .18F * body.radius;
    mast.paint = Light(.2F, .2F, .2F, 0);
    mast.label = 0;
    mast.band_low = mast.band_high = 2;
    parts_.push_back(mast);
    mast.z += mast.height;
    mast.height = .4F * static_cast<float>(look.mast);
    mast.radius = .3F * body.radius;
    mast.paint = paint_of(ColorClass::black);
    mast.label = static_cast<std::uint8_t>(ColorClass::black);
    parts_.push_back(mast);
  }

  /// Marks the cells of floor that what moves darkens: a bit for each lamp whose shadow may lie there, and one for the
  /// sky. Lamps beyond the last bit share it.
  void mark_near() {
    near_ = marked_;
    for (const MovingPart& part : parts_) {
      const float top = part.shape == MovingPart::Shape::sphere ? part.z + part.radius : part.z + part.height;
      if (part.shape == MovingPart::Shape::sphere || part.z <= 0)
        mark(part.x, part.y, part.x, part.y, part.radius + (part.shape == MovingPart::Shape::sphere ? .4F : .8F),
             kSkyBit);
      for (std::size_t l = 0; l < lighting_.lamps().size(); ++l) {
        const Lighting::Lamp& lamp = lighting_.lamps()[l];
        const float dx = part.x - lamp.x, dy = part.y - lamp.y, off = std::sqrt(dx * dx + dy * dy);
        // The shadow's tip, and how wide half-shadows become on the way there.
        const float share =
            lamp.z > top + .05F ? std::min(top / (lamp.z - top), 4.F / std::max(off, .1F)) : 4.F / std::max(off, .1F);
        const float wide = part.radius + share * (part.radius + lamp.radius) + .02F;
        mark(part.x, part.y, part.x + share * dx, part.y + share * dy, wide, lamp_bit(l));
      }
    }
  }
  static std::uint16_t lamp_bit(std::size_t lamp) {
    return static_cast<std::uint16_t>(2U << std::min<std::size_t>(lamp, 13));
  }

  /// All cells closer than `wide` to the stretch from (x0, y0) to (x1, y1).
  void mark(float x0, float y0, float x1, float y1, float wide, std::uint16_t bit) {
    const auto cell = [](float v, int count) { return std::clamp(static_cast<int>(v * 10), 0, count - 1); };
    const float around = wide + .075F;  // half a cell's diagonal
    const int c0 = cell(std::min(x0, x1) - around - near_x0_, near_columns_),
              c1 = cell(std::max(x0, x1) + around - near_x0_, near_columns_);
    const int r0 = cell(std::min(y0, y1) - around - near_y0_, near_rows_),
              r1 = cell(std::max(y0, y1) + around - near_y0_, near_rows_);
    const float dx = x1 - x0, dy = y1 - y0, square = std::max(dx * dx + dy * dy, 1e-9F);
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) {
        const float x = near_x0_ + (static_cast<float>(c) + .5F) * .1F - x0,
                    y = near_y0_ + (static_cast<float>(r) + .5F) * .1F - y0;
        const float along = std::clamp((x * dx + y * dy) / square, 0.F, 1.F), ex = x - along * dx, ey = y - along * dy;
        if (ex * ex + ey * ey < around * around) near_[static_cast<std::size_t>(r * near_columns_ + c)] |= bit;
      }
  }
  std::uint16_t near_bits(float x, float y) const {
    const float column = (x - near_x0_) * 10, row = (y - near_y0_) * 10;
    if (!(column >= 0 && row >= 0 && column < static_cast<float>(near_columns_) &&
          row < static_cast<float>(near_rows_)))
      return 0;
    return near_[static_cast<std::size_t>(static_cast<int>(row) * near_columns_ + static_cast<int>(column))];
  }

  LaneMask aim(const RayTable::Packet& packet, RTCRayHit8& rays) const {
    LaneMask valid;
    for (int k = 0; k < kLanes; ++k) {
      rays.ray.org_x[k] = eye_.x();
      rays.ray.org_y[k] = eye_.y();
      rays.ray.org_z[k] = eye_.z();
      rays.ray.dir_x[k] = cos_ * packet.x[k] - sin_ * packet.y[k];
      rays.ray.dir_y[k] = sin_ * packet.x[k] + cos_ * packet.y[k];
      rays.ray.dir_z[k] = packet.z[k];
      rays.ray.tnear[k] = 0;
      rays.ray.tfar[k] = 1e4F;
      rays.ray.time[k] = 0;
      rays.ray.mask[k] = ~0U;
      rays.ray.flags[k] = 0;
      rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      valid.lane[k] = packet.x[k] == packet.x[k] ? -1 : 0;
    }
    return valid;
  }

  static bool hit_anything(const RTCRayHit8& rays, int k) { return rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID; }

  const MovingPart* part_hit(const RTCRayHit8& rays, int k) const {
    const unsigned instance = rays.hit.instID[0][k];
    return instance == RTC_INVALID_GEOMETRY_ID ? nullptr : &parts_[instance];
  }
  Vector3f place_hit(const RTCRayHit8& rays, int k) const {
    const float t = rays.ray.tfar[k];
    return eye_ + t * Vector3f(rays.ray.dir_x[k], rays.ray.dir_y[k], rays.ray.dir_z[k]);
  }
  static bool in_band(const MovingPart& part, float z) {
    const float share = (z - part.z) / part.height;
    return share > part.band_low && share < part.band_high;
  }
  bool on_carpet(float x, float y) const {
    return x > stage_.carpet_x.low && x < stage_.carpet_x.high && y > stage_.carpet_y.low && y < stage_.carpet_y.high;
  }

  /// The ray from the eye to a panel goes through its goal's mouth.
  bool through_mouth(const Vector3f& at, int goal) const { return through_mouth(eye_, at, goal); }
  bool through_mouth(const Vector3f& from, const Vector3f& at, int index) const {
    const FieldModel::Goal& goal = field_.goals[static_cast<std::size_t>(index)];
    const double sign = goal.side == GoalSide::plus_x ? 1 : -1;
    const double mouth = goal.side == GoalSide::plus_x ? field_x_high() : -field_x_low();
    const double before = mouth - sign * from.x(), behind = sign * at.x() - mouth;
    if (before <= 0 || behind < -1e-4) return false;
    const double share = before / (before + std::max(behind, 0.));
    const double y = from.y() + share * (at.y() - from.y()), z = from.z() + share * (at.z() - from.z());
    return std::abs(y) <= goal.width / 2 + 1e-4 && z >= 0 && z <= goal.height;
  }
  double field_x_high() const { return field_.walls ? field_.walls->x.high : field_.length / 2; }
  double field_x_low() const { return field_.walls ? field_.walls->x.low : -field_.length / 2; }

  Seen what(const RTCRayHit8& rays, int k) const {
    if (!hit_anything(rays, k)) return {};
    const Vector3f at = place_hit(rays, k);
    if (const MovingPart* part = part_hit(rays, k))
      return {part->object, in_band(*part, at.z()) ? part->band_label : part->label};
    const Surface& surface = stage_.surfaces[stage_.triangles[rays.hit.primID[k]].surface];
    if (surface.is_floor) {
      if (!on_carpet(at.x(), at.y())) return {};
      return {0,
              static_cast<std::uint8_t>(marks_.exact({at.x(), at.y()}) <= 0 ? ColorClass::white : ColorClass::green)};
    }
    if (surface.goal >= 0 && through_mouth(at, surface.goal)) return {kGoalObject + surface.goal, surface.label};
    return {0, surface.label};
  }

  static void extend(std::optional<std::array<int, 4>>& box, int c, int r) {
    if (!box) box = {c, r, c, r};
    auto& [c0, r0, c1, r1] = *box;
    c0 = std::min(c0, c);
    r0 = std::min(r0, r);
    c1 = std::max(c1, c);
    r1 = std::max(r1, r);
  }
  void add_to_silhouette(SimVisibility& of, int c, int r) const {
    ++of.silhouette_px;
    extend(of.full_box, c, r);
    of.truncated = of.truncated || c == 0 || r == 0 || c == width() - 1 || r == height() - 1;
  }

  /// Each object as if it were alone, for the packet whose first pixel is (c0, r).
  void add_silhouettes(std::size_t index, int c0, int r) {
    const RayTable::Packet& packet = centers_.packets[index];
    std::array<int, kLanes> owner{};  // of lanes that this robot's parts have met already
    for (const MovingPart& part : parts_) {
      RTCRayHit8 rays;
      const LaneMask valid = aim(packet, rays);
      // Far from its bounding sphere no ray meets it.
      const float half = part.shape == MovingPart::Shape::sphere ? 0 : .5F * part.height;
      const Vector3f to = Vector3f(part.x, part.y, part.z + half) - eye_;
      const float around = std::hypot(part.radius, half) * 1.01F;
      bool close = false;
      for (int k = 0; k < kLanes && !close; ++k) {
        const float along = to.x() * rays.ray.dir_x[k] + to.y() * rays.ray.dir_y[k] + to.z() * rays.ray.dir_z[k];
        close = along > 0 && to.squaredNorm() - along * along <= around * around;
      }
      if (!close) continue;
      world_.intersect_part(valid, part, rays);
      SimVisibility& of =
          part.object == kBallObject ? view_.ball : view_.robots[static_cast<std::size_t>(part.object - kRobotObject)];
      for (int k = 0; k < kLanes && c0 + k < width(); ++k) {
        int& mine = owner[static_cast<std::size_t>(k)];
        if (!hit_anything(rays, k) || mine == part.object) continue;
        mine = part.object;
        add_to_silhouette(of, c0 + k, r);
      }
    }
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      RTCRayHit8 rays;
      const LaneMask valid = aim(packet, rays);
      goals_[g]->intersect(valid, rays);
      for (int k = 0; k < kLanes && c0 + k < width(); ++k)
        if (hit_anything(rays, k) && through_mouth(place_hit(rays, k), static_cast<int>(g)))
          add_to_silhouette(view_.goals[g], c0 + k, r);
    }
  }

  void add_light(const RayTable& table, int sample, float weight) {
    const int per_row = packets_per_row();
    RTCRayHit8 rays;
    Points points;
    std::fill(points.x, points.gloss + kLanes, 0.F);
    for (int r = 0; r < height(); ++r)
      for (int p = 0; p < per_row; ++p) {
        const LaneMask valid = aim(table.packets[static_cast<std::size_t>(r * per_row + p)], rays);
        world_.intersect(valid, rays);
        const int lanes = std::min(kLanes, width() - p * kLanes);
        const std::size_t first = static_cast<std::size_t>(r * width() + p * kLanes);
        bool by_lamps = false;
        for (int k = 0; k < kLanes; ++k) {
          points.kind[k] = Kind::nothing;
          if (k >= lanes || !hit_anything(rays, k)) continue;
          set_point(rays, k, first + static_cast<std::size_t>(k), points);
          by_lamps = by_lamps || points.kind[k] > Kind::lit;
        }
        if (by_lamps && !options_.flat) add_lamps(points, first, sample);
        for (int k = 0; k < lanes; ++k) {
          if (points.kind[k] == Kind::nothing) continue;
          Light& pixel = light_[first + static_cast<std::size_t>(k)];
          pixel +=
              options_.flat ? Light(weight * points.albedo[k]) : Light(weight * points.albedo[k] * points.light[k]);
        }
      }
  }

  void set_point(const RTCRayHit8& rays, int k, std::size_t pixel, Points& points) const {
    const Vector3f at = place_hit(rays, k);
    points.x[k] = at.x();
    points.y[k] = at.y();
    points.z[k] = at.z();
    points.gloss[k] = 0;
    const auto set_normal = [&](const Vector3f& normal) {
      points.nx[k] = normal.x();
      points.ny[k] = normal.y();
      points.nz[k] = normal.z();
    };
    if (const MovingPart* part = part_hit(rays, k)) {
      points.kind[k] = Kind::solid;
      points.gloss[k] = part->gloss;
      const float x = at.x() - part->x, y = at.y() - part->y;
      Vector3f normal(0, 0, 1);
      points.albedo[k] = part->paint;
      if (part->shape == MovingPart::Shape::sphere) {
        normal = Vector3f(x, y, at.z() - part->z) / part->radius;
      } else if (at.z() < part->z + part->height * .9999F) {
        normal = Vector3f(x, y, 0) / part->radius;
        if (in_band(*part, at.z())) points.albedo[k] = part->band;
      }
      set_normal(normal);
      // Near the floor less light comes from below: dark undersides.
      const float open = part->shape == MovingPart::Shape::sphere ? std::clamp(.06F + .75F * (1 + normal.z()), 0.F, 1.F)
                                                                  : std::clamp(.45F + at.z() / .35F, 0.F, 1.F);
      points.light[k] = .5F * (1 + normal.z()) * lighting_.above() + .5F * open * (1 - normal.z()) * lighting_.below();
      return;
    }
    const Stage::Triangle& triangle = stage_.triangles[rays.hit.primID[k]];
    const Surface& surface = stage_.surfaces[triangle.surface];
    if (surface.is_floor) {
      set_normal({0, 0, 1});
      set_floor(at.x(), at.y(), k, pixel, points);
      return;
    }
    const float u = rays.hit.u[k], v = rays.hit.v[k], w = 1 - u - v;
    const auto& [a, b, c] = triangle.corners;
    Vector3f normal = w * stage_.normals[a] + u * stage_.normals[b] + v * stage_.normals[c];
    const bool back = normal.dot(Vector3f(rays.ray.dir_x[k], rays.ray.dir_y[k], rays.ray.dir_z[k])) > 0;
    points.albedo[k] = surface.albedo;
    if (surface.is_outside || options_.quality == RenderQuality::fast) {
      points.light[k] =
          w * lighting_.at_corner(a, back) + u * lighting_.at_corner(b, back) + v * lighting_.at_corner(c, back);
      points.kind[k] = Kind::lit;
      return;
    }
    if (back) normal = -normal;
    set_normal(normal);
    points.light[k] = lighting_.ambient(normal);
    points.kind[k] = Kind::solid;
  }

  void set_floor(float x, float y, int k, std::size_t pixel, Points& points) const {
    points.kind[k] = Kind::lit;
    points.light[k] = lighting_.floor(x, y);
    if (!on_carpet(x, y)) {
      points.albedo[k] = hall_floor_;
      return;
    }
    const Footprint& step = footprints_[pixel];
    const float grain = step.grain * grain_at(x, y);
    points.albedo[k] = (1 + static_cast<float>(options_.carpet) * grain) * green_;

    const std::uint16_t bits = near_bits(x, y);
    points.near[k] = bits & static_cast<std::uint16_t>(~kMarkBit);
    if (points.near[k] != 0) points.kind[k] = Kind::floor_near;
    if ((bits & kMarkBit) == 0 && step.size < kMarkReach) return;
    FloorMarks::Near near = marks_.near(x, y);
    if (near.in_table) {
      if (std::abs(near.distance) < 1.6F * marks_.cell() && options_.quality == RenderQuality::full)
        near.distance = static_cast<float>(marks_.exact({x, y}));
      // Of the pixel's square, what lies within the mark: edges cross it straight.
      const float gx = cos_ * near.gx + sin_ * near.gy, gy = cos_ * near.gy - sin_ * near.gx;  // robot frame
      const float across = std::abs(gx * step.cx + gy * step.cy) + std::abs(gx * step.rx + gy * step.ry) + 1e-6F;
      if (near.distance < .5F * across) {
        const auto within = [&](float distance) { return std::clamp(.5F - distance / across, 0.F, 1.F); };
        const float covered = within(near.distance) - within(near.distance + marks_.line_width());
        if (covered > 0) points.albedo[k] += covered * (white_ - points.albedo[k]);
      }
    }
  }

  /// Of the carpet at a place: the nearest tuft's, or, where pixels may be smaller than tufts, a smooth one.
  float grain_at(float x, float y) const {
    constexpr auto tuft = static_cast<float>(1 / kTuft);
    const float column = x * tuft + 65536.F, row = y * tuft + 65536.F;
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    const auto at = [&](int i, int j) {
      return static_cast<float>(
          grain_[static_cast<std::size_t>(((r + j) & (kGrainSize - 1)) * kGrainSize + ((c + i) & (kGrainSize - 1)))]);
    };
    if (options_.quality == RenderQuality::fast) return at(0, 0);
    const float fx = column - static_cast<float>(c), fy = row - static_cast<float>(r);
    // Between tufts the contrast is lower; on average as much is given back.
    return 1.4F * ((at(0, 0) * (1 - fx) + at(1, 0) * fx) * (1 - fy) + (at(0, 1) * (1 - fx) + at(1, 1) * fx) * fy);
  }

  /// Share of the sky that what moves hides from a floor point.
  float hidden_sky(float x, float y) const {
    float hidden = 0;
    for (const MovingPart& part : parts_) {
      const float dx = x - part.x, dy = y - part.y, square = dx * dx + dy * dy;
      if (square > 1) continue;
      if (part.shape == MovingPart::Shape::sphere) {
        // The form factor of a sphere above a plane: R^2 cos / d^2 of its centre.
        const float d2 = square + part.z * part.z;
        hidden += part.radius * part.radius * part.z / (d2 * std::sqrt(d2));
      } else if (part.z <= 0) {
        const float range = std::sqrt(square), gap = std::max(range - part.radius, 0.F);
        const float wall = .5F * (1 - gap / std::sqrt(gap * gap + part.height * part.height));
        hidden += wall * std::min(1.F, 1.4F * part.radius / std::max(range, part.radius));
      }
    }
    return std::min(hidden, .95F);
  }

  /// Adds the light of lamps to solids, and takes it and the sky's from floor that things hide from them.
  void add_lamps(Points& points, std::size_t first, int sample) {
    const bool full = options_.quality == RenderQuality::full;
    LaneMask floors, solids;
    std::uint16_t near = 0;
    bool any_solid = false, any_gloss = false;
    alignas(32) float lit[kLanes], red[kLanes]{}, green[kLanes]{}, blue[kLanes]{};
    for (int k = 0; k < kLanes; ++k) {
      const Kind kind = points.kind[k];
      lit[k] = kind == Kind::solid ? 1.F : 0.F;
      floors.lane[k] = kind == Kind::floor_near ? -1 : 0;
      solids.lane[k] = kind == Kind::solid ? -1 : 0;
      if (kind == Kind::floor_near) {
        near |= points.near[k];
        if ((points.near[k] & kSkyBit) != 0)
          points.light[k] -= hidden_sky(points.x[k], points.y[k]) * lighting_.above();
      }
      any_solid = any_solid || kind == Kind::solid;
      any_gloss = any_gloss || (kind == Kind::solid && points.gloss[k] > 0);
    }
    const bool any_lit = std::any_of(lit, lit + kLanes, [](float l) { return l > 0; });
    const std::size_t spin = mixed(first) + static_cast<std::size_t>(sample);
    RTCRay8 rays;
    for (std::size_t l = 0; l < lighting_.lamps().size(); ++l) {
      const Lighting::Lamp& lamp = lighting_.lamps()[l];
      const bool shaded_floor = (near & lamp_bit(l)) != 0, shaded_solid = any_solid && full;
      if (!shaded_floor && !any_lit) continue;
      // How much of the lamp's light is added; on the floor it is there already and taken away.
      alignas(32) float share[kLanes];
      for (int k = 0; k < kLanes; ++k) {
        const float x = lamp.x - points.x[k], y = lamp.y - points.y[k], z = lamp.z - points.z[k];
        const float facing = x * points.nx[k] + y * points.ny[k] + z * points.nz[k],
                    square = x * x + y * y + z * z + 1e-6F;
        share[k] = (z > 0 ? std::max(facing, 0.F) : 0.F) / (square * std::sqrt(square));
      }
      if (shaded_floor || shaded_solid) {
        aim_at_lamp(lamp, points, spin + 67 * l, rays);
        if (shaded_floor) world_.occluded(floors, rays, false, true);
        if (shaded_solid) world_.occluded(solids, rays, true, true);
        for (int k = 0; k < kLanes; ++k) {
          const float dark = rays.tfar[k] < 0 ? 1.F : 0.F;
          share[k] *= floors.lane[k] != 0 ? -dark : lit[k] * (1 - dark);
        }
      } else {
        for (int k = 0; k < kLanes; ++k) share[k] *= lit[k];
      }
      for (int k = 0; k < kLanes; ++k) {
        red[k] += share[k] * lamp.color[0];
        green[k] += share[k] * lamp.color[1];
        blue[k] += share[k] * lamp.color[2];
      }
      if (any_gloss)
        for (int k = 0; k < kLanes; ++k)
          // Highlights have the lamp's color, not the paint's.
          if (points.gloss[k] > 0 && share[k] > 0)
            points.light[k] += highlight(points, k, lamp) * lamp.color / (points.albedo[k] + 1e-4F);
    }
    for (int k = 0; k < kLanes; ++k) {
      points.light[k] += Light(red[k], green[k], blue[k], 0);
      if (floors.lane[k] != 0) points.light[k] = points.light[k].max(.05F * lighting_.above());
    }
  }

  /// From the points to places all over the lamp, other ones for each.
  static void aim_at_lamp(const Lighting::Lamp& lamp, const Points& points, std::size_t spin, RTCRay8& rays) {
    const auto& disc = disc_points();
    for (int k = 0; k < kLanes; ++k) {
      const auto& [dx, dy] = disc[(spin + 29 * static_cast<std::size_t>(k)) & 255U];
      rays.dir_x[k] = lamp.radius * dx;
      rays.dir_y[k] = lamp.radius * dy;
    }
    for (int k = 0; k < kLanes; ++k) {
      rays.org_x[k] = points.x[k] + kLift * points.nx[k];
      rays.org_y[k] = points.y[k] + kLift * points.ny[k];
      rays.org_z[k] = points.z[k] + kLift * points.nz[k];
      rays.dir_x[k] += lamp.x - rays.org_x[k];
      rays.dir_y[k] += lamp.y - rays.org_y[k];
      rays.dir_z[k] = lamp.z - rays.org_z[k];
      rays.tnear[k] = 0;
      rays.tfar[k] = .98F;
      rays.time[k] = 0;
      rays.mask[k] = ~0U;
      rays.flags[k] = 0;
    }
  }

  /// Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977.
  float highlight(const Points& points, int k, const Lighting::Lamp& lamp) const {
    const Vector3f at(points.x[k], points.y[k], points.z[k]), to_lamp = Vector3f(lamp.x, lamp.y, lamp.z) - at;
    const Vector3f half = (to_lamp.normalized() + (eye_ - at).normalized()).normalized();
    const float facing = half.dot(Vector3f(points.nx[k], points.ny[k], points.nz[k]));
    if (facing <= .8F) return 0;
    const float f2 = facing * facing, f4 = f2 * f2, f8 = f4 * f4, f16 = f8 * f8, f32 = f16 * f16;
    return points.gloss[k] * f32 * f16 / to_lamp.squaredNorm();
  }

  FrameBuffer free_buffer() {
    for (FrameBuffer& buffer : buffers_)
      if (buffer.frame.storage.use_count() == 1) {
        std::atomic_thread_fence(std::memory_order_acquire);
        return buffer;
      }
    buffers_.push_back(make_frame_buffer(options_.format, width(), height(), options_.range));
    return buffers_.back();
  }

  FieldModel field_;
  MountedCamera camera_;
  RenderOptions options_;
  Stage stage_;
  RayWorld world_;
  Lighting lighting_;
  FloorMarks marks_;
  Sensor sensor_;
  RayTable centers_;
  std::vector<RayTable> tables_;  ///< Empty: one ray a pixel, through its centre.
  std::vector<Footprint> footprints_;
  std::vector<std::int8_t> grain_;
  std::vector<std::unique_ptr<RayWorld>> goals_;
  Light hall_floor_, green_, white_;

  SimState moment_;
  FieldFromRobot pose_;
  Vector3f eye_;
  float cos_ = 1, sin_ = 0;
  std::vector<MovingPart> parts_;
  std::vector<std::uint16_t> marked_, near_;  ///< Cells of floor, .1 m; bits of mark_near.
  int near_columns_ = 0, near_rows_ = 0;
  float near_x0_ = 0, near_y0_ = 0;
  std::vector<Light> light_;
  std::vector<int> objects_;
  SimView view_;
  std::vector<FrameBuffer> buffers_;
};

Renderer::Renderer(const FieldModel& field, const MountedCamera& camera, const RenderOptions& options) {
  options.check();
  work_ = std::make_unique<Work>(field, camera, options);
}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

const RenderOptions& Renderer::options() const { return work_->options(); }
void Renderer::set_light(const std::vector<SimLamp>& lamps, double exposure) { work_->set_light(lamps, exposure); }
Frame Renderer::render(const SimState& state, int observer) { return work_->render(state, observer); }
const SimView& Renderer::look(const SimState& state, int observer) { return work_->look(state, observer); }

}  // namespace tassilo
