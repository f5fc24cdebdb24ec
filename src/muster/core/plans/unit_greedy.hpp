// Greedy allocation of units of work ([tcf-thesis], Algorithm 1 with units in place of tasks).
#pragma once

#include <memory>
#include <queue>
#include <vector>

#include "plans/neighbours.hpp"
#include "plans/roster.hpp"

namespace muster {

// Each step appends the unit whose team has the least debit: what its members pay together, and the greatest usage
// among them (3.17); with the objectives `makespan` and `lateness`, what the objective grows by.
//
// What a unit costs is kept from step to step. A `thorough` allocation evaluates every unit again whose cost a step may
// have changed, so that it chooses as if all were evaluated at each step. Else a step evaluates what is near the tasks
// that it placed, and the cheapest unit again before it is placed; all units are evaluated now and then, and when none
// of the kept ones fits any more.
class UnitGreedy {
 public:
  // `robots`: the only ones that tasks are given to. The roster's routes are those to go on from.
  UnitGreedy(Roster& roster, const std::vector<int>& robots, bool thorough);
  ~UnitGreedy();

  // Puts one unit into routes. False: none fits.
  bool append_one();

 private:
  // The best insertion of a unit when it was last evaluated. Units that are inseparable have one: that of the first.
  struct Kept {
    UnitInsertion insertion;
    bool found = false;
    int evaluation = 0;  // its number
    int step = -1;       // in which all that it depends on was looked at
  };
  struct Entry {
    double debit;
    int unit, evaluation;
    bool operator<(const Entry& other) const {  // the first of a queue has the least debit
      return debit != other.debit ? debit > other.debit : unit > other.unit;
    }
  };

  int first_of(int unit) const;
  bool is_plain(int unit) const;
  void await(int unit);
  void forget_settled();

  void evaluate(int unit, bool everywhere);
  void evaluate_changed(int unit);
  void keep(int unit, const UnitInsertion& insertion);
  double debit(const UnitInsertion& insertion) const;
  bool evaluate_all_again();

  void step_done(const std::vector<int>& placed);
  void mark_changes();
  void add_empty_twins();
  void evaluate_changed_units();
  void evaluate_near(const std::vector<int>& placed);
  bool depends_on_changes(int unit) const;
  bool uses_changed_robot(const UnitInsertion& insertion) const;

  Roster& roster_;
  const Problem& problem_;
  const bool thorough_;
  const bool sees_peak_;
  Trial everywhere_, near_, changed_;
  std::unique_ptr<Neighbours> neighbours_;
  std::vector<char> robots_, changed_robots_;  // by robot
  std::vector<int> ready_;                     // units that no other waits for, the first of those that are inseparable
  std::vector<char> listed_, plain_;           // by unit
  std::vector<Kept> kept_;                     // by unit
  std::priority_queue<Entry> queue_;
  std::vector<Entry> refused_;  // in this step
  int step_ = 0, evaluations_ = 0;
  int exhausted_ = -1;  // the step in which no unit was found to fit anywhere
  std::size_t steps_since_all_ = 0;
  // Of the last step.
  bool all_changed_ = false;
  double peak_ = 0.0;
  int relabelings_ = 0;
  std::vector<char> changed_units_;
  std::vector<int> marked_units_;
  bool any_changed_ = false;
};

}  // namespace muster
