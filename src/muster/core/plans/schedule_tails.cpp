// Steps of the search that exchange what two robots do last, as 2-opt* does [potvin1995].
#include <algorithm>
#include <functional>

#include "plans/schedule_search.hpp"

namespace muster {

namespace {

constexpr int kNearTails = 30;  // tasks that may follow a task instead of the one that does

}  // namespace

// Behind a task goes one that is near to it and in another route, with all that follows; what follows the first goes
// where that was. False: no such pair is in time at its new ways, or costs less than `most`.
bool ScheduleSearch::find_tails(double most) {
  const Timeline& timeline = roster_.timeline();
  const auto only_visit = [&](int task) -> const Visit* {
    const auto visits = timeline.visits_of(problem_.unit(task));
    return visits.size() == 1 ? &timeline.visit(visits.front()) : nullptr;
  };
  const int task = random_.below(problem_.tasks());
  const Visit* visit = only_visit(task);
  if (!visit) return false;
  tail_robot_ = visit->robot;
  tail_at_ = visit->at;
  if (tail_at_ < problem_.fixed(tail_robot_)) return false;
  const auto near = neighbours_.of(task);
  const int count = std::min<int>(kNearTails, static_cast<int>(near.size()));
  for (int k = 0; k < count; ++k) {
    const Visit* next = only_visit(near[k]);
    if (!next) continue;
    second_robot_ = next->robot;
    second_at_ = next->at - 1;
    if (second_robot_ == tail_robot_ || second_at_ < problem_.fixed(second_robot_)) continue;
    if (!joins(tail_robot_, tail_at_, second_robot_, second_at_) ||
        !joins(second_robot_, second_at_, tail_robot_, tail_at_))
      continue;
    if (sums_ways_ && current_ + scale_ * growth_of_tails() >= most) continue;
    if (is_tail(tail_robot_, tail_at_, second_robot_) && is_tail(second_robot_, second_at_, tail_robot_)) return true;
  }
  return false;
}

// Whether a robot, after so many tasks, can be in time at what another does after so many.
bool ScheduleSearch::joins(int robot, int at, int other, int other_at) const {
  const Visit &last = roster_.timeline().stop(robot, at), &next = roster_.timeline().stop(other, other_at + 1);
  if (next.unit < 0) return true;
  return roster_.timeline().in_time(last.leave + problem_.travel_time(robot, last.place, next.place), next.latest);
}

// By how much the ways of both robots grow, calls at stations aside.
double ScheduleSearch::growth_of_tails() const {
  const auto way = [&](int robot, int at, int other, int other_at) {
    const Visit &last = roster_.timeline().stop(robot, at), &next = roster_.timeline().stop(other, other_at + 1);
    return next.unit < 0 ? problem_.end_usage(robot, last.place) : problem_.travel_usage(robot, last.place, next.place);
  };
  return way(tail_robot_, tail_at_, second_robot_, second_at_) + way(second_robot_, second_at_, tail_robot_, tail_at_) -
         way(tail_robot_, tail_at_, tail_robot_, tail_at_) - way(second_robot_, second_at_, second_robot_, second_at_);
}

// Whether the other robot can do all that a robot does after so many tasks, and needs nothing for it from before.
bool ScheduleSearch::is_tail(int robot, int at, int other) const {
  const Timeline& timeline = roster_.timeline();
  for (int k = at + 1; k <= timeline.tasks_in(robot); ++k) {
    const Visit& visit = timeline.stop(robot, k);
    if (problem_.tasks_of_unit(visit.unit).size() != 1 || timeline.visits_of(visit.unit).size() != 1) return false;
    if (!problem_.allowed(other, visit.place) || !problem_.same_crew(visit.place).empty() ||
        !problem_.apart(visit.place).empty() || !does_alone(other, visit.place))
      return false;
    const auto in_tail = [&](int unit) {
      return std::ranges::all_of(timeline.visits_of(unit), [&](int number) {
        return timeline.visit(number).robot == robot && timeline.visit(number).at > at;
      });
    };
    if (!std::ranges::all_of(problem_.inseparable(visit.unit), in_tail)) return false;
  }
  return true;
}

// Whether a robot has all the abilities that a task needs, as the one that does it now has.
bool ScheduleSearch::does_alone(int robot, int task) const {
  return std::ranges::equal(problem_.ability(robot), problem_.needs(task), std::ranges::greater_equal{});
}

bool ScheduleSearch::exchange_tails() {
  take_tail(tail_robot_, tail_at_, tail_);
  take_tail(second_robot_, second_at_, second_tail_);
  if (!roster_.settle()) return false;
  const auto append = [&](const std::vector<int>& units, int robot) {
    return std::ranges::all_of(units, [&](int unit) { return roster_.append(unit, robot); });
  };
  return append(second_tail_, tail_robot_) && append(tail_, second_robot_) && roster_.settle_begins();
}

void ScheduleSearch::take_tail(int robot, int at, std::vector<int>& units) {
  const Timeline& timeline = roster_.timeline();
  units.clear();
  for (int k = at + 1; k <= timeline.tasks_in(robot); ++k) units.push_back(timeline.stop(robot, k).unit);
  for (const int unit : units) {
    if (roster_.present(unit)) roster_.remove(unit);  // not, where it went with its partner
  }
}

}  // namespace muster
