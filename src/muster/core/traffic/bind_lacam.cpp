#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "traffic/directed_graph.hpp"
#include "traffic/joint_refinement.hpp"
#include "traffic/joint_steps.hpp"
#include "traffic/lacam.hpp"
#include "traffic/traffic_guidance.hpp"

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

using Steps = nb::ndarray<nb::numpy, std::int64_t>;

Steps array_of(const std::vector<Configuration>& steps) {
  const std::size_t robots = steps.empty() ? 0 : steps.front().size();
  auto* kept = new std::vector<std::int64_t>();
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<std::int64_t>*>(p); });
  for (const Configuration& step : steps) kept->insert(kept->end(), step.begin(), step.end());
  return Steps(kept->data(), {steps.size(), robots}, owner);
}

std::vector<Configuration> steps_of(const LacamSearch& search) {
  if (search.goal() < 0) throw std::invalid_argument("there is no solution yet");
  std::vector<Configuration> steps;
  for (const int k : search.way_to(search.goal())) steps.push_back(search.node(k).configuration);
  return steps;
}

std::vector<Configuration> configurations_of(const nb::ndarray<const std::int64_t, nb::ndim<2>, nb::c_contig>& steps) {
  std::vector<Configuration> found(steps.shape(0));
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::int64_t* row = steps.data() + k * steps.shape(1);
    found[k].assign(row, row + steps.shape(1));
  }
  return found;
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
  nb::class_<TrafficGuidance>(m, "TrafficGuidance",
                              "Ways of robots to their goals that avoid those who come the other way.")
      .def(nb::init<std::shared_ptr<const DirectedGraph>, std::vector<int>, std::vector<int>, std::uint64_t>(),
           "graph"_a, "starts"_a, "goals"_a, "seed"_a,
           "Raises ValueError where starts or goals are no vertices, or not of the same number.")
      .def("advance", &TrafficGuidance::advance, "steps"_a, Unlocked(), "Two steps a robot.")
      .def_prop_ro("finished", &TrafficGuidance::finished)
      .def_prop_ro("connected", &TrafficGuidance::connected, "Whether each robot alone comes to its goal, so far.")
      .def_prop_ro("least_sum", &TrafficGuidance::least_sum,
                   "The sum of the numbers of steps on the shortest ways of the robots; once finished.");
  nb::class_<LacamSearch>(m, "Lacam", "Search over configurations of robots that take a step on a graph at once.")
      .def(
          "__init__",
          [](LacamSearch* self, const TrafficGuidance& guidance, int samples, std::uint64_t seed, bool anytime) {
            new (self) LacamSearch({guidance, samples, seed}, seed, anytime);
          },
          "guidance"_a, nb::kw_only(), "samples"_a = 1, "seed"_a = 0, "anytime"_a = false,
          "Raises ValueError where the guidance is not finished, or a robot alone has no way.")
      .def("advance", &LacamSearch::advance, "expansions"_a, Unlocked())
      .def_prop_ro(
          "state", [](const LacamSearch& s) { return name_of(s.state()); },
          "searching, solved, optimal (solved, and nothing is better), or unsolvable: the space is exhausted.")
      .def_prop_ro("nodes", &LacamSearch::size, "The number of configurations that it knows.")
      .def_prop_ro("cost", &LacamSearch::cost,
                   "Steps in which robots do not rest at their goals, of the best solution.")
      .def(
          "solution", [](const LacamSearch& s) { return array_of(steps_of(s)); },
          "The vertex of each robot, (steps + 1, robots). Raises ValueError before it is solved.");
  nb::class_<JointRefinement>(m, "JointRefinement", "Large neighbourhood search over the paths of robots.")
      .def(
          "__init__",
          [](JointRefinement* self, const TrafficGuidance& guidance,
             const nb::ndarray<const std::int64_t, nb::ndim<2>, nb::c_contig>& steps,
             std::uint64_t seed) { new (self) JointRefinement(guidance.distances(), configurations_of(steps), seed); },
          "guidance"_a, "steps"_a, "seed"_a, "Raises ValueError where `steps` are no paths to the goals.")
      .def("advance", &JointRefinement::advance, "neighbourhoods"_a, Unlocked())
      .def_prop_ro("cost", &JointRefinement::cost, "Steps until each robot rests at its goal for good, summed up.")
      .def(
          "solution", [](const JointRefinement& r) { return array_of(r.solution()); },
          "The vertex of each robot, (steps + 1, robots).");
}

}  // namespace muster
