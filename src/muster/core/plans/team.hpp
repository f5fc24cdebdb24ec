// Routes while a search changes them.
#pragma once

#include <cstdint>
#include <vector>

#include "plans/problem.hpp"
#include "plans/routes.hpp"

namespace muster {

// Where a task could go: behind a place of a robot's route, and what that adds to the route.
struct Place {
  int robot = -1;
  int after = -1;
  double growth = 0.0;  // of usage
};

// Routes with undo. Each is linked from its robot's start through its tasks to its robot's end, places as in the
// problem: a change costs what changes, not the length of the route. Changes hold until `commit` or `rollback`.
class Team {
 public:
  Team(const Problem& problem, const Routes& routes);

  static constexpr int kAbsent = -1;

  // Takes over other routes.
  void begin(const Routes& routes);

  int next(int place) const { return next_[place]; }
  int prev(int place) const { return prev_[place]; }
  int robot_of(int place) const { return robot_of_[place]; }
  bool present(int task) const { return robot_of_[task] != kAbsent; }
  // Whether a place comes before another of the same route.
  bool before(int place, int other) const { return label_[place] < label_[other]; }
  int size(int robot) const { return size_[robot]; }
  bool empty(int robot) const { return size_[robot] == 0; }
  bool is_task(int place) const { return place < problem_.tasks(); }
  // Task number `k` of a route.
  int task_at(int robot, int k) const;
  // Whether the task stays at its place.
  bool fixed(int task) const { return !before(last_fixed_[robot_of_[task]], task); }
  // The last of the tasks that stay, or the robot's start.
  int last_fixed(int robot) const { return last_fixed_[robot]; }

  const std::vector<int>& absent() const { return absent_; }
  double absent_weight() const { return absent_weight_; }

  // The way to a place from the place before it; 0 to the end of an empty route.
  double way(int place) const { return way_[place]; }
  // The way from a place to another, of which one may be the robot's start or end.
  double way(int robot, int from, int to) const {
    if (is_task(to)) return problem_.travel_usage(robot, from, to);
    return is_task(from) ? problem_.end_usage(robot, from) : 0.0;
  }
  double longest_way(int robot) const;
  // Usage, with the way to the end.
  double usage(int robot) const { return usage_[robot]; }
  // Seconds, when the last task ends if nothing waits; kept for the objective `makespan` alone.
  double done(int robot) const { return done_[robot]; }
  // The sum of usages on arrival.
  double arrivals(int robot);
  // Usage when a place is left; of a route that was measured after its last change.
  double leaving(int place) const { return leaving_[place]; }
  // Works out sums along a route, if it changed since.
  void measure(int robot);

  // What is gained or lost by a task behind a place.
  double growth(int robot, int task, int after) const;
  // What the objective `average` loses by it, and the time that the route takes more.
  double later_arrivals(int robot, int task, int after, double growth);
  double longer(int robot, int task, int after) const;

  void insert(int task, int after);
  void remove(int task);
  // Turns the part of a route from one task to another round; all ways must be as long back as forth.
  void reverse(int first, int last);
  // Puts the part of a route from one task to another behind a place outside it.
  void move(int first, int last, int after);

  // Works out the places of each route where an absent task deadlocks nothing: behind `earliest` or later, before
  // `latest`, and not among the tasks that stay. All of its prerequisites must be present.
  void bound(int task);
  int earliest(int robot) const {
    const int first = stamp_of_[robot] == stamp_ ? earliest_[robot] : problem_.start(robot);
    return before(first, last_fixed_[robot]) ? last_fixed_[robot] : first;
  }
  int latest(int robot) const { return stamp_of_[robot] == stamp_ ? latest_[robot] : problem_.end(robot); }

  // Works out the figures of the routes changed since `commit` from their beginning, so that no rounding adds up.
  void settle();
  // Whether these routes are within the robots' capacities. Taking a task out can make a route longer, where it lies on
  // a short cut.
  bool fits() const;
  void commit();
  void rollback();

  std::vector<int> route(int robot) const;
  Routes routes() const;
  // The routes changed since the last call.
  std::vector<int> take_changed();

 private:
  enum class Kind { inserted, removed, reversed, moved };
  struct Change {
    Kind kind;
    int first, last, before;  // `before`: the place before them until then
  };
  struct Saved {
    int robot;
    double usage, done;
  };

  struct Figures {
    double usage = 0.0, done = 0.0;
  };

  void touch(int robot);
  void forget();
  Figures figures(int robot, int first, int end) const;
  void gather(int first, int last);
  void link(int task, int after);
  void unlink(int task);
  void turn(int first, int last);
  void splice(int first, int last, int after);
  void relabel(int robot);
  void find_way(int place);
  double seconds(int robot, int from, int to) const;
  void appear(int task);
  void vanish(int task);
  void add(int robot, double usage, double done);
  void see(int robot);
  void go_back(int task);
  void go_forth(int task);

  const Problem& problem_;
  bool timed_;
  std::vector<int> next_, prev_, robot_of_;  // by place
  std::vector<std::int64_t> label_;          // by place, rising along a route
  std::vector<double> way_, leaving_;        // by place
  std::vector<int> size_, last_fixed_;       // by robot, as all that follows
  std::vector<double> usage_, done_, arrivals_;
  std::vector<char> stale_;  // whether `arrivals_` and `leaving_` are those of an earlier route
  std::vector<int> rank_;    // by place, as of `measure`
  std::vector<char> changed_, touched_;
  std::vector<int> absent_, listed_;
  double absent_weight_ = 0.0;
  std::vector<Change> changes_;  // since `commit`
  std::vector<Saved> saved_;
  std::vector<int> part_;  // of a route, from one task to another
  // Of `bound`.
  int stamp_ = 0;
  std::vector<int> stamp_of_, earliest_, latest_, task_stamp_, stack_;
};

}  // namespace muster
