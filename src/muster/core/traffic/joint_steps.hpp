// What LaCAM searches on a graph: steps of all robots at once, one edge each at most.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "traffic/lacam.hpp"
#include "traffic/pibt.hpp"
#include "traffic/traffic_guidance.hpp"

namespace muster {

// No two robots are at one vertex, or change places. At first robots take ways that avoid those who come the other way;
// after that the shortest, since the rules of swapping are made for these. The cost is the number of steps that robots
// do not rest at their goals (sum of loss).
class JointSteps {
 public:
  struct Memo {
    std::vector<double> priorities;  // of each robot
    int step = 0;
  };

  // Of `samples` next configurations the one with the least cost to the end is taken. Throws std::invalid_argument
  // where the guidance is not finished, or a robot alone has no way.
  JointSteps(const TrafficGuidance& guidance, int samples, std::uint64_t seed);

  Configuration start() const { return starts_; }
  Memo memo() const;
  bool finished(const Configuration& places, const Memo&) const { return places == distances_->goals(); }
  double cost(const Configuration& from, const Configuration& to) const;
  double least_cost(const Configuration& places) const;
  void order(const Memo& memo, std::vector<int>& robots) const;
  void moves(const Configuration& places, int robot, std::vector<int>& found) const;
  bool next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
            Memo& grown);
  void again(Memo&, const Memo&) const {}

 private:
  std::shared_ptr<GoalDistances> distances_, guided_;
  Configuration starts_;
  std::vector<int> guided_until_;     // by robot: the step from which it takes the shortest way
  int calls_ = 0, guided_calls_ = 0;  // how many steps were made, and how many of them are guided at most
  int samples_;
  Pibt pibt_;
  std::vector<int> order_;
  Configuration sample_;
};

}  // namespace muster
