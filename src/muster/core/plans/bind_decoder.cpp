#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "bindings.hpp"
#include "plans/colony.hpp"
#include "plans/decoder.hpp"
#include "plans/routes.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muster {

namespace {

using IndexTable = nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using TrailArray = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Figures = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

constexpr std::size_t kFigures = 4;

Figures figures(std::vector<double> values) {
  auto* kept = new std::vector<double>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return Figures(kept->data(), {kept->size() / kFigures, kFigures}, owner);
}

// The plans of one generation, with their figures.
class Generation {
 public:
  explicit Generation(const Problem& problem) : problem_(problem), evaluator_(problem) {}

  void resize(std::size_t size) { plans_.resize(size, Draft(problem_)); }
  Draft& operator[](std::size_t k) { return plans_[k]; }

  // Weight, objective, total and greatest usage of each plan. One that is not admissible, where a way through other
  // tasks is shorter than the direct one, counts as empty.
  std::vector<double> evaluate() {
    std::vector<double> values;
    for (Draft& plan : plans_) {
      if (!evaluator_.evaluate(plan)) {
        plan.clear();
        evaluator_.evaluate(plan);
      }
      double total = 0.0, most = 0.0;
      for (int robot = 0; robot < problem_.robots(); ++robot) {
        total += plan.figures(robot).usage;
        most = std::max(most, plan.figures(robot).usage);
      }
      values.insert(values.end(), {plan.value().weight, plan.value().objective, total, most});
    }
    return values;
  }

  Routes routes(int k) const {
    if (k < 0 || k >= static_cast<int>(plans_.size())) throw std::out_of_range("no such plan");
    return routes_of(problem_, plans_[k]);
  }

 private:
  const Problem& problem_;
  Evaluator evaluator_;
  std::vector<Draft> plans_;
};

// A decoder of whole generations, with indices checked where Python passes them.
class Decoding {
 public:
  explicit Decoding(const Problem& problem)
      : problem_(problem), decoder_(problem), generation_(problem), seen_(problem.tasks()) {}

  Figures in_order(const IndexTable& tasks, const IndexTable& robots) {
    const std::size_t size = checked_robots(robots);
    if (tasks.shape(0) != size || tasks.shape(1) != robots.shape(1)) throw std::invalid_argument("a robot a task");
    generation_.resize(size);
    for (std::size_t k = 0; k < size; ++k) check_permutation(row(tasks, k));
    for (std::size_t k = 0; k < size; ++k) decoder_.in_order(row(tasks, k), row(robots, k), generation_[k]);
    return figures(generation_.evaluate());
  }

  Figures nearest_next(const IndexTable& robots) {
    const std::size_t size = checked_robots(robots);
    generation_.resize(size);
    for (std::size_t k = 0; k < size; ++k) decoder_.nearest_next(row(robots, k), generation_[k]);
    return figures(generation_.evaluate());
  }

  Routes routes(int k) const { return generation_.routes(k); }

 private:
  std::span<const int> row(const IndexTable& array, std::size_t k) const {
    return {array.data() + k * array.shape(1), array.shape(1)};
  }

  std::size_t checked_robots(const IndexTable& robots) const {
    if (static_cast<int>(robots.shape(1)) != problem_.tasks()) throw std::invalid_argument("a robot for each task");
    const std::span<const int> all{robots.data(), robots.size()};
    if (std::ranges::any_of(all, [&](int robot) { return robot < 0 || robot >= problem_.robots(); })) {
      throw std::invalid_argument("no such robot");
    }
    return robots.shape(0);
  }

  void check_permutation(std::span<const int> tasks) {
    std::ranges::fill(seen_, 0);
    for (const int task : tasks) {
      if (task < 0 || task >= problem_.tasks() || seen_[task]++) throw std::invalid_argument("each task once");
    }
  }

  const Problem& problem_;
  Decoder decoder_;
  Generation generation_;
  std::vector<char> seen_;
};

// A colony that builds generations of plans.
class Building {
 public:
  Building(const Problem& problem, double beta, std::uint64_t seed)
      : problem_(problem), colony_(problem, beta, seed), generation_(problem) {}

  Figures build(const TrailArray& trail, int plans) {
    const auto n = static_cast<std::size_t>(problem_.tasks()), m = static_cast<std::size_t>(problem_.robots());
    if (trail.shape(0) != n + m || trail.shape(1) != n) throw std::invalid_argument("a trail from each place");
    if (plans < 0) throw std::invalid_argument("at least 0 plans");
    generation_.resize(plans);
    for (int k = 0; k < plans; ++k) colony_.build({trail.data(), trail.size()}, generation_[k]);
    return figures(generation_.evaluate());
  }

  Routes routes(int k) const { return generation_.routes(k); }

 private:
  const Problem& problem_;
  Colony colony_;
  Generation generation_;
};

}  // namespace

void bind_decoder(nb::module_& m) {
  nb::class_<Decoding>(m, "Decoder",
                       "Admissible plans from orders of tasks and the robots that tasks are meant for. One thread at a "
                       "time may use one.")
      .def(nb::init<const Problem&>(), "problem"_a, nb::keep_alive<1, 2>())
      .def("in_order", &Decoding::in_order, "tasks"_a, "robots"_a,
           "Plans from `tasks`, (k, n) in the order in which they are put at the ends of routes, and `robots`, (k, n) "
           "by "
           "task. Returns (k, 4): weight, objective, total and greatest usage. Raises ValueError if an index is wrong.")
      .def("nearest_next", &Decoding::nearest_next, "robots"_a,
           "The same where each robot goes on to the nearest of its tasks.")
      .def("routes", &Decoding::routes, "plan"_a, "Of the last call.");
  nb::class_<Building>(m, "Colony",
                       "Ants that build plans by pheromone and distance. One thread at a time may use one.")
      .def(nb::init<const Problem&, double, std::uint64_t>(), "problem"_a, "beta"_a, "seed"_a, nb::keep_alive<1, 2>())
      .def("build", &Building::build, "trail"_a, "plans"_a,
           "So many plans by (2.24); `trail` is tau^alpha, (n + m, n), from each task and each robot's start to each "
           "task. Returns (k, 4): weight, objective, total and greatest usage.")
      .def("routes", &Building::routes, "plan"_a, "Of the last call.");
}

}  // namespace muster
