#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "tassilo/geometry/point.h"

namespace tassilo {

enum class Role { goalkeeper, defender, striker };
std::string_view to_string(Role role);

/// What is known of one robot of the team, oneself or another, when roles are given.
struct Candidate {
  int id = 0;
  bool is_goalkeeper = false;         ///< For the whole match.
  std::optional<FieldPoint> at = {};  ///< Missing: it does not know where it is.
  std::optional<Role> role_before;    ///< Missing: none yet.
};

/// A role, and the how many-th of all that have it.
struct Assignment {
  Role role = Role::defender;
  int rank = 0;
  friend bool operator==(const Assignment&, const Assignment&) = default;
};

struct RoleOptions {
  double wrong_side = 0.8;  ///< A way around the ball costs so much more. [m], >= 0
  double keep = 0.6;        ///< The striker stays one until another one is nearer by so much. [m], >= 0
  void check() const;       ///< Throws Error naming the first field out of range.
};

/// The role of one robot of the team. Goalkeepers stay it; of the others the striker is who has the shortest way to the
/// ball, from the side of the own goal; all others defend, ranked by id. Each robot reckons it for itself: with the
/// same knowledge all get the same.
///
/// id         of one in the team
/// team       in any order; the result does not depend on it
/// ball       missing: the striker stays who it is, else it is the first by id
/// own_goal   the middle of its mouth
Assignment assign_role(int id, std::span<const Candidate> team, std::optional<FieldPoint> ball, FieldPoint own_goal,
                       const RoleOptions& options = {});

}  // namespace tassilo
