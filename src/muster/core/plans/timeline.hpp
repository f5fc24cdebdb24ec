// The schedule of routes while they change: when each unit of work begins at the earliest and at the latest.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "infinity.hpp"
#include "plans/problem.hpp"
#include "plans/routes.hpp"
#include "plans/unit_queue.hpp"

namespace muster {

// One robot at one task. Each route begins with a visit of the robot's start and closes with one of its end.
struct alignas(64) Visit {  // a line of memory each, as propagation waits for little else
  int robot = -1;
  int place = -1;   // of the problem: a task, a start or an end
  int unit = -1;    // none: a start or an end
  int at = 0;       // in the route, where the start is 0
  int last = -1;    // the visit before it
  int next = -1;    // the visit after it
  double in = 0.0;  // the time of the way here from the visit before
  double label = 0.0;
  double leave = 0.0;      // when the robot can set out from here
  double latest = kNever;  // when it must begin here, for all that comes after to be in time
  double tail = 0.0;       // from the begin here to the end of all that waits for it
};

// A robot that does a task of a unit, at a place of its route: 0 is before all tasks.
struct Member {
  int task = -1;
  int robot = -1;
  int at = 0;
};

// The way to a stop: all its seconds; of a robot that rests, and calls at stations on it, those of each leg to one, and
// how long it stays there.
struct WayIn {
  struct Leg {
    double seconds, stays;
    bool operator==(const Leg&) const = default;
  };
  double seconds = 0.0;
  std::vector<Leg> legs;
  double last = 0.0;  // of the leg after the stations
  bool operator==(const WayIn&) const = default;
};

// An open interval of labels.
struct Labels {
  double low;
  double high;
  bool empty() const { return !(low < high); }
};

// The graph whose nodes are units of work (a task with its team, or tasks that start together) and whose arcs are legs
// of routes and prerequisites with gaps. Heads (earliest begins), latest begins and tails are kept as in insertion
// methods for the job shop [mastrolilli2000]. Units carry labels that rise along every arc, so that a change is
// propagated once through the part that it affects, in topological order [pearce2006]. A label strictly between those
// of what comes before and after keeps it; labels are renewed in order of time at `commit`.
//
// Maximum gaps, and greatest lengths of routes, make cycles of lower bounds: where a problem has any, begins are the
// least fixpoint, found anew.
class Timeline {
 public:
  explicit Timeline(const Problem& problem);

  // Takes over routes. False: they deadlock, or have no schedule.
  bool begin(const Routes& routes);

  bool present(int unit) const { return !nodes_[unit].visits.empty(); }
  double begin_of(int unit) const { return nodes_[unit].begin; }
  // -inf where it is absent.
  double end_of(int task) const { return ends_[task]; }
  double work_of(int task) const { return work_[task]; }
  double latest_of(int unit) const { return nodes_[unit].latest; }
  double tail_of(int unit) const { return nodes_[unit].tail; }
  double label_of(int unit) const { return nodes_[unit].label; }
  std::span<const int> visits_of(int unit) const { return nodes_[unit].visits; }
  const Visit& visit(int number) const { return visits_[number]; }
  // The place of a task in a robot's route; -1: the robot does not do it. A unit has a visit for each of its tasks and
  // for each member of a team.
  int place_of(int task, int robot) const {
    for (const int number : nodes_[problem_.unit(task)].visits) {
      if (visits_[number].robot == robot && visits_[number].place == task) return visits_[number].at;
    }
    return -1;
  }
  // The visits of a route, start and end included.
  const std::vector<int>& route(int robot) const { return routes_[robot]; }
  int tasks_in(int robot) const { return static_cast<int>(routes_[robot].size()) - 2; }
  const Visit& stop(int robot, int at) const { return visits_[routes_[robot][at]]; }

  // When a robot leaves a stop of its route as it is: its start no sooner than its end is soon enough after that.
  double leave(int robot, int at) const { return at == 0 ? departure(robot) : stop(robot, at).leave; }
  // When a robot is at a stop that it goes to from the one before as soon as it can.
  double arrival(const Visit& visit) const { return after_way(visit, leave(visit.robot, visit.at - 1)); }

  // What the prerequisites and dependants of a unit that is absent allow; those absent too pass on what they wait for.
  Labels labels_for(int unit);
  // What its present prerequisites allow: no earlier than this, openings aside.
  double ready(int unit) const;
  // Until when it must begin for its openings and present dependants, if its tasks take so long as `work` says.
  double latest_for(int unit, std::span<const double> work) const;
  // How long all that waits for a unit's end takes after the begin, routes aside.
  double tail_after(int unit, std::span<const double> work) const;
  // The first time from `earliest` on that the openings of all its tasks allow.
  double open(int unit, double earliest) const;
  // The last time up to `latest` that they allow, each for itself.
  double last_open(int unit, double latest) const;
  bool in_time(double begin, double latest) const {
    return begin <= latest + kRounding * (latest < 1.0 ? 1.0 : latest);
  }

  std::span<const double> works() const { return work_; }
  // The way to a stop takes so long, with what the robot does on it. Begins are propagated later, as of `insert`.
  void set_way(int robot, int at, const WayIn& way);
  // The same, where all times are already those of these ways.
  void restore_way(int robot, int at, const WayIn& way);

  // Both leave times as they were until `settle`. A unit goes in at a label between those of its neighbours in every
  // route, within `labels_for`, and below that of the unit `before`, if there is any.
  void insert(int unit, std::span<const Member> members, int before = -1);
  void remove(int unit);
  // Propagates what was changed. False: no schedule exists; then only `rollback` helps.
  bool settle();
  // The same for begins alone; latest begins and tails are those of before, until `settle` or `commit`.
  bool settle_begins();

  // When the last task ends, or the last robot is at its end where that counts.
  double end() const;
  double end_of_route(int robot) const;
  // One after the other the units that the end waits for, the last first.
  void critical(std::vector<int>& units) const;

  void commit();
  void rollback();
  // The units whose times the last `commit` may have changed.
  std::span<const int> committed() const { return committed_; }
  // How many times labels were put in order of time.
  int relabelings() const { return relabelings_; }

 private:
  // Between a task and one that has to wait for it, as one of the two units sees it.
  struct Arc {
    int unit;  // the other one
    int task;  // of the other one
    int own;   // the unit's own task, as one of `tasks_of_unit`
    double after;
    double within;
  };
  struct Arcs {  // of all units, one unit's after the other's
    std::vector<int> first{0};
    std::vector<Arc> all;

    std::span<const Arc> operator[](int unit) const { return {all.data() + first[unit], all.data() + first[unit + 1]}; }
    void add(const std::vector<Arc>& arcs) {
      all.insert(all.end(), arcs.begin(), arcs.end());
      first.push_back(static_cast<int>(all.size()));
    }
  };
  struct alignas(64) Node {
    std::vector<int> visits;
    int task = -1;  // its only one, if it has only one
    int saved = 0;  // the step in which its times were saved
    double label = 0.0, begin = 0.0, latest = kNever, tail = 0.0;
  };
  struct Times {
    int unit;
    double begin, latest, tail;
  };
  struct Change {
    int unit;
    bool inserted;
    int first;  // of its visits in `taken_`, where it was removed
    double label;
  };
  static constexpr double kRounding = 1e-11;

  void build_arcs();
  bool label_topologically(const Routes& routes);
  std::vector<double*> all_labels();
  void spread(const std::vector<double*>& labels);
  void relabel();
  void set_label(int unit, double label);
  Labels between(std::span<const Member> members) const;
  void seek_labels(int unit, bool back, Labels& labels);

  int new_visit(const Member& member, int unit);
  void put(int number, int at);
  void take(int number);
  void vanish(int unit);
  void measure_work(int unit);
  void restore(const Change& change);

  void join(int number, int next);
  const Visit& before(const Visit& v) const { return visits_[v.last]; }
  const Visit& behind(const Visit& v) const { return visits_[v.next]; }

  void queue_forward(int unit) { forward_.push(nodes_[unit].label, unit); }
  void queue_backward(int unit) {
    if (looks_back_) backward_.push(nodes_[unit].label, unit);
  }
  void queue_later(int unit);
  void queue_earlier(int unit);
  void queue_all();
  void drop_queues();
  bool forward();
  void backward();
  void renew_budget();
  bool has_cycles() const { return has_gap_most_ || has_lasts_most_; }
  bool settle_cycles();
  double departure(int robot) const;
  double after_way(const Visit& visit, double leave) const;
  double before_way(const Visit& visit, double latest) const;
  double earliest_begin(int unit);
  double begin_of_spans(int unit, double earliest) const;
  double latest_begin(int unit);
  double longest_tail(int unit);
  std::span<const double> works_of(int unit);
  bool keeps_bounds(int unit) const;
  void set_begin(int unit, double begin);
  void set_latest(int unit, double latest, double tail);
  int holder_of(int unit) const;
  void save(int unit);

  const Problem& problem_;
  bool has_openings_, has_limits_, has_gap_most_, has_lasts_most_, has_spans_, has_tails_;
  bool looks_back_;
  Arcs before_, behind_;       // by unit: prerequisites, dependants
  std::vector<Visit> visits_;  // starts, ends, then those of tasks
  std::vector<WayIn> ways_;    // by visit, where robots rest: that with calls at stations, else empty
  std::vector<int> free_;
  std::vector<std::vector<int>> routes_;
  std::vector<Node> nodes_;
  std::vector<double> work_;  // by task, of its slowest member
  // What prerequisites and dependants ask for: when a task ends, and the tail of a unit; -inf where they are absent.
  std::vector<double> ends_, tails_;
  UnitQueue forward_, backward_;
  int budget_ = 0;  // units that a propagation still looks at before it gives up
  std::vector<double> works_;
  // Undo.
  int step_ = 1;
  std::vector<Change> changes_;
  std::vector<int> taken_;
  std::vector<Times> times_;
  std::vector<int> committed_;
  int relabelings_ = 0;
  std::size_t unsorted_ = 0;  // units placed since labels were in order of time
  // Of `seek_labels`.
  int stamp_ = 0;
  std::vector<int> stamp_of_, stack_;
};

}  // namespace muster
