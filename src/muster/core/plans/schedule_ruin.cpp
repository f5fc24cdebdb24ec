// What a step of the search takes out of the routes.
#include <algorithm>
#include <cmath>

#include "plans/ruin_string.hpp"
#include "plans/schedule_search.hpp"

namespace muster {

void ScheduleSearch::ruin() {
  removed_.clear();
  const int seed = seed_unit();
  if (random_.uniform() < at_once_share_ && roster_.present(seed)) {
    ruin_at_once(seed);
  } else {
    ruin_near(seed);
  }
  take_tied();
}

int ScheduleSearch::seed_unit() {
  const auto& absent = roster_.absent();
  if (!absent.empty() && random_.uniform() < 0.5) return absent[random_.below(static_cast<int>(absent.size()))];
  if (sees_end_ && random_.uniform() < settings_.greatest_share) {
    roster_.timeline().critical(critical_);
    if (!critical_.empty()) return critical_[random_.below(static_cast<int>(critical_.size()))];
  }
  return problem_.unit(random_.below(problem_.tasks()));
}

// Strings are taken out of the routes that pass near one unit.
void ScheduleSearch::ruin_near(int seed) {
  const Timeline& timeline = roster_.timeline();
  int used = 0, visits = 0;
  for (int robot = 0; robot < problem_.robots(); ++robot) {
    used += timeline.tasks_in(robot) > 0;
    visits += timeline.tasks_in(robot);
  }
  if (used == 0) return;
  const double longest = std::min<double>(settings_.longest_string, std::max(1.0, static_cast<double>(visits) / used));
  const double most_strings = 4.0 * settings_.removed / (1.0 + longest) - 1.0;
  const int strings = std::max(1, static_cast<int>(1.0 + random_.uniform() * most_strings));
  std::vector<int> ruined;
  const auto visit = [&](int unit) {
    if (!roster_.present(unit) || roster_.fixed(unit)) return;
    const auto members = timeline.visits_of(unit);
    const Visit& one = timeline.visit(members[random_.below(static_cast<int>(members.size()))]);
    const int robot = one.robot;
    if (ruined_[robot]) return;
    const double most = std::min<double>(longest, timeline.tasks_in(robot));
    take_string(robot, one.at, static_cast<int>(1.0 + random_.uniform() * most));
    ruined_[robot] = 1;
    ruined.push_back(robot);
  };
  visit(seed);
  for (const int task : neighbours_.of(problem_.tasks_of_unit(seed).front())) {
    if (static_cast<int>(ruined.size()) >= strings) break;
    visit(problem_.unit(task));
  }
  for (const int robot : ruined) ruined_[robot] = 0;
}

// Units that begin at about the same time, near ones first.
void ScheduleSearch::ruin_at_once(int seed) {
  const Timeline& timeline = roster_.timeline();
  const int count = 1 + random_.below(std::max(1, static_cast<int>(2.0 * settings_.removed) - 1));
  const double begin = timeline.begin_of(seed);
  nearest_.clear();
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (!roster_.present(unit) || roster_.fixed(unit)) continue;
    nearest_.emplace_back(std::abs(timeline.begin_of(unit) - begin) * (0.5 + random_.uniform()), unit);
  }
  const std::size_t kept = std::min<std::size_t>(count, nearest_.size());
  std::ranges::partial_sort(nearest_, nearest_.begin() + static_cast<std::ptrdiff_t>(kept));
  for (std::size_t k = 0; k < kept; ++k) take(nearest_[k].second);
}

void ScheduleSearch::take_string(int robot, int at, int length) {
  const Timeline& timeline = roster_.timeline();
  std::vector<int> units;
  string_around(at, length, problem_.fixed(robot) + 1, timeline.tasks_in(robot) + 1, random_,
                [&](int k) { units.push_back(timeline.stop(robot, k).unit); });
  for (const int unit : units) take(unit);
}

void ScheduleSearch::take(int unit) {
  const auto whole = problem_.inseparable(unit);
  if (!roster_.present(unit) || roster_.fixed(unit)) return;
  if (std::ranges::any_of(whole, [&](int other) { return roster_.fixed(other); })) return;
  roster_.remove(unit);
  removed_.push_back(unit);
  for (const int other : whole) {
    if (other != unit) removed_.push_back(other);
  }
}

// Tasks that must have the same robots can change them only together.
void ScheduleSearch::take_tied() {
  for (std::size_t k = 0; k < removed_.size(); ++k) {
    for (const int task : problem_.tasks_of_unit(removed_[k])) {
      for (const int other : problem_.same_crew(task)) {
        if (roster_.present(problem_.unit(other))) take(problem_.unit(other));
      }
    }
  }
}

}  // namespace muster
