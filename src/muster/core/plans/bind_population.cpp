#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "bindings.hpp"
#include "plans/population.hpp"
#include "plans/routes.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using Unlocked = nb::call_guard<nb::gil_scoped_release>;

// A population with the problem it belongs to, and bounds checked where Python passes indices.
class Evolving : public Population {
 public:
  Evolving(const Problem& problem, int size, std::uint64_t seed, const std::string& bounds)
      : Population(problem, size, seed, bounds_named(bounds)), problem_(problem) {}

  void set_routes(int k, const Routes& routes) {
    if (!set(checked(k), draft_from(problem_, routes))) throw std::invalid_argument("the routes are not admissible");
  }
  void randomize(int k) { set_random(checked(k)); }
  void derive(int k, int of) { set_mutant(checked(k), checked(of)); }
  void replace(double share) { replace_worst(probability(share)); }
  void mutate_with(double p) { mutate(probability(p)); }
  void cross_with(double p) { cross(probability(p)); }
  Routes routes(int k) const { return routes_of(problem_, member(checked(k))); }
  double weight(int k) const { return member(checked(k)).value().weight; }
  double objective(int k) const { return member(checked(k)).value().objective; }

 private:
  int checked(int k) const {
    if (k < 0 || k >= size()) throw std::out_of_range("no such member");
    return k;
  }

  static double probability(double p) {
    if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument("a share or probability from 0 to 1");
    return p;
  }

  static Bounds bounds_named(const std::string& name) {
    for (const auto& [known, bounds] : kBounds) {
      if (name == known) return bounds;
    }
    throw std::invalid_argument("no bounds of that name");
  }

  static constexpr std::array<std::pair<std::string_view, Bounds>, 6> kBounds{{
      {"receiver", {Scope::kReceiver, false}},
      {"receiver-inner", {Scope::kReceiver, true}},
      {"all", {Scope::kAll, false}},
      {"all-inner", {Scope::kAll, true}},
      {"others", {Scope::kOthers, false}},
      {"others-inner", {Scope::kOthers, true}},
  }};

  const Problem& problem_;
};

}  // namespace

void bind_population(nb::module_& m) {
  nb::class_<Evolving>(m, "Population",
                       "Task allocations that evolve ([tcf-thesis], Algorithm 3). One thread at a time may use one.")
      .def(nb::init<const Problem&, int, std::uint64_t, const std::string&>(), "problem"_a, "size"_a, "seed"_a,
           "bounds"_a = "receiver", nb::keep_alive<1, 2>(),
           "`size` empty allocations. `bounds`: where mutation looks for a task's prerequisites and dependants.")
      .def("__len__", &Evolving::size)
      .def("set_random", &Evolving::randomize, "member"_a, Unlocked(), "A random admissible allocation.")
      .def("set", &Evolving::set_routes, "member"_a, "routes"_a, "Raises ValueError if the routes are not admissible.")
      .def("set_mutant", &Evolving::derive, "member"_a, "of"_a, Unlocked(), "A mutant of another member.")
      .def("replace_worst", &Evolving::replace, "share"_a, Unlocked(),
           "Step 4: random admissible allocations for the worst share of the members.")
      .def("mutate", &Evolving::mutate_with, "probability"_a, Unlocked(),
           "Step 5: task re-assignment (Algorithm 4); a mutant that is better stays.")
      .def("cross", &Evolving::cross_with, "probability"_a, Unlocked(),
           "Step 6: CM-PMX (Algorithm 5); the two best of parents and children stay.")
      .def("best", &Evolving::best, "Index of the best member.")
      .def("routes", &Evolving::routes, "member"_a)
      .def("weight", &Evolving::weight, "member"_a, "Weight of the tasks done.")
      .def("objective", &Evolving::objective, "member"_a);
}

}  // namespace muster
