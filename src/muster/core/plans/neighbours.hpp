// Which tasks are near to a task, and which robots start near to it.
#pragma once

#include <span>
#include <vector>

#include "plans/problem.hpp"

namespace muster {

class Neighbours {
 public:
  // At most so many of each, the nearest first. Nearness is the shorter of both ways in the shortest travel class.
  Neighbours(const Problem& problem, int tasks, int robots);

  std::span<const int> of(int task) const { return tasks_[task]; }
  std::span<const int> robots(int task) const { return robots_[task]; }

 private:
  double distance(const Problem& problem, int a, int b) const;
  void by_comparison(const Problem& problem, int count);
  void by_grid(const Problem& problem, int count);

  Rows tasks_;
  Rows robots_;
};

}  // namespace muster
