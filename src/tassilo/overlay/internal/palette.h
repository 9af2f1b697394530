#pragma once

#include <array>

#include "tassilo/scene/scene.h"

namespace tassilo {

/// Color of the overlay's graphics. 0..1, not premultiplied
struct Ink {
  double r = 0, g = 0, b = 0, a = 1;

  Ink with_alpha(double alpha) const { return {r, g, b, alpha}; }
};

/// From 0xRRGGBB.
constexpr Ink ink(unsigned rgb, double alpha = 1) {
  return {(rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, alpha};
}

inline constexpr Ink kBallInk = ink(0xff8a1f);
inline constexpr Ink kLineInk = ink(0xf8fafc);
inline constexpr Ink kBoundaryInk = ink(0xb794f6);
inline constexpr Ink kFreeInk = ink(0x34d399);
inline constexpr Ink kBlockedInk = ink(0xff4d5e);
inline constexpr Ink kUnseenInk = ink(0x64748b);
inline constexpr Ink kPanelInk = ink(0x0f141c);
inline constexpr Ink kGridInk = ink(0x475569);
inline constexpr Ink kTextInk = ink(0xf1f5f9);
inline constexpr Ink kQuietTextInk = ink(0x94a3b8);
inline constexpr Ink kHaloInk = ink(0x05070a);

inline Ink goal_ink(GoalColor color) { return color == GoalColor::yellow ? ink(0xffd60a) : ink(0x4b8dff); }

inline Ink team_ink(Team team) {
  switch (team) {
    case Team::cyan:
      return ink(0x22d3ee);
    case Team::magenta:
      return ink(0xff5fd2);
    case Team::unknown:
      break;
  }
  return ink(0xcbd5e1);
}

inline Ink track_ink(const TrackSeen& track) {
  const Ink color = track.kind == TrackKind::ball ? kBallInk : team_ink(track.team);
  return color.with_alpha(track.age > 0 ? .65 : 1);
}

/// Arrows reach as far as an object comes in this time. [s]
inline constexpr double kArrowTime = .5;

inline Ink line_ink(LineKind kind) { return kind == LineKind::line ? kLineInk : kBoundaryInk; }

/// Of label maps, by label 0..8; no_color is not drawn.
inline constexpr std::array<Ink, 9> kLabelInks{Ink{0, 0, 0, 0}, ink(0x111827), ink(0xffffff),
                                               ink(0x22c55e),   ink(0x2563eb), ink(0x22d3ee),
                                               ink(0xe879f9),   ink(0xef4444), ink(0xfacc15)};

}  // namespace tassilo
