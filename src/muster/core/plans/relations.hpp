// Who may do the tasks of a unit, as far as its relations to the tasks of the plan tell.
#pragma once

#include <span>
#include <vector>

#include "plans/roster.hpp"

namespace muster {

class Relations {
 public:
  explicit Relations(const Roster& roster);

  // Looks at a unit. `robots`: by robot, whether it may be a member; none: all.
  void look_at(int unit, const std::vector<char>* robots);

  // Of the unit's task number k.
  bool allows(int k, int robot) const { return !excluded_[k * problem_.robots() + robot]; }
  // How many robots do it: those of a task in the plan, which have to be the same; -1: it has no such task.
  int team_size(int k) const { return team_size_[k]; }
  // The tasks that its robots have to do too and that are not in the plan.
  std::span<const int> awaited(int k) const { return awaited_[k]; }
  bool awaits_any() const { return awaits_any_; }

 private:
  void exclude(std::size_t k, int robot);
  void keep_to(std::size_t k, const std::vector<int>& team);

  const Roster& roster_;
  const Problem& problem_;
  std::vector<char> excluded_;  // tasks of the unit x robots
  bool excludes_ = false, awaits_any_ = false;
  std::vector<int> team_size_;
  std::vector<std::vector<int>> awaited_;
};

}  // namespace muster
