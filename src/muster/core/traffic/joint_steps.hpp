// What LaCAM searches on a graph: steps of all robots at once, one edge each at most.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "traffic/lacam.hpp"
#include "traffic/pibt.hpp"

namespace muster {

// No two robots are at one vertex, or change places. The cost is the number of steps that robots do not rest at their
// goals (sum of loss).
class JointSteps {
 public:
  using Memo = std::vector<double>;  // the priority of each robot

  // Of `samples` next configurations the one with the least cost to the end is taken. Throws std::invalid_argument
  // where starts or goals are no vertices.
  JointSteps(std::shared_ptr<const DirectedGraph> graph, Configuration starts, std::vector<int> goals, int samples,
             std::uint64_t seed);

  Configuration start() const { return starts_; }
  Memo memo() const;
  bool finished(const Configuration& places, const Memo&) const { return places == goals_; }
  double cost(const Configuration& from, const Configuration& to) const;
  double least_cost(const Configuration& places) const;
  void order(const Memo& priorities, std::vector<int>& robots) const;
  void moves(const Configuration& places, int robot, std::vector<int>& found) const;
  bool next(const Configuration& from, const Memo& priorities, std::span<const Constraint> said, Configuration& to,
            Memo& grown);
  void again(Memo&, const Memo&) const {}
  // Whether each goal can be come to from its start, alone.
  bool connected() const;

 private:
  std::shared_ptr<const DirectedGraph> graph_;
  Configuration starts_, goals_;
  int samples_;
  Pibt pibt_;
  std::vector<int> order_;
  Configuration sample_;
};

}  // namespace muster
