// Routes while an algorithm changes them, where tasks are bound to times, teams and relations.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "plans/draft.hpp"
#include "plans/station_calls.hpp"
#include "plans/timeline.hpp"
#include "random.hpp"

namespace muster {

// A unit of work and the robots that do it, at places of their routes.
struct PlacedUnit {
  int unit = -1;
  std::vector<Member> members;
  int before = -1;  // a unit that it comes before, beside those in its routes; -1: none
};

// A unit of work with the robots that do it. `score` is what the objective grows by, ties broken by the routes' growth.
// With a transport all units are placed that are inseparable: after the first the others, at places in the routes that
// have those before.
struct UnitInsertion : PlacedUnit {
  double score = kNever;
  double growth = 0.0;  // of usage, all members together
  std::vector<PlacedUnit> others;
};

// Where `best_insertion` looks.
struct Trial {
  bool append_only = false;                      // at the ends of routes alone
  int most_places = 0;                           // beyond so many only places beside near tasks; 0: at every place
  double blink = 0.0;                            // how often a place is overlooked
  Random* random = nullptr;                      // for that
  const class Neighbours* neighbours = nullptr;  // for `most_places`
  double latest_end = kNever;                    // of objective `makespan`: no place at which the mission ends later
  const std::vector<char>* robots = nullptr;     // by robot, whether it may be a member; none: all
  bool quantised = false;                        // whether places and teams are compared in quanta
};

struct StopTimes {
  int place;  // a task or a station
  double arrive, begin, end;
  double refilled = 0.0;
};

// Working routes of a timed problem on a Timeline, with the team of every task, usages and undo. Everything that
// changes routes stands between `commit` or `rollback` and the next.
class Roster {
 public:
  explicit Roster(const Problem& problem);
  ~Roster();

  // Takes over routes. False: no schedule exists for them.
  bool begin(const Routes& routes);

  const Problem& problem() const { return problem_; }
  const Timeline& timeline() const { return timeline_; }
  bool present(int unit) const { return timeline_.present(unit); }
  // Whether all that a unit waits for is present, what is inseparable from it aside.
  bool ready(int unit) const;
  // Whether a task is present that excludes one of a unit, or of what is inseparable from it.
  bool barred(int unit) const;
  // Whether a unit stays where it is.
  bool fixed(int unit) const;
  // The units that are in no route.
  const std::vector<int>& absent() const { return absent_; }
  double absent_weight() const { return absent_weight_; }
  double weight(int unit) const { return weight_[unit]; }
  double usage(int robot) const { return usage_[robot]; }
  // What a robot has on board after so many tasks; and the most and the least from there on.
  double load(int robot, int at, int meter) const { return loads_[robot][index(at, meter)]; }
  double highest_load(int robot, int at, int meter) const { return highest_[robot][index(at, meter)]; }
  double lowest_load(int robot, int at, int meter) const { return lowest_[robot][index(at, meter)]; }
  StationCalls* calls() { return calls_.get(); }

  // The team and the places at which an absent unit costs least; null where there are none. All that it waits for must
  // be present. The answer lasts until the next call.
  const UnitInsertion* best_insertion(int unit, const Trial& trial = {});
  // False: no schedule exists; then only `rollback` helps. Begins are propagated at once.
  bool insert(const UnitInsertion& insertion);
  // Puts a unit that is one task of one robot behind all others of its route, of a transport that alone. False: it must
  // come before what is there. Begins are propagated later.
  bool append(int unit, int robot);
  // Takes out a unit, and all that is inseparable from it.
  void remove(int unit);
  // Takes out what a plan cannot hold when nothing more comes to it: what stands without its prerequisites, with
  // everything that waits for it. `trial` says where what is taken out may be tried again. False: no schedule exists
  // for the rest. Begins are propagated, as by `settle_begins`.
  bool finish(const Trial& trial = {});
  // Propagates removals, which `best_insertion` does on its own.
  bool settle();
  // The same for begins alone, on which objectives depend.
  bool settle_begins();
  // Whether the routes changed since the last commit are within the robots' capacities, and stations serve everybody in
  // time.
  bool admissible();

  // Whether every present unit has all of its tasks, prerequisites and robots, and relations hold: of routes that
  // others made.
  bool keeps_rules() const;
  // Whether the robots of a present task may do it together, as far as rules about robots tell.
  bool has_rightful_team(int task, class TeamChoice& choice) const;

  // Of the present units.
  double objective();
  Value value();
  // What the objective's greatest term comes to: usage of one robot, or the mission's end.
  double peak();

  void commit();
  void rollback();

  // The robots that do a task, in order.
  std::vector<int> team_of(int task) const;
  Routes routes() const;
  std::vector<std::vector<StopTimes>> stops() const;

 private:
  friend class Placement;
  void drop_orphans();
  struct Saved {
    int robot;
    double usage;
    bool holds;
    std::vector<Call> calls;
    Called called;
  };

  void touch(int robot);
  bool measure_changed();
  void measure(int robot);
  bool measure_loads(int robot);
  bool call_at_stations(int robot);
  void set_ways(int robot, bool restored);
  void add_calls(int robot, int at, std::vector<StopTimes>& stops) const;
  bool serve();
  bool crowded() const;
  double arrival(int robot, std::size_t number) const;
  void put_in(const PlacedUnit& placed);
  void take_out(int unit);
  bool comes_after(int task, int other) const;
  const std::vector<int>& tasks_of(int robot);
  void appear(int unit);
  void vanish(int unit);
  double total() const;
  double lateness() const;
  double arrivals() const;
  std::size_t index(int at, int meter) const { return static_cast<std::size_t>(at) * problem_.meters() + meter; }

  const Problem& problem_;
  Timeline timeline_;
  bool has_fixed_;              // whether any robot has tasks that stay
  std::vector<double> weight_;  // by unit
  std::vector<double> usage_;   // by robot
  std::vector<int> absent_, listed_;
  double absent_weight_ = 0.0;
  // Undo: what happened to units, the last at the end.
  std::vector<std::pair<int, bool>> moves_;
  std::vector<Saved> saved_;
  std::vector<char> touched_;
  std::vector<int> unmeasured_;
  // Goods and energy.
  std::unique_ptr<StationCalls> calls_;                        // where any robot may run short
  std::vector<char> holds_;                                    // by robot, whether loads and energy last
  std::vector<std::vector<double>> highest_, lowest_, loads_;  // by robot, of loads (stops, meters) from a stop on
  std::vector<int> tasks_;
  std::unique_ptr<class Placement> placement_;
};

}  // namespace muster
