// Which robots do a task together.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "problem.hpp"

namespace muster {

// Teams of robots, each given by a key: what it costs to take part, infinite where it cannot.
class TeamChoice {
 public:
  explicit TeamChoice(const Problem& problem);

  // Whether one robot alone does the task.
  bool alone(int task) const { return !has_parts(task) && !has_needs(task); }
  // Whether these robots can do the task together.
  bool does(int task, std::span<const int> robots);
  // The teams worth a look, each as indices of `robots`: the cheapest for every way to share the parts or to cover the
  // needs. Sums of independent keys are least among them.
  void teams(int task, std::span<const int> robots, std::span<const double> keys, Rows& found);

 private:
  bool has_parts(int task) const { return !problem_.parts(task).empty(); }
  bool has_needs(int task) const;
  void number_abilities();
  void by_parts(int task, std::span<const int> robots, Rows& found);
  void by_one_part(const TeamPart& part, std::span<const int> robots, Rows& found);
  bool give(int task, std::span<const int> robots, int index);
  void by_covers(int task, std::span<const int> robots, Rows& found);
  void by_greedy_cover(int task, std::span<const int> robots, Rows& found);
  const Rows& covers(int task);
  void cover(int task, int kind, std::vector<double>& missing, std::vector<int>& counts, Rows& found);
  bool needless(int task, const std::vector<int>& counts) const;
  bool covered(std::span<const double> missing) const;

  const Problem& problem_;
  std::vector<int> ability_class_;  // by robot: equal for robots of equal abilities
  std::vector<int> class_robot_;    // one robot of each class
  std::vector<int> class_size_;
  std::vector<char> known_;                    // by task, whether its covers are
  std::vector<Rows> covers_;                   // by task: minimal covers, each as classes in order; empty: too many
  std::vector<std::pair<double, int>> ranks_;  // key and index of the robots that can take part
  std::vector<int> seat_of_, seats_, taken_;
  std::vector<std::vector<std::pair<double, int>>> ranked_;  // by class
  std::vector<char> seen_;
  int budget_ = 0;
};

}  // namespace muster
