#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <utility>

#include "bindings.hpp"
#include "traffic/directed_graph.hpp"
#include "traffic/joint_refinement.hpp"
#include "traffic/joint_steps.hpp"
#include "traffic/lacam.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using LacamSearch = Lacam<JointSteps>;
using Unlocked = nb::call_guard<nb::gil_scoped_release>;

const char* name_of(SearchState state) {
  switch (state) {
    case SearchState::kSearching:
      return "searching";
    case SearchState::kSolved:
      return "solved";
    case SearchState::kOptimal:
      return "optimal";
    default:
      return "unsolvable";
  }
}

std::vector<Configuration> solution(const LacamSearch& search) {
  std::vector<Configuration> steps;
  for (const int k : search.way_to(search.goal())) steps.push_back(search.node(k).configuration);
  return steps;
}

}  // namespace

void bind_lacam(nb::module_& m) {
  nb::class_<DirectedGraph>(m, "DirectedGraph", "A directed graph in compressed rows.")
      .def(nb::init<std::vector<int>, std::vector<int>, std::vector<double>>(), "first"_a, "heads"_a, "costs"_a,
           "The edges of vertex u are those from first[u] to first[u + 1]. Raises ValueError if they are not, or if a "
           "cost is not above 0.")
      .def_prop_ro("size", &DirectedGraph::size)
      .def_prop_ro("edges", &DirectedGraph::edges)
      .def("costs_to", &DirectedGraph::costs_to, "goal"_a, Unlocked(),
           "What it costs to come to a vertex from each; infinite where there is no way.");
  nb::class_<LacamSearch>(m, "Lacam", "Search over configurations of robots that take a step on a graph at once.")
      .def(
          "__init__",
          [](LacamSearch* self, std::shared_ptr<const DirectedGraph> graph, Configuration starts,
             std::vector<int> goals, int samples, std::uint64_t seed, bool anytime) {
            new (self)
                LacamSearch({std::move(graph), std::move(starts), std::move(goals), samples, seed}, seed, anytime);
          },
          "graph"_a, "starts"_a, "goals"_a, nb::kw_only(), "samples"_a = 1, "seed"_a = 0, "anytime"_a = false,
          "Raises ValueError where starts or goals are no vertices, or not of the same number.")
      .def("advance", &LacamSearch::advance, "expansions"_a, Unlocked())
      .def_prop_ro(
          "connected", [](const LacamSearch& s) { return s.generator().connected(); },
          "Whether each robot alone comes to its goal.")
      .def_prop_ro(
          "state", [](const LacamSearch& s) { return name_of(s.state()); },
          "searching, solved, optimal (solved, and nothing is better), or unsolvable: the space is exhausted.")
      .def_prop_ro("nodes", &LacamSearch::size, "The number of configurations that it knows.")
      .def_prop_ro("cost", &LacamSearch::cost,
                   "Steps in which robots do not rest at their goals, of the best solution.")
      .def("solution", &solution, "The vertex of each robot, step by step. Only after it is solved.");
  nb::class_<JointRefinement>(m, "JointRefinement", "Large neighbourhood search over the paths of robots.")
      .def(nb::init<std::shared_ptr<const DirectedGraph>, const std::vector<Configuration>&, std::uint64_t>(),
           "graph"_a, "steps"_a, "seed"_a, "Raises ValueError where `steps` are no paths.")
      .def("advance", &JointRefinement::advance, "neighbourhoods"_a, Unlocked())
      .def_prop_ro("cost", &JointRefinement::cost, "Steps until each robot rests at its goal for good, summed up.")
      .def("solution", &JointRefinement::solution, "The vertex of each robot, step by step.");
}

}  // namespace muster
