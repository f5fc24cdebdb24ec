#include "relations.hpp"

#include <algorithm>

namespace muster {

Relations::Relations(const Problem& problem) : problem_(problem) {
  std::size_t most = 1;
  for (int unit = 0; unit < problem.units(); ++unit) most = std::max(most, problem.tasks_of_unit(unit).size());
  excluded_.assign(most * problem.robots(), 0);
  team_size_.assign(most, -1);
  awaited_.resize(most);
}

void Relations::look_at(int unit, const Timeline& timeline, const std::vector<char>* robots) {
  if (excludes_) std::ranges::fill(excluded_, 0);
  excludes_ = awaits_any_ = false;
  const auto tasks = problem_.tasks_of_unit(unit);
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    team_size_[k] = -1;
    awaited_[k].clear();
    for (int robot = 0; robots && robot < problem_.robots(); ++robot) {
      if (!(*robots)[robot]) exclude(k, robot);
    }
    const auto members = [&](int other, auto&& each) {
      for (const int number : timeline.visits_of(problem_.unit(other))) {
        if (timeline.visit(number).place == other) each(timeline.visit(number).robot);
      }
    };
    for (const int other : problem_.other_robot(tasks[k])) {
      members(other, [&](int robot) { exclude(k, robot); });
    }
    for (const int other : problem_.same_robot(tasks[k])) {
      if (!timeline.present(problem_.unit(other))) {
        awaited_[k].push_back(other);
        awaits_any_ = true;
        continue;
      }
      std::vector<char> same(problem_.robots(), 0);
      int size = 0;
      members(other, [&](int robot) { size += same[robot] = 1; });
      keep_to(k, same, size);
    }
  }
}

void Relations::exclude(std::size_t k, int robot) {
  excluded_[k * problem_.robots() + robot] = 1;
  excludes_ = true;
}

// The members, or nobody, if those of another task are others.
void Relations::keep_to(std::size_t k, const std::vector<char>& members, int size) {
  const bool differs = team_size_[k] >= 0 && team_size_[k] != size;
  team_size_[k] = size;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (!members[robot] || differs) exclude(k, robot);
  }
}

}  // namespace muster
