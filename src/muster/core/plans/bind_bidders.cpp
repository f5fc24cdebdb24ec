#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <string>
#include <utility>

#include "bindings.hpp"
#include "plans/bidders.hpp"
#include "plans/quantum.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Unlocked = nb::call_guard<nb::gil_scoped_release>;
using Offers = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

Figure figure_of(const std::string& name) {
  if (name == "growth") return Figure::growth;
  if (name == "arrivals") return Figure::arrivals;
  if (name == "end") return Figure::end;
  throw std::invalid_argument("no such figure: " + name);
}

Offers array_of(std::vector<double> values) {
  auto* kept = new std::vector<double>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return Offers(kept->data(), {kept->size()}, owner);
}

// Bidders with bounds checked where Python passes indices.
class Bidding : public Bidders {
 public:
  Bidding(const Problem& problem, bool insert, const std::string& figure)
      : Bidders(problem, insert, figure_of(figure)), problem_(problem) {}

  void announce_all(const std::vector<int>& tasks) {
    for (const int task : tasks) announce(checked_task(task));
  }
  Offers offers_of(int robot) { return array_of(offers(checked_robot(robot))); }
  Offers offers_on(int task) { return array_of(offers_for(checked_task(task))); }
  std::pair<std::vector<int>, Offers> lowest_of_all() {
    std::vector<int> tasks;
    std::vector<double> figures;
    for (int robot = 0; robot < problem_.robots(); ++robot) {
      tasks.push_back(lowest(robot).task);
      figures.push_back(lowest(robot).figure);
    }
    return {std::move(tasks), array_of(std::move(figures))};
  }
  void award_to(int robot, int task) { award(checked_robot(robot), checked_task(task)); }
  std::vector<int> take_back(int task) { return relinquish(checked_task(task)); }
  Offers usages() const {
    std::vector<double> usages;
    for (int robot = 0; robot < problem_.robots(); ++robot) usages.push_back(usage(robot));
    return array_of(std::move(usages));
  }
  std::vector<int> lengths() const {
    std::vector<int> lengths;
    for (int robot = 0; robot < problem_.robots(); ++robot) lengths.push_back(draft().length(robot));
    return lengths;
  }
  Routes routes() const { return routes_of(problem_, draft()); }

 private:
  int checked_robot(int robot) const {
    if (robot < 0 || robot >= problem_.robots()) throw std::out_of_range("no such robot");
    return robot;
  }
  int checked_task(int task) const {
    if (task < 0 || task >= problem_.tasks()) throw std::out_of_range("no such task");
    return task;
  }

  const Problem& problem_;
};

}  // namespace

void bind_bidders(nb::module_& m) {
  m.attr("QUANTUM") = kQuantum;
  nb::class_<Bidding>(m, "Bidders",
                      "The team while tasks are auctioned: routes so far, and what each robot could do with each open "
                      "task. One thread at a time may use one.")
      .def(nb::init<const Problem&, bool, const std::string&>(), "problem"_a, "insert"_a, "figure"_a,
           nb::keep_alive<1, 2>(),
           "`insert`: a task goes where it lengthens the route least, else to its end. `figure`, what offers are: "
           "`growth` of the route's usage; `arrivals`, what is added to the sum of usages on arrival; `end`, when the "
           "robot would be done with all its tasks, in seconds.")
      .def(
          "copy", [](const Bidding& bidding) { return Bidding(bidding); }, nb::keep_alive<0, 1>(),
          "The same team once more, in which awards can be tried.")
      .def("set_routes", &Bidding::set_routes, "routes"_a, Unlocked(),
           "Begin anew with these routes; nothing is announced. Raises ValueError if they are not admissible.")
      .def("announce", &Bidding::announce_all, "tasks"_a, Unlocked(),
           "Tasks are open as soon as their prerequisites are in routes.")
      .def_prop_ro("open", &Bidding::open)
      .def("offers", &Bidding::offers_of, "robot"_a,
           "(n,) the figure of each task for the robot; inf where the task is not open, or the robot may not do it or "
           "has no capacity for it.")
      .def("offers_for", &Bidding::offers_on, "task"_a, "(m,) the figure of the task for each robot.")
      .def("lowest", &Bidding::lowest_of_all,
           "For each robot the task with its lowest figure, the first if several have it, and (m,) that figure; -1 and "
           "inf for a robot without offers.")
      .def("award", &Bidding::award_to, "robot"_a, "task"_a, Unlocked(),
           "Put an open task into the robot's route. Raises ValueError if the robot has no offer for it.")
      .def("relinquish", &Bidding::take_back, "task"_a, Unlocked(),
           "Take a task out of its route, and all in routes that waits for it; returns them. None are taken if the "
           "routes would not be admissible without them.")
      .def_prop_ro("usages", &Bidding::usages, nb::rv_policy::move, "(m,) in the unit of usage.")
      .def_prop_ro("lengths", &Bidding::lengths, "The number of tasks in each route.")
      .def_prop_ro("routes", &Bidding::routes);
}

}  // namespace muster
