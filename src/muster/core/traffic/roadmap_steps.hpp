// What LaCAM searches on an annotated roadmap: steps in which each robot goes along one edge at most.
//
// A step is a sequence of single moves, each valid while all other robots stand: who stands nearer to the edge than both
// radii and the margin must have moved away before. It is made by priority inheritance with backtracking [okumura2022];
// here a robot may push several, and be in the way of several. Robots never rotate in a circle in which each takes the
// place of the next at once: nobody could begin.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "random.hpp"
#include "traffic/annotated_roadmap.hpp"
#include "traffic/lacam.hpp"

namespace muster {

struct SingleMove {
  int robot;
  int edge;
};

struct SteppingTeam {
  static constexpr int kNoGoal = -1;

  Configuration starts;
  std::vector<int> goals;
  std::vector<double> radii;
  std::vector<char> pinned;  // those who cannot move
  std::vector<char> stays;   // those who are to be at their goals in the end; others are to have been there
  double margin;

  int robots() const { return static_cast<int>(starts.size()); }
  double apart(int i, int j) const { return radii[i] + radii[j] + margin; }
};

// A configuration says where each robot is, and whether it has been at its goal: 2 * point + 1 if so.
class RoadmapSteps {
 public:
  using Tables = GoalTables<std::vector<double>>;
  struct Memo {
    std::vector<double> priorities;
    std::vector<SingleMove> moves;  // from the configuration before
  };

  // `tables` outlives it. Throws std::invalid_argument where the team does not fit the roadmap.
  RoadmapSteps(std::shared_ptr<const AnnotatedRoadmap> roadmap, SteppingTeam team, Tables* tables, std::uint64_t seed);

  Configuration start() const;
  Memo memo() const;
  bool finished(const Configuration& configuration, const Memo& memo) const;
  double cost(const Configuration& from, const Configuration& to) const;
  double least_cost(const Configuration& configuration) const;
  void order(const Memo& memo, std::vector<int>& robots) const;
  void moves(const Configuration& configuration, int robot, std::vector<int>& found) const;
  bool next(const Configuration& from, const Memo& memo, std::span<const Constraint> said, Configuration& to,
            Memo& grown);
  void again(Memo&, const Memo&) const {}

  static int point(int where) { return where / 2; }
  static bool visited(int where) { return where % 2 != 0; }
  // Whether a robot has no way to its goal, even alone.
  bool cut_off() const;

 private:
  struct Claim {
    int robot, edge;
  };
  struct Choice {
    double key;
    int edge;  // kStay: none
  };
  static constexpr int kStay = -1;

  bool wants(int robot, int where) const { return to_go_[robot] != nullptr && (team_.stays[robot] || !visited(where)); }
  double metres(int robot, int where) const { return wants(robot, where) ? (*to_go_[robot])[point(where)] : 0.0; }
  void rank(int robot, std::vector<Choice>& choices);
  bool decide(int robot);
  bool go(int robot, int edge);
  // Whether a robot at a point is in the way of nobody who is to go on.
  bool clear(int robot, int point) const;
  bool who_stands_near(int robot, int edge, std::vector<int>& others) const;

  std::shared_ptr<const AnnotatedRoadmap> roadmap_;
  const DirectedGraph& graph_;
  SteppingTeam team_;
  Random random_;
  double pace_;                                    // metres of an edge, on average
  std::vector<const std::vector<double>*> to_go_;  // null without goal

  // The step under way.
  Configuration where_;
  std::vector<SingleMove> made_;
  std::vector<int> standing_;  // the robot at each point, or -1
  std::vector<char> decided_, pending_;
  std::vector<Claim> claims_;
  std::vector<int> order_;
};

}  // namespace muster
