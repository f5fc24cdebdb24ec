// Where a unit of work costs least, and who does it.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "plans/insertion_score.hpp"
#include "plans/neighbours.hpp"
#include "plans/quantum.hpp"
#include "plans/relations.hpp"
#include "plans/roster.hpp"
#include "plans/team_choice.hpp"

namespace muster {

// One robot for one task is tried at every place that leaves the graph without a cycle and all in time. For a team, or
// tasks that start together, the units are cut in two along their labels: each cut gives every robot one place, so that
// no choice of members can make a cycle; at each cut the team that costs least is chosen.
class Placement {
 public:
  explicit Placement(Roster& roster);

  const UnitInsertion* best(int unit, const Trial& trial);

 private:
  struct Part {
    int task;  // one of `tasks_of_unit`
    const Offer* offer;
  };
  // Behind a unit; or, as the first of all, behind what must come before the one that is placed.
  struct Cut {
    double label;
    int behind;  // -1: the first
    bool tried;
  };

  // A place that is not judged with its calls yet: of a task, or of two as one transport.
  struct Candidate {
    double score, growth, usage;
    double ends, takes;        // when the mission ends by it at the earliest, and what it takes of the robot's time
    int robot, at, second_at;  // -1: one task
  };
  // A robot under way with the load of a transport.
  struct Walk {
    int robot, pickup, delivery, at, place;
    double time, pickup_begin, pickup_end, growth, late, takes;
    double ride = 0.0;  // ways and work with the load on board, without waiting
  };

  bool alone(int unit) const;
  void try_all(int unit);
  bool suits(int unit);
  bool suits(std::span<const int> awaited, std::span<const int> robots);

  // One robot, one task.
  bool usable_alone(int robot);
  void find_empty_twins();
  bool is_second_twin(int robot) const;
  void try_alone(int task);
  void try_near(int task);
  void try_place(int robot, int task, int at);
  void measure_alone(int task, double work);
  std::pair<int, int> places(int robot) const;

  // Goods: a task that takes something on board with the one that delivers it, and loads.
  bool best_transport(int pickup, int delivery, const Trial& trial);
  void try_transport_with(int robot, int pickup, int delivery);
  void try_pickup_at(int robot, int at, int pickup, int delivery);
  void keep_to_near_robots(int pickup, int delivery);
  bool costs_too_much(const Walk& walk, double growth, double takes) const;
  bool room_for_transport(const Walk& walk, int at) const;
  bool pass_stop(Walk& walk, int at) const;
  void try_delivery_at(const Walk& walk, int at);
  bool has_room(int robot, int task, int at) const;

  // Units that are inseparable, where they are not two tasks for one robot each.
  struct Whole {
    std::span<const int> units;
    std::vector<std::vector<int>> cuts;  // by unit: behind how many of the present ones it may go
    std::vector<int> order;              // the present units by label
    std::vector<PlacedUnit> placed;      // units before the one that is placed, and this one
    std::vector<int> cut_of;             // of them
    int left;                            // how many ways are still judged
  };
  bool best_whole(std::span<const int> units, const Trial& trial);
  std::vector<int> cuts_for(int unit, const std::vector<int>& order, std::size_t most);
  void place_next(Whole& whole);
  void place_team(Whole& whole, std::size_t k);
  using Teams = std::vector<std::vector<int>>;
  Teams teams_for(const Whole& whole, int task, int k);
  std::vector<int> team_of_pickup(const Whole& whole, int task) const;
  Teams all_teams(int task, const std::vector<int>& able);
  Teams near_teams(int task, const std::vector<int>& able);
  int place_in_whole(const Whole& whole, int robot) const;
  void judge_whole(Whole& whole);

  // Energy and stations: what a place costs with the calls that the route needs then.
  bool may_call(int robot) const { return calls_ && problem_.may_run_short(robot); }
  double leave(int robot, int at) const;
  double latest_begin(int robot, int at) const;
  double growth_beside_calls(int robot, int task, int at) const;
  void keep(Candidate&& candidate);
  void judge_candidates();
  void take(const Candidate& candidate, double score, double growth);

  // Teams.
  void try_cuts(int unit);
  template <class Try>
  void walk_cuts(int unit, Try&& attempt);
  void gather_cuts(int unit);
  bool seek_near(int unit);
  void stand_at_first_cut();
  void pass(int unit);
  void pass_up_to(double label);
  bool renew_offers(int unit);
  bool offered(std::size_t candidate) const;
  void make_offers(int unit, std::size_t candidate);
  bool may_join(Offer& offer, int task) const;
  void try_cut(int unit);
  void try_key(int unit, int key, std::size_t first);
  double key_of(const Offer& offer, int key) const;
  double compared(double score) const { return trial_->quantised ? in_quanta(score) : score; }
  void rank(int task, int k, int key);
  void try_teams(int unit, int key);
  void try_shared(int task, int unit);
  bool take_tied(int task, int k);
  bool take_cheapest(int task, int k);
  bool usable(int robot, int task, int k) const { return relations_.allows(k, robot) && problem_.allowed(robot, task); }
  void try_hard(int unit);
  void try_together(int unit, int key, std::size_t first);
  void choose_anew(int task);
  int cheapest_team() const;
  void judge(int unit);
  void measure_works(std::size_t tasks);
  double growth(const Part& part) const;
  bool may_begin(int unit, double begin) const;
  double lateness_of_team(int unit, double begin) const;

  // A task that would be done behind so many tasks of a route as it is.
  struct Added {
    int at, task;
  };
  bool keeps_length(int robot, std::span<const Added> added) const;
  double over(int robot, std::span<const Added> added, double leave) const;
  double open_to(int unit, int robot, double earliest, double work) const;
  double open_to_team(int unit, double earliest) const;
  bool in_reach(int robot, int task, int at) const;
  double least_score(int robot, int at, double work) const;
  double least_score(const Offer& arrival) const;
  bool hopeless(const Offer& offer) const;
  Offer arrival(int robot, int task, int at, double work) const;
  void go_on(Offer& offer, int task) const;
  void measure_usage(Offer& offer, int task) const;
  bool overlooked() const { return trial_->blink > 0.0 && trial_->random->uniform() < trial_->blink; }
  double lateness(int task, double end) const;
  double delays(const Offer& offer, double end) const;
  double later_arrivals(int robot, int task, int at, double growth) const;

  static constexpr int kKeys = 4;  // ways to rank robots
  static constexpr int kByRoom = 3;

  Roster& roster_;
  const Problem& problem_;
  const Timeline& timeline_;
  const Trial* trial_ = nullptr;
  StationCalls* calls_;
  UnitInsertion best_;
  std::unique_ptr<Roster> scratch_;  // in which ways to place inseparable units are judged
  std::vector<Candidate> places_to_judge_;
  // Of a transport.
  Labels second_labels_{0.0, 1.0};
  double second_ready_ = 0.0, second_latest_ = kNever, second_tail_ = 0.0, after_ = 0.0, within_ = kNever;
  std::vector<char> may_transport_;
  std::vector<int> empty_twin_;
  // Of the unit.
  Labels labels_{0.0, 1.0};
  double ready_ = 0.0, peak_ = 0.0;
  double measured_work_ = -1.0, latest_ = kNever, tail_ = 0.0;  // of a task alone, for that work
  Relations relations_;
  bool looks_ahead_ = false;  // to tasks that its robots have to do too, and are not in the plan
  std::vector<std::pair<int, int>> ranges_;
  // Of cuts.
  TeamChoice choice_;
  Rows teams_;
  std::vector<Cut> cuts_;
  bool skips_cuts_ = false;      // whether some cuts alone are tried
  std::vector<int> near_units_;  // behind which they are
  std::vector<char> near_;       // by unit, the same while cuts are gathered
  std::vector<double> keys_, works_;
  std::vector<int> candidates_, at_, robots_;
  std::vector<int> candidate_of_;  // by robot; -1: it is none
  std::vector<int> passed_;        // candidates whose places are others than those of their offers
  std::vector<Offer> offers_;      // tasks of the unit x candidates
  std::vector<Part> team_;         // the members that are judged
  // By key: of each candidate whether its place is another than when teams were last chosen, and how that ranked them.
  std::array<std::vector<char>, kKeys> moved_;
  std::array<TeamChoice::Ranking, kKeys> rankings_;
  std::vector<char> busy_, everyone_;
};

}  // namespace muster
