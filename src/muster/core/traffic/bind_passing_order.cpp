#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "traffic/passing_order.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Pair = std::pair<double, double>;
using PlannedMove = std::tuple<int, Pair, int, double>;  // robot, to, stop, speed

Point point_of(const Pair& pair) { return {pair.first, pair.second}; }
Pair pair_of(const Point& point) { return {point.x, point.y}; }

std::vector<Pair> pairs_of(const std::vector<Point>& points) {
  std::vector<Pair> pairs;
  for (const Point& point : points) pairs.push_back(pair_of(point));
  return pairs;
}

// An order with the numbers of robots checked, where Python passes them.
class CheckedOrder {
 public:
  CheckedOrder(double margin, double ahead, std::vector<LimitedLane> lanes) : order_(margin, ahead, std::move(lanes)) {}

  int add(Pair place, double radius) { return robots_ = order_.add(point_of(place), radius) + 1, robots_ - 1; }
  void stands(int robot, Pair place) { checked(robot).stands(robot, point_of(place)); }
  bool append(int robot, Pair to, int stop, double speed) {
    return checked(robot).append(robot, point_of(to), stop, speed);
  }
  void lead(int robot, int stop) { checked(robot).lead(robot, stop); }
  void extend(const std::vector<PlannedMove>& moves) {
    std::vector<char> ended(robots_, false);
    for (const auto& [robot, to, stop, speed] : moves)
      if (!ended[checked_number(robot)]) ended[robot] = !order_.append(robot, point_of(to), stop, speed);
  }
  CheckedOrder hold(const std::vector<double>& metres) {
    if (static_cast<int>(metres.size()) != robots_) throw std::invalid_argument("metres: expected one for each robot");
    CheckedOrder kept(order_.hold(metres));
    kept.robots_ = robots_;
    return kept;
  }
  void release() { order_.release(); }
  void adopt(CheckedOrder& planned) {
    if (planned.robots_ != robots_) throw std::invalid_argument("planned: robots were added since");
    order_.adopt(std::move(planned.order_));
  }
  void cut() { order_.cut(); }
  void stop(int robot, Pair place) { checked(robot).stop(robot, point_of(place)); }
  void progress(int robot, int passed, Pair near) { checked(robot).progress(robot, passed, point_of(near)); }
  PassingOrder::Grant grant(int robot) { return checked(robot).grant(robot); }
  Pair end(int robot) { return pair_of(checked(robot).end(robot)); }
  Pair stand(int robot) { return pair_of(checked(robot).stand(robot)); }
  int passed(int robot) { return checked(robot).passed(robot); }
  double metres_left(int robot) { return checked(robot).metres_left(robot); }

 private:
  explicit CheckedOrder(PassingOrder order) : order_(std::move(order)) {}
  int checked_number(int robot) const {
    if (robot < 0 || robot >= robots_) throw std::invalid_argument("robot: not in the order");
    return robot;
  }
  PassingOrder& checked(int robot) {
    checked_number(robot);
    return order_;
  }

  PassingOrder order_;
  int robots_ = 0;
};

}  // namespace

void bind_passing_order(nb::module_& m) {
  nb::class_<PassingOrder::Grant>(m, "Grant", "How far a robot may go along its moves.")
      .def_prop_ro(
          "points", [](const PassingOrder::Grant& grant) { return pairs_of(grant.points); },
          "Ends of moves, in metres; the last may lie within a move.")
      .def_ro("speeds", &PassingOrder::Grant::speeds, "The greatest on the way to each of these, in m/s; inf: any.")
      .def_ro("ended", &PassingOrder::Grant::ended, "How many of these are ends of moves.")
      .def_ro("metres", &PassingOrder::Grant::metres, "From where the robot is.")
      .def_ro("waits_for", &PassingOrder::Grant::waits_for, "The robot that passes first; -1: none.")
      .def_ro("last", &PassingOrder::Grant::last, "Whether all its moves to its stop are granted.");

  nb::class_<LimitedLane>(m, "LimitedLane", "A lane on which only so many robots may be at once; metres.")
      .def(
          "__init__",
          [](LimitedLane* lane, Pair from, Pair to, int most, bool both_ways) {
            new (lane) LimitedLane(point_of(from), point_of(to), most, both_ways);
          },
          "start"_a, "end"_a, nb::kw_only(), "most"_a, "both_ways"_a = false, "`most`: how many, between its ends.");

  nb::class_<CheckedOrder>(m, "PassingOrder",
                           "The order in which robots pass: one sequence of straight moves, by order and not by clock "
                           "[hoenig2019]. Places are in metres.")
      .def(
          nb::init<double, double, std::vector<LimitedLane>>(), nb::kw_only(), "margin"_a, "ahead"_a,
          "lanes"_a = std::vector<LimitedLane>(),
          "Metres that are left between robots, and for which a robot may have begun moves; the lanes on which only so "
          "many may be.")
      .def("__copy__", [](const CheckedOrder& order) { return order; })
      .def("add", &CheckedOrder::add, "place"_a, "radius"_a, "A robot that stands; returns its number.")
      .def("stands", &CheckedOrder::stands, "robot"_a, "place"_a,
           "A robot stands elsewhere than was thought; nothing changes where it has moves.")
      .def("append", &CheckedOrder::append, "robot"_a, "to"_a, "stop"_a = 0,
           "speed"_a = std::numeric_limits<double>::infinity(),
           "A move from where the robot's moves end; False where another would stand in the way, or too many on a "
           "lane. `stop`: the number of the stop to which it leads; `speed`: the greatest on it.")
      .def("lead", &CheckedOrder::lead, "robot"_a, "stop"_a,
           "Let a robot go as far as this stop of its moves, 0 at first; others are planned after the rest, too.")
      .def("extend", &CheckedOrder::extend, "moves"_a, nb::call_guard<nb::gil_scoped_release>(),
           "Append moves (robot, to, stop, speed); those of a robot after one that is not appended are left out.")
      .def("hold", &CheckedOrder::hold, "metres"_a,
           "While a plan is made, let only those moves begin that each robot begins within so many metres, up to its "
           "stop, and that depend on no other. Returns the order of these: a plan appends its moves to it.")
      .def("release", &CheckedOrder::release, "No plan comes: all moves may begin again.")
      .def("adopt", &CheckedOrder::adopt, "planned"_a,
           "Replace the moves that were not to begin by those of a plan, appended to what `hold` returned, which is "
           "used up.")
      .def("cut", &CheckedOrder::cut, "Let all moves end where robots have been let go to.")
      .def("stop", &CheckedOrder::stop, "robot"_a, "place"_a,
           "A robot that has been let go further stands here, for all that is known: its moves are dropped.")
      .def("progress", &CheckedOrder::progress, "robot"_a, "passed"_a, "near"_a,
           "A robot has passed the ends of so many of its moves in all, and is near a place.")
      .def("grant", &CheckedOrder::grant, "robot"_a, "How far a robot may go now; what it is told it keeps.")
      .def("end", &CheckedOrder::end, "robot"_a, "Where a robot is after all its moves.")
      .def("stand", &CheckedOrder::stand, "robot"_a, "Where its stop is.")
      .def("passed", &CheckedOrder::passed, "robot"_a, "Moves that a robot has finished since it was added.")
      .def("metres_left", &CheckedOrder::metres_left, "robot"_a, "Metres that a robot has still to go to its stop.");
}

}  // namespace muster
