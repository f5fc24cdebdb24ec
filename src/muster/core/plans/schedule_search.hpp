// Ruin and recreate under simulated annealing, as in `Search`, for problems in which tasks are bound to times, teams
// and relations [christiaens2020].
#pragma once

#include <vector>

#include "plans/neighbours.hpp"
#include "plans/roster.hpp"
#include "plans/search.hpp"
#include "random.hpp"

namespace muster {

class ScheduleSearch {
 public:
  // Throws std::invalid_argument if there is no schedule for the routes.
  ScheduleSearch(const Problem& problem, const Routes& start, std::uint64_t seed, SearchSettings settings);

  // So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).
  void anneal(int steps, double hot, double cold);
  // Goes on from these routes; the best stays.
  void go_on_from(const Routes& routes);

  // With which it goes on.
  Routes routes() const;
  const Routes& best() const { return best_; }
  const Value& best_value() const { return best_value_; }
  // The usual way from one task to the next, in the unit of the objective.
  double mean_way() const;

 private:
  void fill();
  void step(double temperature);
  bool recreate(double most);
  void limit_end(double most);
  void order_pending();

  bool find_tails(double most);
  bool joins(int robot, int at, int other, int other_at) const;
  double growth_of_tails() const;
  bool is_tail(int robot, int at, int other) const;
  bool does_alone(int robot, int task) const;
  bool exchange_tails();
  void take_tail(int robot, int at, std::vector<int>& units);

  void ruin();
  int seed_unit();
  void ruin_near(int seed);
  void ruin_at_once(int seed);
  void take_string(int robot, int at, int length);
  void take(int unit);
  void take_tied();

  double distance_from_start(int unit) const;
  double cost();
  double team_size(int unit) const;
  double ties() const;
  void note_best();
  double absent_difficulty() const;
  bool leaves_out_easier_than(double difficulty, double absent_weight);

  const Problem& problem_;
  SearchSettings settings_;
  Random random_;
  Neighbours neighbours_;
  Roster roster_;
  Trial trial_;
  bool sees_end_;               // whether the objective is when the mission ends
  bool sums_ways_;              // or how far robots go in all, work that lasts aside
  double at_once_share_ = 0.3;  // of ruins that take out what begins at about the same time
  double penalty_;              // of a unit of weight left out
  double scale_ = 1.0;          // of costs
  double current_ = 0.0;
  Routes best_;
  Value best_value_;
  std::vector<int> pending_, removed_, critical_;
  int tail_robot_ = 0, tail_at_ = 0, second_robot_ = 0, second_at_ = 0;  // after so many tasks tails are exchanged
  std::vector<int> tail_, second_tail_;
  std::vector<double> times_absent_;  // by unit: in how many plans it was left out, and 1
  std::vector<char> ruined_;
  std::vector<std::pair<double, int>> nearest_;
};

}  // namespace muster
