// Ruin and recreate under simulated annealing: slack induction by string removals (SISR, [christiaens2020]), for teams
// whose objective may look at the robot that does most.
#pragma once

#include <vector>

#include "plans/draft.hpp"
#include "plans/local_search.hpp"
#include "plans/neighbours.hpp"
#include "plans/team.hpp"
#include "plans/team_cost.hpp"
#include "random.hpp"

namespace muster {

struct SearchSettings {
  double removed = 10.0;        // tasks that a ruin takes out, on average
  int longest_string = 10;      // of tasks taken out of one route
  double blink = 0.01;          // how often a place is overlooked
  double greatest_share = 0.5;  // of ruins that begin at the robot that does most
  int near = 30;                // tasks beside which a task is tried, where there are many
  bool oversubscribed = false;  // whether to expect that not all tasks can be done
};

class Search {
 public:
  // The routes must be admissible.
  Search(const Problem& problem, const Routes& start, std::uint64_t seed, SearchSettings settings);

  // So many steps, while the temperature falls evenly from hot to cold (in the unit of the objective).
  void anneal(int steps, double hot, double cold);
  // Goes on from these routes; the best stays.
  void go_on_from(const Routes& routes);

  // With which it goes on.
  Routes routes() const { return team_.routes(); }
  const Routes& best() const { return best_; }
  const Value& best_value() const { return best_value_; }
  // The usual way from one task to the next.
  double mean_way() const;
  // What a task costs at the start: the mean of usage, arrival or time, as the objective has it.
  double task_cost() const { return task_cost_; }

 private:
  void step(double temperature);
  double mean_cost();
  void weigh(double temperature);
  void ruin();
  double scale_of_ruin(double tasks_of_route);
  int seed_task();
  int any_of(const std::vector<int>& tasks);
  void take_string(int task, int longest);
  void set_out_again();
  void recreate();
  void improve();
  void order_pending();
  void begin_with(int task);
  bool insert(int task);
  void try_route(int robot, int task);
  void try_place(int robot, int task, int after);
  void try_near(int task);
  void try_far(int task);
  bool raises_greatest() const;
  void try_idlest(int task);
  void propose(int robot, int task, int after, double growth);
  void drop_orphans();
  double cost() const;
  void note_best();

  const Problem& problem_;
  SearchSettings settings_;
  Random random_;
  Neighbours neighbours_;
  bool everywhere_;  // whether a task is tried at every place
  double penalty_;   // of a unit of weight left out: one of the next two
  double forbidding_, trading_;
  double usual_way_ = 0.0, weighed_for_ = -1.0;
  double task_cost_;
  Team team_;
  TeamCost team_cost_;
  LocalSearch local_search_;
  double current_;
  Routes best_;
  Value best_value_;
  double peak_ = 0.0;  // the greatest load, while tasks are put back
  int seed_ = 0;       // the task that a ruin begins at
  bool seed_left_out_ = false;
  std::vector<int> ruined_;  // robots
  std::vector<int> string_;  // places of a route around a task that a string is taken from
  std::vector<int> gaps_;    // places beside which tasks were taken out
  int ruin_stamp_ = 0;
  std::vector<int> spared_;             // by task: the ruin that leaves it, beside a string
  std::vector<int> again_;              // tasks left out before the step that it tries again
  std::vector<int> pending_, removed_;  // tasks
  std::vector<char> is_ruined_;
  std::vector<char> where_ruined_;  // tasks that are tried on ruined routes alone
  Place place_;                     // the best found for a task
  double place_score_ = 0.0;
};

}  // namespace muster
