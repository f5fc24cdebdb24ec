#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "paths/air_ways.hpp"
#include "paths/tree.hpp"
#include "paths/ways.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Triple = std::array<double, 3>;

Point flat(Spot p) { return {p.x, p.y}; }

Room room_of(const Ways& ways) {
  return {.dimensions = 2,
          .low = {},
          .high = {},
          .free = [&ways](Spot p) { return ways.free(flat(p)); },
          .sees = [&ways](Spot a, Spot b) { return ways.sees(flat(a), flat(b)); }};
}

Room room_of(const AirWays& ways) {
  return {.dimensions = 3,
          .low = {},
          .high = {},
          .free = [&ways](Spot p) { return ways.air().free(p); },
          .sees = [&ways](Spot a, Spot b) { return ways.air().sees(a, b); }};
}

template <class Where>
void make(Tree* self, const Where& where, const Triple& low, const Triple& high, const Triple& start,
          const Triple& goal, std::uint64_t seed, double step, double goal_share, double reach) {
  if (!(step > 0.0)) throw std::invalid_argument("the step must be above 0");
  Room room = room_of(where);
  room.low = spot(low);
  room.high = spot(high);
  new (self) Tree(std::move(room), spot(start), spot(goal), seed, {step, goal_share, reach});
}

}  // namespace

void bind_tree(nb::module_& m) {
  nb::class_<Tree>(m, "Tree", "RRT*: a tree of random points that keeps shortening itself; start and goal are free.")
      .def("__init__", &make<Ways>, "where"_a, nb::kw_only(), "low"_a, "high"_a, "start"_a, "goal"_a, "seed"_a,
           "step"_a, "goal_share"_a, "reach"_a, nb::keep_alive<1, 2>())
      .def("__init__", &make<AirWays>, "where"_a, nb::kw_only(), "low"_a, "high"_a, "start"_a, "goal"_a, "seed"_a,
           "step"_a, "goal_share"_a, "reach"_a, nb::keep_alive<1, 2>())
      .def("grow", &Tree::grow, "samples"_a, nb::call_guard<nb::gil_scoped_release>())
      .def(
          "way", [](const Tree& tree) { return table_of(tree.way()); },
          "The shortest way found so far with its ends, (k, 3); empty if there is none.");
}

}  // namespace muster
