#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <utility>

#include "bindings.hpp"
#include "team.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

// A team with bounds checked where Python passes indices.
class CheckedTeam : public Team {
 public:
  CheckedTeam(const Problem& problem, const Routes& routes)
      : Team(problem, (static_cast<void>(draft_from(problem, routes)), routes)), problem_(problem) {}

  void put(int task, int robot, int at) {
    check(robot, absent_task(task), at);
    insert(task, robot, at);
  }
  void take(int task) {
    if (task < 0 || task >= problem_.tasks() || !present(task)) throw std::invalid_argument("the task is in no route");
    remove(task);
  }
  double growth_at(int robot, int task, int at) const {
    check(robot, absent_task(task), at);
    return growth(robot, task, at);
  }
  double arrivals_at(int robot, int task, int at) const {
    return later_arrivals(robot, task, at, growth_at(robot, task, at));
  }
  double longer_at(int robot, int task, int at) const {
    check(robot, absent_task(task), at);
    return longer(robot, task, at);
  }
  double end_through_at(int robot, int task, int at) {
    check(robot, absent_task(task), at);
    makespan();
    measure_tails();
    return end_through(robot, task, at);
  }
  std::vector<int> critical_tasks() {
    makespan();
    return critical();
  }
  std::vector<std::pair<int, int>> bounds(int task) {
    bound(absent_task(task));
    std::vector<std::pair<int, int>> places;
    for (int robot = 0; robot < problem_.robots(); ++robot) places.emplace_back(earliest(robot), latest(robot));
    return places;
  }
  std::vector<double> usages() const {
    std::vector<double> usages;
    for (int robot = 0; robot < problem_.robots(); ++robot) usages.push_back(cost(robot).usage);
    return usages;
  }
  std::vector<double> arrivals() const {
    std::vector<double> arrivals;
    for (int robot = 0; robot < problem_.robots(); ++robot) arrivals.push_back(cost(robot).arrivals);
    return arrivals;
  }

 private:
  int absent_task(int task) const {
    if (task < 0 || task >= problem_.tasks() || present(task)) throw std::invalid_argument("the task is in a route");
    return task;
  }
  void check(int robot, int, int at) const {
    if (robot < 0 || robot >= problem_.robots()) throw std::out_of_range("no such robot");
    if (at < 0 || at > static_cast<int>(route(robot).size())) throw std::out_of_range("no such place");
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
      .def("end_through", &CheckedTeam::end_through_at, "robot"_a, "task"_a, "at"_a,
           "Seconds after which the mission ends, as far as it waits for the task, put at a place.")
      .def("critical", &CheckedTeam::critical_tasks,
           "The tasks that the end of the mission waits for one after the other, the last first.")
      .def("bounds", &CheckedTeam::bounds, "task"_a,
           "For each robot the first and last place where the task deadlocks nothing, all its prerequisites present.")
      .def("commit", &CheckedTeam::commit, "Keep all changes.")
      .def("rollback", &CheckedTeam::rollback, "Undo all changes since the last commit.")
      .def("makespan", &CheckedTeam::makespan, "Seconds, waiting included.")
      .def_prop_ro("usages", &CheckedTeam::usages)
      .def_prop_ro("arrivals", &CheckedTeam::arrivals, "Of each route the sum of usages on arrival.")
      .def_prop_ro("absent", &CheckedTeam::absent)
      .def_prop_ro("routes", &CheckedTeam::routes);
}

}  // namespace muster
