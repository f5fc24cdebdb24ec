// The team while tasks are auctioned: the robots' routes so far, and what each robot could do with each open task.
#pragma once

#include <limits>
#include <vector>

#include "plans/draft.hpp"
#include "plans/precedence.hpp"
#include "plans/routes.hpp"

namespace muster {

// What a bid is made from: by how much the task lengthens the robot's route; by how much it delays the robot's arrivals
// in all (its own arrival included); or when the robot would be done with all its tasks.
enum class Figure { growth, arrivals, end };

// Each robot keeps the best place in its route for each open task. When a task is put into a route only two places are
// new there, so that an award costs one comparison a task, and nothing at the other robots.
class Bidders {
 public:
  // `insert`: a task goes where it lengthens the route least, else to its end.
  Bidders(const Problem& problem, bool insert, Figure figure);

  // Begins anew with these routes, which must be admissible; nothing is announced.
  void set_routes(const Routes& routes);
  const Draft& draft() const { return draft_; }
  double usage(int robot) const { return draft_.figures(robot).usage; }

  // A task is open, for bids, from when it is announced and its prerequisites are in routes until it is awarded.
  void announce(int task);
  const std::vector<int>& open() const { return open_; }
  // The figure of each task for a robot, and of each robot for a task; inf where the task is not open, or the robot may
  // not do it or has no capacity for it.
  std::vector<double> offers(int robot);
  std::vector<double> offers_for(int task);
  double offer(int robot, int task);
  // The robot's task with the lowest figure, and that figure.
  struct Lowest {
    int task = Draft::kNobody;
    double figure = std::numeric_limits<double>::infinity();
  };
  const Lowest& lowest(int robot);
  // Puts an open task into a robot's route, at the place that its offer was for.
  void award(int robot, int task);
  // Takes a task out of its route, and all that waits for it. They have to be announced to be open again. Takes and
  // returns none if the routes would not be admissible without them: where a task lies on a short cut.
  std::vector<int> relinquish(int task);

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr int kClosed = -1;

  std::size_t index(int robot, int task) const { return static_cast<std::size_t>(robot) * problem_.tasks() + task; }
  bool is_open(int task) const { return listed_[task] != kClosed; }
  void open_if_ready(int task);
  void close(int task);
  void take_in(int robot);
  bool waiting_counts() const { return figure_ == Figure::end && problem_.has_prerequisites(); }
  int earliest(int robot, int task) const;
  void prefer(int robot, int task);
  void look(int robot, int task);
  void look_again(int robot, int task, int at);
  void consider(int robot, int task, int at);
  double arrivals(int robot, int task) const;
  double end(int robot, int task);
  double end_with_waiting(int robot, int task);

  const Problem& problem_;
  bool insert_;
  Figure figure_;
  Evaluator evaluator_;
  Draft draft_;
  Precedence precedence_;
  std::vector<char> announced_;
  std::vector<int> missing_;  // prerequisites that are in no route
  std::vector<int> open_;
  std::vector<int> listed_;                  // where a task stands among the open ones
  std::vector<double> growth_;               // robots x tasks: at the best place, whatever the capacity
  std::vector<int> place_;                   // robots x tasks
  std::vector<Lowest> lowest_;               // by robot
  std::vector<char> stale_;                  // whether it must be found anew
  std::vector<std::vector<double>> leaves_;  // by robot and place: the usage when it sets out for the task there
  std::vector<double> done_;                 // when each robot is done, where nothing waits
  bool scheduled_ = false;                   // whether the evaluator's schedule is that of the draft
};

}  // namespace muster
