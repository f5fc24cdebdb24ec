// Moves of robots with headings: priority inheritance over operations of several steps, EPIBT, improved by large
// neighbourhood search [yukhnevich2025].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "random.hpp"
#include "traffic/heading_distances.hpp"
#include "traffic/turning_grid.hpp"
#include "traffic/turning_operations.hpp"

namespace muster {

// What a robot is after: the next vertex that it is to visit, and the one after that; kNone where there is none.
struct Aim {
  int goal = TurningGrid::kNone, next = TurningGrid::kNone;
  int cost_between = 0;     // from goal to next
  std::int64_t weight = 1;  // of a step of this robot in the sum that is improved
};

// Each robot always has an operation, and no two of them collide. From step to step the operations move up by one
// and end with a wait, which keeps them so. Then
//   1. in an order of priority, each robot takes the best operation for which a robot in the way, one at most and of
//      lower priority, finds another one in turn, and
//   2. robots chosen at random do the same with any robot in the way, where the weighted sum of costs does not grow.
// That is sampled with disturbed orders while checks of operations are left, and the least sum counts.
class TurningMoves {
 public:
  TurningMoves(const TurningGrid& grid, const HeadingDistances& distances, std::vector<int> states, std::uint64_t seed);

  int robots() const { return static_cast<int>(states_.size()); }
  const std::vector<int>& states() const { return states_; }
  // Decides operations. `order` has the robots by priority. About `checks` operations are checked; one sample is made
  // in any case.
  void plan(std::span<const Aim> aims, std::span<const int> order, std::int64_t checks);
  // Takes the first step of all operations, and moves them up.
  void advance();
  // The state of a robot after the next step.
  int next(int robot) const { return plans_[robot][0]; }

 private:
  struct Choice {
    std::int64_t cost;
    Operation operation;
  };
  static constexpr int kNobody = -1, kSeveral = -2;
  static constexpr int kImproving = -1;
  // Operations that are checked for one robot and those that it displaces.
  static constexpr int kPriorityChecks = 20'000, kImprovementChecks = 1'000;
  static constexpr std::int64_t kSampleChecks = 300'000;  // of the second part of a sample
  static constexpr int kDeepest = 8;                      // robots that displace one another
  static constexpr int kMostVisits = 10;                  // times that one of them is displaced

  // Operations of all robots, and what they cost.
  struct Decision {
    std::vector<Operation> plans;
    std::vector<std::int64_t> costs;
  };

  Decision sample(std::span<const int> order, std::int64_t checks);
  void take(const Decision& decision);
  std::vector<int> disturbed(std::span<const int> order);
  std::int64_t weighted_sum() const;
  void rank_operations(std::span<const Aim> aims);
  std::int64_t cost_of(const Aim& aim, int state, const Operation& operation) const;
  void inherit_by_priority(std::span<const int> order);
  void improve(std::int64_t checks);

  bool is_improving() const { return rank_ == kImproving; }

  void try_to_improve(int robot, int checks);
  bool is_found(int robot, std::int64_t change, int depth);
  bool is_any_choice_taken(int robot, std::int64_t change, int depth);
  bool may_be_displaced(int robot, std::int64_t change) const;
  bool is_displaced(int other, int robot, const Choice& choice, std::int64_t change, int depth);
  int in_the_way(int robot, const Operation& operation) const;
  void put(int robot, const Operation& operation);
  void lift(int robot);

  int& occupant(int vertex, int step) { return occupants_[vertex * (kOperationSteps + 1) + step]; }
  int occupant(int vertex, int step) const { return occupants_[vertex * (kOperationSteps + 1) + step]; }

  const TurningGrid& grid_;
  const HeadingDistances& distances_;
  TurningOperations operations_;
  Random random_;
  std::vector<int> states_;
  std::vector<Operation> plans_;
  std::vector<int> occupants_;  // by vertex and step: the robot there
  // Of this step, by robot.
  std::vector<std::vector<Choice>> choices_;  // the best first
  std::vector<std::int64_t> costs_;           // of plans_
  std::vector<std::int64_t> weights_;
  std::vector<int> ranks_;  // in the order of priority
  int rank_ = kImproving;   // of the robot whose turn it is in the first part; kImproving in the second
  // Of this search: robots are waiting while those that they displace are searched for an operation.
  int search_ = 0, checks_left_ = 0;
  std::int64_t checks_done_ = 0;  // in this sample
  std::vector<int> searched_in_, visits_;
  std::vector<char> is_waiting_;
};

}  // namespace muster
