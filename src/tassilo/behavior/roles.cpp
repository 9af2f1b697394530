#include "tassilo/behavior/roles.h"

#include <algorithm>
#include <tuple>

#include "tassilo/base/contract.h"
#include "tassilo/base/option_check.h"

namespace tassilo {

std::string_view to_string(Role role) {
  switch (role) {
    case Role::goalkeeper:
      return "goalkeeper";
    case Role::defender:
      return "defender";
    case Role::striker:
      return "striker";
  }
  return "";
}

void RoleOptions::check() const {
  check_at_least("roles.wrong_side", wrong_side, 0);
  check_at_least("roles.keep", keep, 0);
}

Assignment assign_role(int id, std::span<const Candidate> team, std::optional<FieldPoint> ball, FieldPoint own_goal,
                       const RoleOptions& options) {
  const auto me = std::ranges::find(team, id, &Candidate::id);
  expects(me != team.end(), "assign_role: of one in the team");
  const auto before_me = [&](auto counts) {
    return static_cast<int>(std::ranges::count_if(team, [&](const Candidate& c) { return c.id < id && counts(c); }));
  };
  if (me->is_goalkeeper) return {Role::goalkeeper, before_me([](const Candidate& c) { return c.is_goalkeeper; })};

  // Who does not know where it is comes last; then by way, then by id.
  const auto cost = [&](const Candidate& c) {
    const double kept = c.role_before == Role::striker ? options.keep : 0;
    if (!ball) return std::tuple(false, -kept, c.id);
    if (!c.at) return std::tuple(true, -kept, c.id);
    const bool is_wrong_side = distance(*c.at, own_goal) > distance(*ball, own_goal);
    return std::tuple(false, distance(*c.at, *ball) + (is_wrong_side ? options.wrong_side : 0) - kept, c.id);
  };
  const Candidate* striker = nullptr;
  for (const Candidate& c : team)
    if (!c.is_goalkeeper && (striker == nullptr || cost(c) < cost(*striker))) striker = &c;
  if (striker->id == id) return {Role::striker, 0};
  return {Role::defender, before_me([&](const Candidate& c) { return !c.is_goalkeeper && c.id != striker->id; })};
}

}  // namespace tassilo
