// Routes while a search changes them.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "problem.hpp"
#include "routes.hpp"

namespace muster {

// What the objective sees of one route.
struct RouteCost {
  double usage = 0.0;     // with the way to the end
  double arrivals = 0.0;  // sum of usages on arrival
  double done = 0.0;      // seconds, when the last task ends if nothing waits
};

// A route on its way to one of its places: what it has come to before it sets out, and the way there.
struct Leg {
  double usage = 0.0;
  double arrivals = 0.0;
  double time = 0.0;
  double way = 0.0;
};

// Where a task could go, and what that adds to the route.
struct Place {
  int robot = -1;
  int at = 0;
  double growth = 0.0;  // of usage
};

// Routes with the place of every task, and undo: `touch` keeps a route as it is until the next `commit` or `rollback`.
class Team {
 public:
  Team(const Problem& problem, const Routes& routes);

  static constexpr int kAbsent = -1;

  // Takes over other routes.
  void begin(const Routes& routes);

  const std::vector<int>& route(int robot) const { return routes_[robot]; }
  const RouteCost& cost(int robot) const { return costs_[robot]; }
  int robot_of(int task) const { return robot_of_[task]; }
  int at(int task) const { return at_[task]; }
  bool present(int task) const { return robot_of_[task] != kAbsent; }
  const std::vector<int>& absent() const { return absent_; }
  double absent_weight() const { return absent_weight_; }

  void insert(int task, int robot, int at);
  void remove(int task);

  // The way to the task at a place, or from the last task to the robot's end.
  double way(int robot, int at) const { return legs_[robot][at].way; }
  double longest_way(int robot) const { return std::ranges::max(legs_[robot], {}, &Leg::way).way; }
  // What is gained or lost by `task` at a place of the robot's route.
  double growth(int robot, int task, int at) const { return problem_.growth(robot, routes_[robot], task, at); }
  // What the objective `average` loses by it, and the time that the route takes more.
  double later_arrivals(int robot, int task, int at, double growth) const;
  double longer(int robot, int task, int at) const;

  // Whether the task stays at its place.
  bool fixed(int task) const { return at_[task] < problem_.fixed(robot_of_[task]); }

  // Works out the places of each route where an absent task deadlocks nothing: from `earliest` to `latest`, none among
  // the tasks that stay. All of its prerequisites must be present.
  void bound(int task);
  int earliest(int robot) const {
    return std::max(problem_.fixed(robot), stamp_of_[robot] == stamp_ ? earliest_[robot] : 0);
  }
  int latest(int robot) const {
    return stamp_of_[robot] == stamp_ ? latest_[robot] : static_cast<int>(routes_[robot].size());
  }
  // The time at which the last task ends, waiting included; works out when each task ends.
  double makespan();
  // Since `makespan`: works out how long each task holds up the end of the mission.
  void measure_tails();
  // Since both: when the mission ends, as far as it waits for `task`, put at a place.
  double end_through(int robot, int task, int at) const;
  // Since `makespan`: the tasks that its end waited for one after the other, the last first.
  std::vector<int> critical() const;

  void commit() { saved_count_ = 0; }
  void rollback();
  // Whether the routes changed since then are within the robots' capacities. Taking a task out can make a route longer,
  // where it lies on a short cut.
  bool fits() const;

  Routes routes() const { return routes_; }
  // The routes changed since the last call.
  std::vector<int> take_changed();

 private:
  struct Saved {
    int robot;
    std::vector<int> route;
    RouteCost cost;
    std::vector<Leg> legs;
  };

  void touch(int robot);
  void measure(int robot, int from);
  void appear(int task, int robot);
  void vanish(int task);
  void see(int robot);
  void go_back(int task);
  void go_forth(int task);

  const Problem& problem_;
  std::vector<std::vector<int>> routes_;
  std::vector<RouteCost> costs_;
  std::vector<std::vector<Leg>> legs_;  // by robot and place; the last leads to the robot's end
  std::vector<int> robot_of_, at_;
  std::vector<int> absent_, listed_;
  double absent_weight_ = 0.0;
  std::vector<Saved> saved_;  // the first saved_count_ count; the others keep their memory for later
  std::size_t saved_count_ = 0;
  std::vector<char> changed_;
  // Of `bound`.
  int stamp_ = 0;
  std::vector<int> stamp_of_, earliest_, latest_, task_stamp_, stack_;
  // Of `makespan` and `measure_tails`.
  std::vector<int> waiting_, queue_;
  std::vector<double> ends_, tails_;  // tails: from the begin of a task to the end of all that waits for it
};

}  // namespace muster
