#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "traffic/lifelong_errands.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Blocked = nb::ndarray<const bool, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

int vertex_of(const TurningGrid& grid, int cells, int cell) {
  const int vertex = cell < 0 || cell >= cells ? TurningGrid::kNone : grid.vertex(cell);
  if (vertex == TurningGrid::kNone) throw std::invalid_argument("cell " + std::to_string(cell) + ": not free");
  return vertex;
}

void make(LifelongErrands* self, const Blocked& blocked, std::vector<int> starts, std::vector<std::vector<int>> tasks,
          int revealed, std::int64_t checks, std::uint64_t seed) {
  const int rows = static_cast<int>(blocked.shape(0)), columns = static_cast<int>(blocked.shape(1));
  TurningGrid grid(rows, columns, std::vector<bool>(blocked.data(), blocked.data() + blocked.size()));
  for (int& cell : starts) cell = vertex_of(grid, rows * columns, cell);
  for (auto& task : tasks) {
    for (int& cell : task) cell = vertex_of(grid, rows * columns, cell);
  }
  LifelongLimits limits;
  limits.checks = checks;
  new (self) LifelongErrands(std::move(grid), starts, std::move(tasks), revealed, limits, seed);
}

template <class Get>
auto of_robots(const LifelongErrands& errands, Get get) {
  std::vector<std::decay_t<decltype(get(0))>> values;
  for (int robot = 0; robot < errands.robots(); ++robot) values.push_back(get(robot));
  return values;
}

}  // namespace

void bind_lifelong(nb::module_& m) {
  nb::class_<LifelongErrands>(m, "LifelongErrands",
                              "Robots with headings on a grid that carry out tasks without end, step by step.")
      .def("__init__", &make, "blocked"_a, "starts"_a, "tasks"_a, nb::kw_only(), "revealed"_a,
           "checks"_a = LifelongLimits().checks, "seed"_a = 0,
           "`blocked` is (rows, columns); a cell is row * columns + column. Robots head east at first. Raises "
           "ValueError where a cell is not free, a task has no cell, or two robots start in one cell.")
      .def("advance", &LifelongErrands::advance, nb::call_guard<nb::gil_scoped_release>(),
           "Assigns tasks, decides moves, and takes one step.")
      .def_prop_ro("step", &LifelongErrands::step)
      .def_prop_ro("finished", &LifelongErrands::finished, "The number of tasks that are finished.")
      .def_prop_ro("impossible", &LifelongErrands::impossible,
                   "The number of revealed tasks that no robot can finish: no way leads to all their cells.")
      .def_prop_ro(
          "actions", [](const LifelongErrands& e) { return of_robots(e, [&](int robot) { return e.actions(robot); }); },
          "Of each robot: a letter for each step; F forward, R clockwise, C counter-clockwise, W wait.")
      .def_prop_ro(
          "busy_steps",
          [](const LifelongErrands& e) { return of_robots(e, [&](int robot) { return e.busy_steps(robot); }); },
          "Of each robot: the number of steps in which it had a task.")
      .def_prop_ro(
          "events",
          [](const LifelongErrands& e) {
            std::vector<std::tuple<int, int, int, int>> found;
            for (const auto& [step, robot, task, visited] : e.events()) found.emplace_back(step, robot, task, visited);
            return found;
          },
          "(step, robot, task, number of its cells visited), whenever a robot visits a cell of its task.")
      .def_prop_ro(
          "assignments",
          [](const LifelongErrands& e) {
            std::vector<std::tuple<int, int, int>> found;
            for (const auto& [step, robot, task] : e.assignments()) found.emplace_back(step, robot, task);
            return found;
          },
          "(step, robot, task), whenever a robot gets another task; -1 for none.")
      .def_prop_ro(
          "revealed",
          [](const LifelongErrands& e) {
            std::vector<int> steps;
            for (const auto& task : e.tasks()) steps.push_back(task.revealed);
            return steps;
          },
          "Of each task that was revealed: the step.");
}

}  // namespace muster
