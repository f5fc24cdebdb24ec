// Where a robot calls at stations on its route: for energy, or to unload.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "plans/frontier.hpp"
#include "plans/problem.hpp"

namespace muster {

// A visit of a station on the way to a stop of a route.
struct Call {
  int at;           // before the task of this number in the route, or the end
  int station;      // its number
  double refilled;  // in the unit of usage
  double takes_s;   // of service
  double waits_s;   // for a slot
};

// What a route comes to with its calls; usage is infinite where the robot runs short wherever it calls.
struct Called {
  double usage;
  double end_s;        // as if it waited for no other robot; what the makespan counts
  double extra = 0.0;  // the sum of what the objective counts of each task: usage on arrival, or lateness
};

// The calls that a route needs, by labelling: at each stop of the route a robot can have used so much, and have so much
// energy by such times; of two labels the one that another covers is left out [desaulniers2016]. Stations are looked at
// where the rest of the route takes more than the robot has. A route is looked at by itself: what its tasks wait for
// elsewhere does not count.
class StationCalls {
 public:
  explicit StationCalls(const Problem& problem);

  // Takes over a robot's route. `works`: by task, how long it takes. False: the robot runs short.
  bool measure(int robot, std::span<const int> route, std::span<const double> works);
  const std::vector<Call>& calls(int robot) const { return routes_[robot].calls; }
  double usage(int robot) const { return routes_[robot].called.usage; }
  double end_s(int robot) const { return routes_[robot].called.end_s; }
  double extra(int robot) const { return routes_[robot].called.extra; }
  bool waits(int robot) const;
  void wait(int robot, std::size_t call, double seconds) { routes_[robot].calls[call].waits_s = seconds; }
  void forget_waits(int robot);
  // Puts back what `measure` found for the route as it was.
  void restore(int robot, std::span<const int> route, const Called& called, const std::vector<Call>& calls);

  // The route with a task after so many others; or with two, the second after so many others as well.
  Called with_task(int robot, int task, int at, std::span<const double> works);
  Called with_pair(int robot, int first, int at, int second, int second_at, std::span<const double> works);

  // When the robot can leave a stop of its route at the earliest, and must begin one at the latest, refilling aside.
  double earliest_leave(int robot, int at, std::span<const double> works);
  double latest_begin(int robot, int at, std::span<const double> works);

 private:
  struct Label {
    double usage;
    Frontier frontier;
    int parent;
    int station;   // where it is; -1: at a stop
    int unloaded;  // the stop after which the robot last unloaded; -1: never
    double extra = 0.0;
    double gap_s = 0.0;  // at a station: how long it is at least since the robot left the last stop
  };
  // Labels of each stop, the start included; those of stations stand between.
  struct Labels {
    std::vector<Label> all;
    std::vector<std::pair<int, int>> at_stop;
    std::vector<double> spare;           // by stop: by how much the rest of the route may grow and its labels stay all
    std::vector<double> loads, pending;  // (stops, meters) after each
    void clear();
  };
  struct Route {
    std::vector<int> tasks;
    Labels labels;
    bool labelled = false;
    Called called{0.0, 0.0};
    std::vector<Call> calls;
    std::vector<double> latest;  // by task, and of the end
  };

  Called run(int robot, Labels& labels, std::span<const int> rest, std::span<const double> works);
  Called try_from(int robot, int at, std::span<const double> works);
  double rest_usage(int robot, int from, std::span<const int> rest, std::span<const double> works) const;
  void begin(int robot, Labels& labels);
  void copy_labels(const Labels& labels, int stop);
  void label(int robot);
  void measure_gaps(int robot, int stop, std::span<const int> rest, std::span<const double> works);
  void measure_rest(int robot, int from, std::span<const int> rest, std::span<const double> works);
  bool cross(int robot, Labels& labels, int from, int to, double rest_before, double rest_after);
  bool arrive(int robot, Labels& labels, int parent, int from, int to, double rest_after);
  int call(int robot, Labels& labels, int parent, int from, int station);
  void call_again(int robot, Labels& labels, int to, double beyond);
  void refill_after_unloading(int robot, Labels& labels, int to, double needed);
  bool changes(int robot, const Labels& labels, const Label& label, const Station& station) const;
  void add(Labels& labels, Label&& label);
  double put_down(const Labels& labels, const Label& label, int meter) const;
  bool carry_alike(const Labels& labels, const Label& a, const Label& b) const;
  bool overloaded(int robot, const Labels& labels, const Label& label, int stop) const;
  bool runs_short(int robot, const Labels& labels, const Label& label, double rest);
  void carry(int robot, Labels& labels, int task) const;
  double work_usage(int robot, int task, std::span<const double> works) const;
  double least_onward(int robot, int from) const;
  std::span<const int> stations_between(int robot, int from, int to);
  int best_of(int robot, const Labels& labels) const;
  double needed_after_work(int robot, const Labels& labels, int last) const;
  static const Frontier& after_work(const Labels& labels, int last);
  bool ends_before_return(int robot) const;
  void trace(int robot, Route& route, int best, std::span<const double> works);
  bool serves(int robot, int station) const;

  const Problem& problem_;
  bool in_time_, unloads_, has_few_;
  std::vector<Route> routes_;  // by robot
  // Of a run.
  std::span<const double> works_;
  std::vector<double> rest_;  // by stop of the rest, usage from there to the end without calls
  std::vector<int> current_, deeper_, places_;
  int layer_ = 0, last_task_ = -1;
  double spare_ = kNever;           // of the labels up to the current stop
  std::vector<double> most_gap_s_;  // by task of the rest, how long the way to it may take for gaps between its tasks
  double gap_limit_s_ = kNever;     // of the way that is labelled
  std::vector<double> offsets_;
  Labels tried_;
  std::vector<int> sequence_;
  std::unordered_map<std::uint64_t, std::vector<int>> between_;
};

}  // namespace muster
