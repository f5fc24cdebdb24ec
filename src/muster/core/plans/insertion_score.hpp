// What the objective grows by when a unit of work is put into routes.
#pragma once

#include <algorithm>

#include "plans/problem.hpp"
#include "plans/timeline.hpp"

namespace muster {

// A robot that could do a task between two stops of its route.
struct Offer {
  int robot = -1;
  int at = 0;              // the place: after so many tasks
  double arrive = 0.0;     // at the task
  double work = 0.0;       // if it did the task alone
  double out = 0.0;        // the time from the task to the next stop
  double latest = kNever;  // end of the task for which the next stop is still in time
  double onward = 0.0;     // the time from the end of the task to the end of all that waits for the next stop
  double direct = 0.0;     // the time from the stop before to the next, without the task
  double next = kNever;    // when the next stop begins now; never: there is none
  double in = 0.0;         // the time to the task
  double growth = 0.0;     // of usage
  double usage = 0.0;      // before the growth
  double late = 0.0;       // of objective `average`: what later arrivals add up to, and this one
};

// Sums over the members of a team; then `value`.
class InsertionScore {
 public:
  // Weight of the routes' own growth where the objective does not see it; and where it is when the mission ends, of the
  // robots' time.
  static constexpr double kTie = 1e-2;
  static constexpr double kTaken = 0.1;

  InsertionScore(Objective objective, double peak) : objective_(objective), peak_(peak) {}

  // `growth`: of the robot's usage.
  void add(const Offer& offer, double begin, double work, double growth) {
    growth_ += growth;
    over_ = std::max(over_, offer.usage + growth - peak_);
    late_ += offer.late;
    // Robot time that the task takes up: the ways, the work and the waiting for the team.
    taken_ += offer.in + offer.out - offer.direct + work + (begin - offer.arrive) * kWaiting;
    through_ = std::max(through_, work + offer.onward);
  }

  // `tail`: the time from the begin to the end of all that waits for the unit's end, routes aside; `lateness`: what it
  // adds to the objective of that name.
  double value(double begin, double tail, double lateness) const {
    switch (objective_) {
      case Objective::total:
        return growth_;
      case Objective::max:
        return kTie * growth_ + std::max(0.0, over_);
      case Objective::total_max:
        return growth_ + std::max(0.0, over_);
      case Objective::average:
        return late_;
      case Objective::makespan:
        return kTaken * taken_ + std::max(0.0, begin + std::max(tail, through_) - peak_);
      case Objective::lateness:
        return kTie * growth_ + lateness;
    }
    return growth_;
  }
  double growth() const { return growth_; }

 private:
  static constexpr double kWaiting = 0.3;  // weight of the time for which a robot waits for others

  Objective objective_;
  double peak_;
  double growth_ = 0.0, over_ = -kNever, late_ = 0.0, taken_ = 0.0, through_ = 0.0;
};

}  // namespace muster
