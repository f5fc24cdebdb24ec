// Better paths from paths: large neighbourhood search [li2021].
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "random.hpp"
#include "traffic/goal_distances.hpp"
#include "traffic/lacam.hpp"
#include "traffic/path_table.hpp"

namespace muster {

// Removes the paths of a few robots, plans these robots again one after another past the others, and keeps what has no
// higher sum of costs: steps until a robot rests at its goal for good. Which robots they are, three rules propose in
// turn, and those that lower the sum more propose more often.
class JointRefinement {
 public:
  // `steps` are the vertices of all robots, step by step; the last are the goals. Throws std::invalid_argument where
  // they are no paths, or two robots are at one vertex or change places.
  JointRefinement(std::shared_ptr<GoalDistances> distances, const std::vector<Configuration>& steps,
                  std::uint64_t seed);

  void advance(int neighbourhoods);
  int cost() const { return cost_; }
  std::vector<Configuration> solution() const;

 private:
  using Path = PathTable::Path;
  enum Rule { kDelayed, kCrossing, kAny, kRules };

  int robots() const { return table_.robots(); }
  int way(int robot) const { return table_.distances().to_goal(robot, starts_[robot]); }
  int delay(int robot) const { return table_.cost(robot) - way(robot); }
  void refine();
  bool replan();
  Rule rule();
  void choose(Rule rule, int size);
  int delayed_robot();
  void walk(int robot, int size);
  void gather(int vertex, int size);
  void add(int robot);

  static constexpr int kMost = 16;  // robots that are planned again at once

  Random random_;
  Configuration starts_;
  PathTable table_;
  int cost_ = 0;
  std::array<double, kRules> weights_{1, 1, 1};
  std::vector<int> crossings_;  // vertices where more than two edges begin
  std::vector<int> chosen_, visitors_;
  std::vector<int> chosen_in_, seen_in_;  // by robot, by vertex: the last round or search in which it was found
  int round_ = 0, search_ = 0;
};

}  // namespace muster
