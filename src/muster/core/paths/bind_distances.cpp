#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "bindings.hpp"
#include "paths/distances.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

void bind_distances(nb::module_& m) {
  using Blocked = nb::ndarray<const bool, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  using Squared = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  m.def(
      "squared_distances",
      [](Blocked blocked, double trim, Squared squared) {
        if (!(trim >= 0.0 && trim <= 1.0)) throw nb::value_error("trim: expected a number from 0 to 1");
        if (squared.shape(0) != blocked.shape(0) || squared.shape(1) != blocked.shape(1)) {
          throw nb::value_error("squared: expected the shape of blocked");
        }
        const nb::gil_scoped_release release;
        squared_distances(blocked.data(), blocked.shape(0), blocked.shape(1), trim, squared.data());
      },
      "blocked"_a, "trim"_a, "squared"_a,
      "Write for each cell (rows, columns) the squared distance, in cells, to the nearest blocked cell: between "
      "centres "
      "with trim 0, from centre to square with 1/2, between squares with 1; inf where no cell is blocked.");
}

}  // namespace muster
