// The compiled question: arrays that no algorithm changes.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace muster {

enum class Objective { total, max, total_max, average, makespan, lateness };

// Rows of different lengths in one array: row i is values[first[i]] .. values[first[i + 1]].
struct Rows {
  std::vector<int> first{0};
  std::vector<int> values;

  std::span<const int> operator[](int i) const {
    return {values.data() + first[i], static_cast<std::size_t>(first[i + 1] - first[i])};
  }
  int size() const { return static_cast<int>(first.size()) - 1; }
};

struct Opening {
  double open;
  double close;
};

using Spans = std::vector<Opening>;  // sorted and apart

// So many robots of the kinds that are allowed.
struct TeamPart {
  int count;
  std::vector<char> allowed;  // by kind
};

// A place where robots take up energy, by and by or at once (a swap), or unload.
struct Station {
  double refill = 0.0;   // of usage, by second; 0: none is taken up by and by
  double swap_s = -1.0;  // how long a swap takes; below 0: nobody swaps here
  bool unloads = false;
  bool partial = true;  // whether a refill may end before all is full
  int slots = 1;

  bool gives_energy() const { return refill > 0.0 || swap_s >= 0.0; }
};

// Everything a Problem is made from. Places are the tasks, the robots' starts, the robots' ends, then the stations.
struct ProblemData {
  Objective objective = Objective::total_max;
  bool usage_is_time = false;
  // Robots.
  std::vector<double> capacity;  // inf: unlimited
  std::vector<double> speed;
  std::vector<double> available_from;
  std::vector<char> must_end;  // the route goes on to the robot's end
  std::vector<int> fixed;      // tasks at the beginning of the route that stay where they are
  // Tasks.
  std::vector<double> actuation_cost;  // work classes x tasks
  std::vector<int> work_class;         // of each robot
  std::vector<double> work_seconds;    // time classes x tasks
  std::vector<int> time_class;         // of each robot
  std::vector<double> priority;
  std::vector<int> kind;      // of each robot
  std::vector<char> allowed;  // kinds x tasks
  Rows prerequisites;
  // Travel: coordinates (place classes x places x 3) with each robot's class; or a table (classes x places x places)
  // with each robot's class.
  std::vector<double> entry;
  std::vector<double> exit;
  std::vector<int> place_class;
  std::vector<double> table;
  std::vector<int> travel_class;
  // How long these ways take, as the table has them: where neither their metres nor their ends tell. Empty: these do.
  std::vector<double> seconds;
  // Times, teams and relations; what is empty, no task or robot has.
  std::vector<std::vector<Opening>> openings;  // by task, sorted
  std::vector<double> ends_by, due;            // by task; inf: none
  std::vector<double> over_by;                 // by robot; inf: without end
  std::vector<double> lasts_most;              // by robot: the most time from its start to its end; inf: any
  std::vector<Spans> spans;                    // by robot: when it drives and works; empty: at any time
  std::vector<int> least_stops;                // by robot: the least number of tasks of a route that has any
  std::vector<double> gap_least, gap_most;     // gaps, parallel to prerequisites.values; 0 and inf: none
  std::vector<int> unit;                       // by task: its number of a node; tasks that start together share it
  std::vector<std::vector<TeamPart>> parts;    // by task
  std::vector<double> abilities, needs;        // robots x A, tasks x A
  Rows exclusive;                              // symmetric: of two tasks at most one is done
  Rows same_crew, apart;                       // symmetric
  std::vector<double> acceleration, climb;     // by robot; inf: no limit
  std::vector<double> turn;                    // by robot: seconds of the turn with which a leg begins
  bool over_map = false;                       // what is longer than the straight way has bends
  bool makespan_includes_return = false;
  // Goods: what a task adds to the load, and how much of that another task delivers (tasks x meters); the task
  // that takes on what a task delivers, -1: it delivers nothing; robots x meters.
  int meters = 0;
  std::vector<double> load, pending;
  std::vector<int> pickup;
  std::vector<double> most_aboard, aboard_at_start;
  std::vector<double> pending_at_start;  // what of the load at first tasks deliver; empty: nothing
  // Energy: above what a energy must keep; inf: without a limit of energy. By robot.
  std::vector<double> energy, energy_at_start;
  std::vector<Station> stations;
  std::vector<char> calls;  // robots x stations: whether a robot may call there; empty: everybody may
  std::vector<char> over;   // by task, whether it stands for what was done; empty: none does
  // What is waited for others on the way between two places (places x places, seconds), by robots that share lanes;
  // empty: nothing.
  std::vector<double> waiting;
  std::vector<char> waits;  // of each robot: whether it does
};

// Usage of a route, and the sum over its tasks of the usage on arrival (docs/design.md, Meaning: objective `average`).
struct RouteFigures {
  double usage = 0.0;
  double arrivals = 0.0;
};

class Problem {
 public:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  explicit Problem(ProblemData data);

  int tasks() const { return tasks_; }
  int robots() const { return robots_; }
  int classes() const { return classes_; }
  Objective objective() const { return data_.objective; }
  bool has_prerequisites() const { return !data_.prerequisites.values.empty(); }
  std::span<const int> prerequisites(int task) const { return data_.prerequisites[task]; }
  std::span<const int> dependants(int task) const { return dependants_[task]; }
  std::span<const int> robots_allowed(int task) const { return robots_allowed_[like_[task]]; }
  bool allowed(int robot, int task) const {
    return data_.allowed[static_cast<std::size_t>(data_.kind[robot]) * tasks_ + task] != 0;
  }
  double capacity(int robot) const { return data_.capacity[robot]; }
  double available_from(int robot) const { return data_.available_from[robot]; }
  double priority(int task) const { return data_.priority[task]; }
  bool must_end(int robot) const { return data_.must_end[robot] != 0; }
  // How many tasks at the beginning of the robot's route stay: the first place where another may go.
  int fixed(int robot) const { return data_.fixed[robot]; }

  // Whether anything binds tasks to times, teams, relations or whole routes: routes with one task each do not tell all
  // then.
  bool is_timed() const { return timed_; }
  bool has_openings() const { return !data_.openings.empty(); }
  // Whether work or routes must be over by a time: openings, latest ends, ends of routes, spans of robots.
  bool has_time_limits() const {
    return has_openings() || !data_.ends_by.empty() || !data_.over_by.empty() || has_spans();
  }
  double ends_by(int task) const { return data_.ends_by.empty() ? kInfinity : data_.ends_by[task]; }
  double due(int task) const { return data_.due.empty() ? kInfinity : data_.due[task]; }
  double over_by(int robot) const { return data_.over_by.empty() ? kInfinity : data_.over_by[robot]; }
  // From leaving its start to the end of its route a robot takes at most so long.
  bool has_lasts_most() const { return !data_.lasts_most.empty(); }
  double lasts_most(int robot) const { return data_.lasts_most.empty() ? kInfinity : data_.lasts_most[robot]; }
  // Whether some robots rest: they drive and work in spans alone.
  bool has_spans() const { return !data_.spans.empty(); }
  bool rests(int robot) const { return has_spans() && !data_.spans[robot].empty(); }
  // The first time from `earliest` on from which a robot can be busy for so long without a rest; inf: none is left.
  double set_out(int robot, double earliest, double seconds) const {
    if (!rests(robot)) return earliest;
    for (const Opening& span : data_.spans[robot]) {
      const double begin = earliest < span.open ? span.open : earliest;
      if (ends_within(begin + seconds, span.close)) return begin;
    }
    return kInfinity;
  }
  // The last time from which it can be so, and be done by `latest`; -inf: none is.
  double last_set_out(int robot, double latest, double seconds) const {
    if (!rests(robot)) return latest - seconds;
    const auto& spans = data_.spans[robot];
    for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
      const double begin = (latest < span->close ? latest : span->close) - seconds;
      if (ends_within(span->open, begin)) return begin;
    }
    return -kInfinity;
  }
  // When a robot that may leave a place at a time is at another, so many seconds away.
  double arrives(int robot, double leave, double seconds) const { return set_out(robot, leave, seconds) + seconds; }
  bool has_least_stops() const { return !data_.least_stops.empty(); }
  int least_stops(int robot) const { return data_.least_stops.empty() ? 0 : data_.least_stops[robot]; }
  // Of a task's prerequisite number k: the least and the most time between its end and the task's begin.
  double gap_least(int task, int k) const {
    return data_.gap_least.empty() ? 0.0 : data_.gap_least[data_.prerequisites.first[task] + k];
  }
  double gap_most(int task, int k) const {
    return data_.gap_most.empty() ? kInfinity : data_.gap_most[data_.prerequisites.first[task] + k];
  }
  bool has_gap_most() const { return !data_.gap_most.empty(); }
  int units() const { return tasks_of_unit_.size(); }
  int unit(int task) const { return data_.unit.empty() ? task : data_.unit[task]; }
  std::span<const int> tasks_of_unit(int unit) const { return tasks_of_unit_[unit]; }
  // The first time from `earliest` on at which work may begin; inf if none is left.
  double next_begin(int task, double earliest) const {
    if (data_.openings.empty() || data_.openings[task].empty()) return earliest;
    for (const Opening& opening : data_.openings[task]) {
      if (earliest <= opening.close) return earliest < opening.open ? opening.open : earliest;
    }
    return kInfinity;
  }
  // The last time up to `latest` at which work may begin; -inf if none is.
  double last_begin(int task, double latest) const {
    if (data_.openings.empty() || data_.openings[task].empty()) return latest;
    const auto& openings = data_.openings[task];
    for (auto opening = openings.rbegin(); opening != openings.rend(); ++opening) {
      if (latest >= opening->open) return latest < opening->close ? latest : opening->close;
    }
    return -kInfinity;
  }
  // The end of the opening in which work begins at this time.
  double last_begin_of_opening(int task, double begin) const {
    if (data_.openings.empty() || data_.openings[task].empty()) return kInfinity;
    for (const Opening& opening : data_.openings[task]) {
      if (begin <= opening.close) return opening.close;
    }
    return kInfinity;
  }
  // The robots that do the task together: parts of a team, or as many as have the abilities for it.
  std::span<const TeamPart> parts(int task) const {
    if (data_.parts.empty()) return {};
    return data_.parts[task];
  }
  int abilities() const {
    return data_.needs.empty() || tasks_ == 0 ? 0 : static_cast<int>(data_.needs.size()) / tasks_;
  }
  std::span<const double> ability(int robot) const {
    return {data_.abilities.data() + static_cast<std::size_t>(robot) * abilities(),
            static_cast<std::size_t>(abilities())};
  }
  std::span<const double> needs(int task) const {
    return {data_.needs.data() + static_cast<std::size_t>(task) * abilities(), static_cast<std::size_t>(abilities())};
  }
  int kind(int robot) const { return data_.kind[robot]; }
  std::span<const int> same_crew(int task) const {
    if (data_.same_crew.size() == 0) return {};
    return data_.same_crew[task];
  }
  std::span<const int> apart(int task) const {
    if (data_.apart.size() == 0) return {};
    return data_.apart[task];
  }
  std::span<const int> exclusive(int task) const {
    if (data_.exclusive.size() == 0) return {};
    return data_.exclusive[task];
  }
  bool has_exclusive() const { return data_.exclusive.size() > 0; }
  bool makespan_includes_return() const { return data_.makespan_includes_return; }

  int meters() const { return data_.meters; }
  // What a task adds to the load of a robot, and what of that another task delivers: below 0 where it is the one.
  double load(int task, int meter) const { return data_.load[at(task, meter)]; }
  double pending(int task, int meter) const { return data_.pending[at(task, meter)]; }
  double most_aboard(int robot, int meter) const { return data_.most_aboard[at(robot, meter)]; }
  double aboard_at_start(int robot, int meter) const { return data_.aboard_at_start[at(robot, meter)]; }
  double pending_at_start(int robot, int meter) const {
    return data_.pending_at_start.empty() ? 0.0 : data_.pending_at_start[at(robot, meter)];
  }
  // Whether a robot can have so much on board.
  bool carries(int robot, int meter, double load) const {
    const double most = most_aboard(robot, meter), rounding = 1e-12 * (most < kInfinity ? 1.0 + most : 1.0);
    return load >= -rounding && load <= most + rounding;
  }
  bool has_deliveries() const { return !data_.pickup.empty(); }
  // The task with which a task is one transport: that which takes on board what it delivers, or the one that delivers;
  // -1: there is none.
  int partner(int task) const { return data_.pickup.empty() ? -1 : partner_[task]; }
  // The units that can only be in a plan together with a unit, itself among them, in an order in which they can be
  // done: those of transports, and what waits for one of them while another waits for it. None: it stands alone.
  std::span<const int> inseparable(int unit) const {
    return inseparable_.size() == 0 ? std::span<const int>() : inseparable_[unit];
  }
  bool delivers(int task) const { return !data_.pickup.empty() && data_.pickup[task] >= 0; }
  int stations() const { return static_cast<int>(data_.stations.size()); }
  const Station& station(int number) const { return data_.stations[number]; }
  bool may_call(int robot, int station) const {
    return data_.calls.empty() || data_.calls[static_cast<std::size_t>(robot) * stations() + station] != 0;
  }
  bool has_call_limits() const { return !data_.calls.empty(); }
  bool is_over(int task) const { return !data_.over.empty() && data_.over[task] != 0; }
  int place_of_station(int number) const { return tasks_ + 2 * robots_ + number; }
  // What a energy can hold, and holds at first, above its reserve; inf: without a limit of energy.
  double energy(int robot) const { return data_.energy.empty() ? kInfinity : data_.energy[robot]; }
  double energy_at_start(int robot) const { return data_.energy.empty() ? kInfinity : data_.energy_at_start[robot]; }
  // Whether robots can put down goods at a station.
  bool unloads_at_stations() const { return unloads_at_stations_; }
  // Whether the robot may have to call at stations, or can run out of energy.
  bool may_run_short(int robot) const { return may_run_short_[robot] != 0; }
  bool any_may_run_short() const { return any_may_run_short_; }
  // Whether more robots may be at a station than it serves.
  bool has_queues() const { return has_queues_; }
  bool usage_is_time() const { return data_.usage_is_time; }

  int start(int robot) const { return tasks_ + robot; }
  int end(int robot) const { return tasks_ + robots_ + robot; }
  // Whether tasks wait for nothing, and the objective sees usage alone: what a change of routes adds is then known from
  // where it is made.
  bool moves_freely() const {
    const Objective objective = data_.objective;
    return !timed_ && !has_prerequisites() &&
           (objective == Objective::total || objective == Objective::max || objective == Objective::total_max);
  }
  // Whether the way from a task to another costs what the way back does, for every robot.
  bool is_symmetric() const { return symmetric_; }
  // Whether a way through another task is never shorter, nor quicker: ways are straight and tasks end where they begin.
  bool detours_cost() const { return symmetric_ && steady_ && !given_table_; }
  // The first robot that differs from this one in nothing: of those without tasks one stands for all.
  int twin(int robot) const { return twins_[robot]; }
  // Whether two robots may do the same tasks, and one way costs both the same.
  bool alike(int robot, int other) const;

  int travel_class(int robot) const { return data_.travel_class.empty() ? 0 : data_.travel_class[robot]; }

  // Whether the mission gives travel as tables.
  bool has_table() const { return given_table_; }
  // Where a place is entered, in metres, by axis; for robots of the first class.
  double entry(int place, int axis) const { return data_.entry[3 * static_cast<std::size_t>(place) + axis]; }
  // Metres from the exit of one place to the entry of another.
  double distance(int travel_class, int from, int to) const {
    if (!data_.table.empty()) {
      return data_.table[(static_cast<std::size_t>(travel_class) * places_ + from) * places_ + to];
    }
    return straight(from, to);
  }

  double travel_time(int robot, int from, int to) const {
    const double metres = distance(travel_class(robot), from, to);
    return steady_ ? metres / data_.speed[robot] : leg_seconds(robot, from, to, metres);
  }
  double actuation_cost(int robot, int task) const {
    return data_.actuation_cost[static_cast<std::size_t>(data_.work_class[robot]) * tasks_ + task];
  }
  double work_time(int robot, int task) const {
    return data_.work_seconds[static_cast<std::size_t>(data_.time_class[robot]) * tasks_ + task];
  }
  double travel_usage(int robot, int from, int to) const {
    if (usage_is_metres_) return distance(travel_class(robot), from, to);
    if (data_.usage_is_time) return travel_time(robot, from, to);
    return distance(travel_class(robot), from, to) + waiting(robot, from, to) * data_.speed[robot];
  }
  double work_usage(int robot, int task) const {
    return data_.usage_is_time ? work_time(robot, task) : actuation_cost(robot, task);
  }
  // What the way from a place to the robot's end adds; 0 where the route may end anywhere.
  double end_usage(int robot, int from) const { return must_end(robot) ? travel_usage(robot, from, end(robot)) : 0.0; }

  // The usage after going on to a task and doing it. The additions are those of `walk`, in its order, so that the two
  // never disagree.
  double on_to(int robot, double usage, int from, int task) const {
    return usage + travel_usage(robot, from, task) + work_usage(robot, task);
  }

  // Whether a usage is within the robot's capacity. One that fills it exactly may come out above it by the rounding of
  // sums, for which there is room.
  bool fits(int robot, double usage) const {
    constexpr double kRounding = 1e-12;
    return std::isfinite(usage) && usage <= capacity(robot) * (1.0 + kRounding);
  }

  RouteFigures walk(int robot, std::span<const int> route) const;
  // What a task adds to the usage of a route, put at a place of it.
  double growth(int robot, std::span<const int> route, int task, int at) const;

 private:
  static bool ends_within(double end, double limit) {
    constexpr double kRounding = 1e-11;
    return end <= limit + kRounding * (limit < 1.0 ? 1.0 : limit);
  }
  void find_robots_allowed();
  void find_units();
  void find_transports();
  void find_inseparable();
  std::vector<int> in_order(std::vector<int> units) const;
  void find_twins();
  bool call_alike(int robot, int other) const;
  bool same_ends(int robot, int other) const;
  void find_who_may_run_short();
  void check_goods() const;
  std::size_t at(int row, int meter) const { return static_cast<std::size_t>(row) * data_.meters + meter; }
  bool find_symmetric() const;
  void check_times() const;
  double leg_seconds(int robot, int from, int to, double metres) const;
  double profile_seconds(int robot, int from, int to, double metres) const;
  double waiting(int robot, int from, int to) const {
    return !data_.waiting.empty() && data_.waits[robot] ? data_.waiting[static_cast<std::size_t>(from) * places_ + to]
                                                        : 0.0;
  }
  double ramped(int robot, double metres, double rise) const;
  double straight(int from, int to, int place_class = 0) const {
    const std::size_t first = static_cast<std::size_t>(place_class) * places_;
    const double* a = &data_.exit[3 * (first + from)];
    const double* b = &data_.entry[3 * (first + to)];
    const double dx = a[0] - b[0], dy = a[1] - b[1], dz = a[2] - b[2];
    return std::sqrt(dx * dx + dy * dy + dz * dz);
  }

  ProblemData data_;
  int tasks_;
  int robots_;
  int places_;
  int classes_;
  bool given_table_;
  bool steady_;           // legs take their metres by the speed, and nothing else
  bool usage_is_metres_;  // and nothing else
  bool timed_;
  bool symmetric_;
  Rows tasks_of_unit_;
  Rows inseparable_;
  std::vector<int> partner_, twins_;
  std::vector<char> may_run_short_;
  bool unloads_at_stations_ = false, any_may_run_short_ = false, has_queues_ = false;
  Rows dependants_;
  std::vector<int> like_;  // by task: a number that tasks share which the same robots may do
  Rows robots_allowed_;    // by that number
};

}  // namespace muster
