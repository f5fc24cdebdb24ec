#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "bindings.hpp"
#include "plans/team.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

// A team with bounds checked where Python passes indices.
class CheckedTeam : public Team {
 public:
  CheckedTeam(const Problem& problem, const Routes& routes)
      : Team(problem, (static_cast<void>(draft_from(problem, routes)), routes)), problem_(problem) {}

  void put(int task, int robot, int at) { insert(absent_task(task), after(robot, at)); }
  void take(int task) { remove(present_task(task)); }
  double growth_at(int robot, int task, int at) const { return growth(robot, absent_task(task), after(robot, at)); }
  double arrivals_at(int robot, int task, int at) {
    return later_arrivals(robot, task, after(robot, at), growth_at(robot, task, at));
  }
  double longer_at(int robot, int task, int at) const { return longer(robot, absent_task(task), after(robot, at)); }
  void turn_round(int first, int last) {
    if (robot_of(present_task(first)) != robot_of(present_task(last)) || before(last, first)) {
      throw std::invalid_argument("not a part of a route");
    }
    reverse(first, last);
  }
  void put_elsewhere(int first, int last, int robot, int at) {
    if (robot_of(present_task(first)) != robot_of(present_task(last)) || before(last, first)) {
      throw std::invalid_argument("not a part of a route");
    }
    const int place = after(robot, at);
    if (place == last || place == prev(first)) return;
    if (robot_of(first) == robot && !before(place, first) && !before(last, place)) {
      throw std::invalid_argument("the place is in that part");
    }
    move(first, last, place);
  }
  std::vector<std::pair<int, int>> bounds(int task) {
    bound(absent_task(task));
    std::vector<std::pair<int, int>> places;
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      places.emplace_back(rank(robot, earliest(robot)), rank(robot, latest(robot)) - 1);
    }
    return places;
  }
  std::vector<double> usages() const {
    std::vector<double> usages;
    for (int robot = 0; robot < problem_.robots(); ++robot) usages.push_back(usage(robot));
    return usages;
  }
  std::vector<double> all_arrivals() {
    std::vector<double> each;
    for (int robot = 0; robot < problem_.robots(); ++robot) each.push_back(arrivals(robot));
    return each;
  }
  double makespan() const {
    double latest = 0.0;
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      if (!empty(robot)) latest = std::max(latest, done(robot));
    }
    return latest;
  }

 private:
  int absent_task(int task) const {
    if (task < 0 || task >= problem_.tasks() || present(task)) throw std::invalid_argument("the task is in a route");
    return task;
  }
  int present_task(int task) const {
    if (task < 0 || task >= problem_.tasks() || !present(task)) throw std::invalid_argument("the task is in no route");
    return task;
  }
  // The place behind which a task becomes number `at` of the route.
  int after(int robot, int at) const {
    if (robot < 0 || robot >= problem_.robots()) throw std::out_of_range("no such robot");
    if (at < 0 || at > size(robot)) throw std::out_of_range("no such place");
    return at ? task_at(robot, at - 1) : problem_.start(robot);
  }
  // How many places of the route come before this.
  int rank(int robot, int place) const {
    int rank = 0;
    for (int each = problem_.start(robot); each != place; each = next(each)) ++rank;
    return rank;
  }

  const Problem& problem_;
};

}  // namespace

void bind_team(nb::module_& m) {
  nb::class_<CheckedTeam>(m, "Team", "Routes while a search changes them, with undo. One thread at a time may use one.")
      .def(nb::init<const Problem&, const Routes&>(), "problem"_a, "routes"_a, nb::keep_alive<1, 2>())
      .def("insert", &CheckedTeam::put, "task"_a, "robot"_a, "at"_a)
      .def("remove", &CheckedTeam::take, "task"_a)
      .def("growth", &CheckedTeam::growth_at, "robot"_a, "task"_a, "at"_a, "Of the route's usage by a task.")
      .def("later_arrivals", &CheckedTeam::arrivals_at, "robot"_a, "task"_a, "at"_a,
           "What a task adds to the sum of usages on arrival.")
      .def("longer", &CheckedTeam::longer_at, "robot"_a, "task"_a, "at"_a,
           "Seconds by which the route's last task ends later if nothing waits.")
      .def("reverse", &CheckedTeam::turn_round, "first"_a, "last"_a,
           "Turn the part of a route from one task to another round; ways must be as long back as forth.")
      .def("move", &CheckedTeam::put_elsewhere, "first"_a, "last"_a, "robot"_a, "at"_a,
           "Put the part of a route from one task to another at a place of the robot's route as it is now.")
      .def("bounds", &CheckedTeam::bounds, "task"_a,
           "For each robot the first and last place where the task deadlocks nothing, all its prerequisites present.")
      .def("commit", &CheckedTeam::commit, "Keep all changes.")
      .def("rollback", &CheckedTeam::rollback, "Undo all changes since the last commit.")
      .def("makespan", &CheckedTeam::makespan, "Seconds after which the last task ends if nothing waits.")
      .def_prop_ro("usages", &CheckedTeam::usages)
      .def_prop_ro("arrivals", &CheckedTeam::all_arrivals, "Of each route the sum of usages on arrival.")
      .def_prop_ro("absent", &CheckedTeam::absent)
      .def_prop_ro("routes", &CheckedTeam::routes);
}

}  // namespace muster
