// Paths of robots in space and time, and the soonest path of one robot past all others.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "heap.hpp"
#include "random.hpp"
#include "traffic/directed_graph.hpp"
#include "traffic/goal_distances.hpp"

namespace muster {

// Each vertex has the stays of robots there, in order of time; between them it is free. The search of one robot is over
// such safe intervals [phillips2011], so that its effort does not grow with the time that a robot waits.
class PathTable {
 public:
  using Path = std::vector<int>;  // the vertex at each step, until it rests at its goal
  static constexpr int kNobody = -1;
  static constexpr int kForever = std::numeric_limits<int>::max() / 2;

  explicit PathTable(std::shared_ptr<GoalDistances> distances);

  int robots() const { return distances_->robots(); }
  GoalDistances& distances() const { return *distances_; }
  const DirectedGraph& graph() const { return distances_->graph(); }
  const Path& path(int robot) const { return paths_[robot]; }
  // The step after which a robot rests at its goal.
  int cost(int robot) const { return static_cast<int>(paths_[robot].size()) - 1; }
  // The robot at a vertex at a step, or kNobody.
  int occupant(int vertex, int step) const;
  // The robots that are at a vertex at any time, in order of time.
  void visitors(int vertex, std::vector<int>& found) const;

  // Whether nobody is where the path leads.
  bool is_free(const Path& path) const;
  void put(int robot, Path path);
  void remove(int robot);  // its path is kept
  // Into `found` the path from `start` that rests at the goal soonest, by the step `latest`; false if there is none.
  bool search(int robot, int start, int latest, Random& random, Path& found);

 private:
  struct Stay {
    int begin, end, robot;  // at steps `begin` to `end`
  };
  struct Label {
    int step;  // of arrival in the interval before a stay
    int parent, parent_interval;
  };
  struct Row {
    std::vector<Stay> stays;
    std::vector<Label> labels;
    int search = 0;
  };
  struct State {
    std::int64_t key;
    int step, vertex, interval;
  };

  Label& label(int vertex, int interval);
  static std::int64_t key_of(int arrival, int way) { return (static_cast<std::int64_t>(arrival) << 32) + way; }
  void expand(int robot, const State& from, int latest, int rest_from, int turn);
  void trace(int vertex, int interval, Path& found);
  // The first stay that has not ended before a step.
  static std::size_t stay_at(const Row& row, int step);

  std::shared_ptr<GoalDistances> distances_;
  std::vector<Path> paths_;
  std::vector<Row> rows_;
  int search_ = 0;
  Heap<State> open_;
};

}  // namespace muster
