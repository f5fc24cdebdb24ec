// Ways for all robots that share a roadmap: one robot after the other, then better by planning few of them anew, again
// and again, among all others [li2021].
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "random.hpp"
#include "safe_intervals.hpp"

namespace muster {

struct Paths {
  std::vector<TimedMove> moves;  // by start
  // When each has held at its last stop. Infinite where no path was found; NaN where there is none past those who never
  // leave, to none of its stops.
  std::vector<double> ends;
  std::vector<int> order;  // in which they were planned
};

class SharedWays {
 public:
  SharedWays(SafeIntervals& roadmap, std::vector<Traveller> travellers, std::vector<int> order, std::uint64_t seed);

  // Goes on while others delay somebody, until so many ways have been sought for each traveller; `lost` as many where
  // some find none.
  void improve(int tries, int lost);

  Paths paths() const;

 private:
  using Cost = std::pair<int, double>;  // travellers without a way; seconds

  Cost cost() const;
  Way alone(Traveller& who) const;
  void plan(std::span<const int> group);
  void replan(const std::vector<int>& group);
  // Travellers that are planned anew together: one that is late, or has no way, and others that it meets.
  std::vector<int> neighbours();
  int late();

  SafeIntervals& roadmap_;
  std::vector<Traveller> travellers_;  // with the stops that each can get to
  std::vector<int> order_;             // in which they were planned
  std::vector<int> free_;              // who may go at all
  std::vector<char> cut_off_;          // whether no way leads to any stop of each
  std::vector<Way> alone_;             // of each, were it alone with those who never leave
  std::vector<Way> ways_;
  Random random_;
};

}  // namespace muster
