// The velocity nearest to a wanted one within a ball and within half-spaces: the low-dimensional linear program of
// [berg2011], section 5, in two and three dimensions. Half-spaces are added one by one ([seidel1991]; [deberg2008],
// chapter 4): where a new one is violated, the optimum lies on its boundary, which is the same program with one
// dimension less.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "vectors.hpp"

namespace muster {

// All x with normal . x >= offset; the normal has length 1.
template <int D>
struct HalfSpace {
  Vec<D> normal;
  double offset;

  double violation(const Vec<D>& x) const { return offset - dot(normal, x); }
};

// What is wanted: to be near to a point, or to go far in a direction.
template <int D>
struct Aim {
  Vec<D> vector;
  bool direction;
};

constexpr double kSlack = 1e-12;     // of rounding: how far a point may lie outside a half-space that holds it
constexpr double kParallel = 1e-10;  // the sine of the angle under which two boundaries count as parallel

template <int D>
class Program {
 public:
  // How many of the half-spaces, from the first on, hold x, which is then the best point of these: all, or those before
  // the first that leaves no point.
  std::size_t solve(std::span<const HalfSpace<D>> spaces, double radius, const Aim<D>& aim, Vec<D>& x) {
    x = best_in_ball(radius, aim);
    for (std::size_t i = 0; i < spaces.size(); ++i)
      if (spaces[i].violation(x) > kSlack && !on_boundary(spaces.first(i), spaces[i], radius, aim, x)) return i;
    return spaces.size();
  }

 private:
  static Vec<D> best_in_ball(double radius, const Aim<D>& aim) {
    const double length = norm(aim.vector);
    if (aim.direction) return length > 0.0 ? (radius / length) * aim.vector : Vec<D>{};
    return length > radius ? (radius / length) * aim.vector : aim.vector;
  }

  // The best point on the boundary of `last` that is in all the earlier half-spaces; false if there is none.
  bool on_boundary(std::span<const HalfSpace<D>> earlier, const HalfSpace<D>& last, double radius, const Aim<D>& aim,
                   Vec<D>& x) {
    const double squared = radius * radius - last.offset * last.offset;
    if (squared < 0.0) return false;
    const Vec<D> centre = last.offset * last.normal;
    const auto axes = perpendiculars(last.normal);
    below_.clear();
    for (const HalfSpace<D>& space : earlier) {
      HalfSpace<D - 1> cut{along(axes, space.normal), space.offset - dot(space.normal, centre)};
      const double sine = norm(cut.normal);
      if (sine < kParallel) {
        if (cut.offset > kSlack) return false;
        continue;
      }
      cut.normal = (1.0 / sine) * cut.normal;
      cut.offset /= sine;
      below_.push_back(cut);
    }
    Vec<D - 1> y;
    if (lower_.solve(below_, std::sqrt(squared), {along(axes, aim.vector), aim.direction}, y) < below_.size())
      return false;
    x = centre;
    for (int k = 0; k < D - 1; ++k) x = x + y[k] * axes[k];
    return true;
  }

  static Vec<D - 1> along(const std::array<Vec<D>, D - 1>& axes, const Vec<D>& a) {
    Vec<D - 1> result;
    for (int k = 0; k < D - 1; ++k) result[k] = dot(axes[k], a);
    return result;
  }

  std::vector<HalfSpace<D - 1>> below_;
  Program<D - 1> lower_;
};

// On a line half-spaces leave an interval.
template <>
class Program<1> {
 public:
  std::size_t solve(std::span<const HalfSpace<1>> spaces, double radius, const Aim<1>& aim, Vec<1>& x) {
    double low = -radius, high = radius;
    for (std::size_t i = 0; i < spaces.size(); ++i) {
      const double bound = spaces[i].normal[0] * spaces[i].offset;
      if (spaces[i].normal[0] > 0.0)
        low = std::max(low, bound);
      else
        high = std::min(high, bound);
      if (low > high) return i;
    }
    const double wanted = aim.vector[0];
    if (aim.direction)
      x[0] = wanted > 0.0 ? high : wanted < 0.0 ? low : std::clamp(0.0, low, high);
    else
      x[0] = std::clamp(wanted, low, high);
    return spaces.size();
  }
};

// Where no point is in all half-spaces: x that lies in the first `hard` ones and goes least deep outside the others
// (2011, on densely packed conditions). `held` half-spaces hold x when it begins.
template <int D>
void least_penetration(std::span<const HalfSpace<D>> spaces, std::size_t hard, std::size_t held, double radius,
                       Program<D>& program, Vec<D>& x) {
  double depth = 0.0;
  std::vector<HalfSpace<D>> deeper;
  for (std::size_t i = std::max(held, hard); i < spaces.size(); ++i) {
    if (spaces[i].violation(x) <= depth + kSlack) continue;
    // As little outside i as possible, where none of the others is left further than i.
    deeper.assign(spaces.begin(), spaces.begin() + static_cast<std::ptrdiff_t>(hard));
    for (std::size_t j = hard; j < i; ++j) {
      const Vec<D> difference = spaces[j].normal - spaces[i].normal;
      const double length = norm(difference);
      if (length > kParallel)
        deeper.push_back({(1.0 / length) * difference, (spaces[j].offset - spaces[i].offset) / length});
    }
    Vec<D> better;
    if (program.solve(deeper, radius, {spaces[i].normal, true}, better) == deeper.size()) x = better;
    depth = std::max(depth, spaces[i].violation(x));
  }
}

}  // namespace muster
