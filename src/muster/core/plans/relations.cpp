#include "plans/relations.hpp"

#include <algorithm>

namespace muster {

Relations::Relations(const Roster& roster) : roster_(roster), problem_(roster.problem()) {
  std::size_t most = 1;
  for (int unit = 0; unit < problem_.units(); ++unit) most = std::max(most, problem_.tasks_of_unit(unit).size());
  excluded_.assign(most * problem_.robots(), 0);
  team_size_.assign(most, -1);
  awaited_.resize(most);
}

void Relations::look_at(int unit, const std::vector<char>* robots) {
  if (excludes_) std::ranges::fill(excluded_, 0);
  excludes_ = awaits_any_ = false;
  const auto tasks = problem_.tasks_of_unit(unit);
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    team_size_[k] = -1;
    awaited_[k].clear();
    for (int robot = 0; robots && robot < problem_.robots(); ++robot) {
      if (!(*robots)[robot]) exclude(k, robot);
    }
    for (const int other : problem_.apart(tasks[k])) {
      for (const int robot : roster_.team_of(other)) exclude(k, robot);
    }
    for (const int other : problem_.same_crew(tasks[k])) {
      if (roster_.present(problem_.unit(other))) {
        keep_to(k, roster_.team_of(other));
      } else {
        awaited_[k].push_back(other);
        awaits_any_ = true;
      }
    }
  }
}

void Relations::exclude(std::size_t k, int robot) {
  excluded_[k * problem_.robots() + robot] = 1;
  excludes_ = true;
}

// The team of another task, or nobody, if that of a further one has another size.
void Relations::keep_to(std::size_t k, const std::vector<int>& team) {
  const int size = static_cast<int>(team.size());
  const bool differs = team_size_[k] >= 0 && team_size_[k] != size;
  team_size_[k] = size;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    if (differs || !std::ranges::binary_search(team, robot)) exclude(k, robot);
  }
}

}  // namespace muster
