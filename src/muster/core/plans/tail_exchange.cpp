#include "plans/tail_exchange.hpp"

namespace muster {

// The task is followed by one that is near, or follows it.
bool TailExchange::improve(int task) {
  for (const int near : around_.near(task)) {
    if (!team_.present(near)) continue;
    const int robot = team_.robot_of(task), other = team_.robot_of(near);
    if (other == robot || !problem_.alike(robot, other)) continue;
    if (exchange(task, team_.prev(near)) || exchange(near, team_.prev(task))) return true;
  }
  return false;
}

// What follows `place` goes behind `other`, and the reverse.
bool TailExchange::exchange(int place, int other) {
  if (!around_.open(place) || !around_.open(other)) return false;
  const int robot = team_.robot_of(place), others = team_.robot_of(other);
  const int first = team_.next(place), first_other = team_.next(other);
  const int end = problem_.end(robot), end_other = problem_.end(others);
  const int last = team_.prev(end), last_other = team_.prev(end_other);
  team_.measure(robot);
  team_.measure(others);
  // From the first task of the tail to the last, both included.
  const double tail = first == end ? 0.0 : team_.leaving(last) - team_.leaving(place) - team_.way(first);
  const double tail_other =
      first_other == end_other ? 0.0 : team_.leaving(last_other) - team_.leaving(other) - team_.way(first_other);
  const auto usage = [&](int whose, int before, int begin, double length, int final) {
    return team_.leaving(before) + way(whose, before, begin) + length + way(whose, final, problem_.end(whose));
  };
  const double here = first_other == end_other ? team_.leaving(place) + way(robot, place, end)
                                               : usage(robot, place, first_other, tail_other, last_other);
  const double there =
      first == end ? team_.leaving(other) + way(others, other, end_other) : usage(others, other, first, tail, last);
  const double growth = here - team_.usage(robot), growth_other = there - team_.usage(others);
  if (!around_.gains(around_.cost.change(robot, growth, others, growth_other))) return false;
  if (!around_.fits(robot, growth) || !around_.fits(others, growth_other)) return false;
  if (first_other != end_other) team_.move(first_other, last_other, place);
  if (first != end) team_.move(first, last, other);
  return around_.changed(place, other, first, first_other, last, last_other);
}

}  // namespace muster
