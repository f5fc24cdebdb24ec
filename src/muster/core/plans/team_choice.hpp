// Which robots do a task together.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "plans/problem.hpp"

namespace muster {

// Teams of robots, each given by a key: what it costs to take part, infinite where it cannot.
class TeamChoice {
 public:
  explicit TeamChoice(const Problem& problem);

  // Whether one robot alone does the task.
  bool alone(int task) const { return !has_parts(task) && !has_needs(task); }
  // Whether these robots can do the task together.
  bool does(int task, std::span<const int> robots);
  // The robots that take part, by class of abilities, cheapest first: key and index.
  using Ranking = std::vector<std::vector<std::pair<double, int>>>;

  // The teams worth a look, each as indices of `robots`: the cheapest for every way to share the parts or to cover the
  // needs. Sums of independent keys are least among them. `ranking` is that of an earlier call, for the same task and
  // robots, and becomes that of this one: teams of which nothing is new since may be left out, having no member that
  // `moved`, and none instead of one that did.
  void teams(int task, std::span<const int> robots, std::span<const double> keys, std::span<const char> moved,
             Ranking& ranking, Rows& found);

 private:
  struct Covers {
    Rows rows;  // minimal ones, each as classes in order; empty: too many
    Rows with;  // by class: those that it is in
  };

  bool has_parts(int task) const { return !problem_.parts(task).empty(); }
  bool has_needs(int task) const;
  void number_abilities();
  void by_parts(int task, std::span<const int> robots, Rows& found);
  void by_one_part(const TeamPart& part, std::span<const int> robots, Rows& found);
  bool give(int task, std::span<const int> robots, int index);
  void rank_anew(std::span<const int> robots, std::span<const double> keys, std::span<const char> moved,
                 Ranking& ranking);
  void by_covers(int task, const Ranking& ranking, Rows& found);
  void fill(std::span<const int> cover, const Ranking& ranking, Rows& found);
  void by_greedy_cover(int task, std::span<const int> robots, Rows& found);
  const Covers& covers(int task);
  void cover(int task, int kind, std::vector<double>& missing, std::vector<int>& counts, Rows& found);
  bool needless(int task, const std::vector<int>& counts) const;
  bool covered(std::span<const double> missing) const;

  const Problem& problem_;
  std::vector<int> ability_class_;  // by robot: equal for robots of equal abilities
  std::vector<int> class_robot_;    // one robot of each class
  std::vector<int> class_size_;
  std::vector<char> known_;                    // by task, whether its covers are
  std::vector<Covers> covers_;                 // by task
  std::vector<std::pair<double, int>> ranks_;  // key and index of the robots that can take part
  std::vector<int> seat_of_, seats_, taken_;
  std::vector<std::size_t> same_;  // by class: how many of the first are those of the earlier call, and did not move
  std::vector<int> seen_covers_;   // by cover: the call in which it was looked at
  int call_ = 0;
  std::vector<char> seen_;
  int budget_ = 0;
};

}  // namespace muster
