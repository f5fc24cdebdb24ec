// Steps of the metaheuristics of [tcf-thesis], section 3.2.2, on single drafts.
#pragma once

#include <vector>

#include "plans/draft.hpp"
#include "random.hpp"

namespace muster {

// Where a task may stand in a route so that it comes after its prerequisites and before its dependants in that route.
struct Stretch {
  int earliest;
  int latest;
};
Stretch stretch(const Problem& problem, std::span<const int> route, int task);

// A random admissible task allocation: tasks in random order, each after its prerequisites, at the end of the route of
// a random robot that may do it and has capacity left. What fits nowhere is left out, and what depends on it.
class RandomAllocation {
 public:
  explicit RandomAllocation(const Problem& problem);
  void operator()(Random& random, Draft& draft);

 private:
  int pick_robot(Random& random, int task) const;

  const Problem& problem_;
  std::vector<int> waiting_, ready_, tasks_, robots_, place_;
  std::vector<double> usage_;
};

// Task re-assignment mutation (Algorithm 4). Writes the mutant and returns the routes it changed, at most two; none if
// the random choices lead nowhere. The tasks left out count as one more sequence, that of nobody: a task may be taken
// from it, none is put into it.
struct Mutation {
  int changed[2];
  int count = 0;
};
Mutation reassign(const Problem& problem, Random& random, const Draft& draft, Draft& mutant);

// Which sequences k1 and k2 of Algorithm 4 are looked for in, and whether only places strictly between them count: then
// the first task of a sequence is neither taken nor displaced, and the place at k2 is not drawn.
enum class Scope { kReceiver, kAll, kOthers };  // kOthers: all but the one that the task leaves
struct Bounds {
  Scope scope = Scope::kReceiver;
  bool inner = false;
};
// Algorithm 4 with k1 and k2 so read: order numbers of any sequence of the scope, whatever sequence receives the task.
// A task that no other robot may do is not drawn.
Mutation reassign_within(const Problem& problem, Random& random, const Draft& draft, Bounds bounds, Draft& mutant);

// Constrained multi-agent partially mapped crossover, CM-PMX (Algorithm 5): tasks that both parents give to the same
// robot exchange their places in its sequence where prerequisites allow it. False if nothing was exchanged.
class Crossover {
 public:
  explicit Crossover(const Problem& problem)
      : problem_(problem), place_p_(problem.tasks()), place_q_(problem.tasks()) {}
  bool operator()(Draft& p, Draft& q);

 private:
  void exchange(Draft& draft, std::vector<int>& place, int robot, int task, int to) const;
  bool swappable(const Draft& draft, int robot, int task, int from, int to) const;

  const Problem& problem_;
  std::vector<int> place_p_, place_q_, common_;
};

}  // namespace muster
