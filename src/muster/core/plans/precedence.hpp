// What comes before what across all routes of a plan that grows.
#pragma once

#include <span>
#include <vector>

#include "plans/draft.hpp"

namespace muster {

// Tasks are ordered by prerequisites and by routes. For each task in a route this keeps the last task of every route
// that comes before it (a vector clock), so that the places where one more task deadlocks nothing are known at once.
class Precedence {
 public:
  explicit Precedence(const Problem& problem);

  // The first place of the robot's route where a task may stand that is in no route: after all that it waits for,
  // directly or through other tasks. Its prerequisites are in routes, its dependants are not.
  int earliest(int robot, int task) const;

  // Takes over a draft that does not deadlock; `sequence` is an order in which its tasks can be done.
  void follow(const Draft& draft, std::span<const int> sequence);
  // A task was put into a route, no earlier than `earliest`. Returns the tasks that now have more before them.
  std::span<const int> insert(const Draft& draft, int robot, int at);

 private:
  std::span<int> before(int task) { return {last_.data() + static_cast<std::size_t>(task) * robots_, robots_}; }
  bool merge(int task, int from);
  void place(const Draft& draft, int robot, int from);
  void begin(const Draft& draft, int task);

  const Problem& problem_;
  std::size_t robots_;
  std::vector<int> last_;   // tasks x robots: the last task of the robot's route up to this task; kNobody if none
  std::vector<int> place_;  // of each task in its route
  std::vector<int> changed_;
};

}  // namespace muster
