#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "bindings.hpp"
#include "plans/spanning_tree.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

void bind_spanning_tree(nb::module_& m) {
  using Costs = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  using Legs = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  using Joined = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  using Parents = nb::ndarray<std::int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  m.def(
      "spanning_tree",
      [](Legs legs, Costs root, Costs p, Joined joined, Parents parent) {
        const auto n = legs.shape(0);
        if (legs.shape(1) != n) throw nb::value_error("legs: expected as many columns as rows");
        for (const auto size : {root.shape(0), p.shape(0), joined.shape(0), parent.shape(0)}) {
          if (size != n) throw nb::value_error("root, p, joined, parent: expected one entry for each row of legs");
        }
        const nb::gil_scoped_release release;
        spanning_tree(legs.data(), root.data(), p.data(), n, joined.data(), parent.data());
      },
      "legs"_a, "root"_a, "p"_a, "joined"_a, "parent"_a,
      "Write for each of n tasks what the edge to its parent costs in the least spanning tree of a root and all tasks, "
      "and the parent, -1: the root. Edges cost legs (n, n), symmetric, and p (n,) of both ends; those of the root "
      "cost "
      "root (n,).");
}

}  // namespace muster
