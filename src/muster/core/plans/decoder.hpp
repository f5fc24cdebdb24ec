// Plans from what metaheuristics vary: an order of tasks, and for each task the robot that it is meant for.
#pragma once

#include <span>
#include <vector>

#include "plans/draft.hpp"
#include "plans/growing_routes.hpp"

namespace muster {

// Both ways repair what rules forbid: a task waits until its prerequisites are in routes; one that its robot may not
// do, or has no capacity for, goes to the robot for which it is cheapest at the end of its route; one that fits nowhere
// is left out, and what depends on it.
class Decoder {
 public:
  explicit Decoder(const Problem& problem);

  // Each robot does its tasks in this order and waits where it must; `robots` is by task.
  void in_order(std::span<const int> tasks, std::span<const int> robots, Draft& draft);
  // Each robot in turn goes on to the nearest of its tasks.
  void nearest_next(std::span<const int> robots, Draft& draft);

 private:
  bool advance(std::span<const int> robots);
  bool pass_over();
  void put(int task, std::span<const int> robots);
  bool go_to_nearest(int robot);

  const Problem& problem_;
  GrowingRoutes routes_;
  std::vector<char> seen_;               // tasks that were left for when they are ready
  std::vector<std::size_t> at_;          // by robot: how many of its tasks had their turn
  std::vector<std::vector<int>> tasks_;  // by robot: its tasks; with `nearest_next` those that are in no route
  std::vector<int> next_;                // tasks to put
};

}  // namespace muster
