// Ways for all robots that share a roadmap: one robot after the other, or all at once where some find no way so, then
// better by planning few of them anew, again and again, among all others [li2021].
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "random.hpp"
#include "traffic/planning_budget.hpp"
#include "traffic/safe_intervals.hpp"

namespace muster {

struct Paths {
  std::vector<TimedMove> moves;  // by start
  // When each has held at its last stop. Infinite where no path was found; NaN where there is none past those who never
  // leave, to none of its stops.
  std::vector<double> ends;
};

class SharedWays {
 public:
  struct Effort {
    int ways;              // that are sought to improve the first ones; more where some have found none
    int expansions;        // of a search for moves of all at once that come no nearer to the stops, before it ends
    bool at_once = false;  // whether no ways are sought one after the other at first
    // First ways are sought in any case; when it is spent they are not improved any more.
    PlanningBudget budget{};
  };

  // The first ways are sought one after the other; where some find none, all go at once and make way for each other.
  SharedWays(SafeIntervals& roadmap, std::vector<Traveller> travellers, std::vector<int> order, const Effort& effort,
             std::uint64_t seed);

  // Travellers, by number, do something else: their ways are sought among those of all others, and so many more ways.
  void change(const std::vector<std::pair<int, Traveller>>& changes, int ways);
  // Takes the last change back.
  void undo() { now_ = before_; }

  const SafeIntervals& roadmap() const { return roadmap_; }
  std::span<const Traveller> travellers() const { return now_.travellers; }
  Paths paths() const;
  // Of each, were it alone with those who never leave.
  Paths paths_alone() const;
  // In which they were planned.
  const std::vector<int>& order() const { return now_.order; }
  // Of searches for ways and for moves of all at once, so far.
  std::int64_t expansions() const { return expansions_; }

 private:
  using Cost = std::pair<int, double>;  // travellers without a way; seconds

  struct State {
    std::vector<Traveller> travellers;  // with the stops that each can get to
    std::vector<int> order;             // in which they were planned
    std::vector<int> free;              // who may go at all
    std::vector<char> cut_off;          // whether no way leads to any stop of each
    std::vector<Way> alone;             // of each, were it alone with those who never leave
    std::vector<Way> ways;
    bool all_rest = false;        // whether each has a place to rest at in the end: then none may lose it
    double tails_to_leave = 0.0;  // see `SafeIntervals::reserve_start`
  };

  Paths paths(const std::vector<Way>& ways) const;
  Cost cost() const;
  // Who never leaves is on the roadmap, and nobody else.
  void clear();
  // And all others but some.
  void put_on_all_but(std::span<const int> group);
  void plan_all();
  void take_turns(int expansions);
  void find_alone(int traveller);
  void plan(std::span<const int> group);
  void improve(int ways);
  // Keeps what is better, or worse by less than this share.
  void replan(const std::vector<int>& group, double worse);
  void move_back(const std::vector<int>& group);  // in the order
  // Travellers that are planned anew together: one that is late, or has no way, and others that it meets.
  std::vector<int> neighbours();
  int late();
  Way way(int traveller);
  void spend(std::int64_t expansions);

  SafeIntervals& roadmap_;
  State now_, before_;
  Random random_;
  PlanningBudget budget_;
  std::int64_t expansions_ = 0;
};

}  // namespace muster
