// Points and vectors of the plane and of space.
#pragma once

#include <array>
#include <cmath>

namespace muster {

template <int D>
struct Vec {
  std::array<double, D> at{};

  double& operator[](int k) { return at[k]; }
  double operator[](int k) const { return at[k]; }
  bool operator==(const Vec&) const = default;
};

template <int D>
Vec<D> operator+(Vec<D> a, const Vec<D>& b) {
  for (int k = 0; k < D; ++k) a[k] += b[k];
  return a;
}

template <int D>
Vec<D> operator-(Vec<D> a, const Vec<D>& b) {
  for (int k = 0; k < D; ++k) a[k] -= b[k];
  return a;
}

template <int D>
Vec<D> operator*(double s, Vec<D> a) {
  for (int k = 0; k < D; ++k) a[k] *= s;
  return a;
}

template <int D>
double dot(const Vec<D>& a, const Vec<D>& b) {
  double sum = 0.0;
  for (int k = 0; k < D; ++k) sum += a[k] * b[k];
  return sum;
}

template <int D>
double norm(const Vec<D>& a) {
  return std::sqrt(dot(a, a));
}

// Anticlockwise by a right angle.
inline Vec<2> turned(const Vec<2>& a) { return {{-a[1], a[0]}}; }

inline double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

inline Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

// The D - 1 unit vectors that are at right angles to a unit vector and to each other. The first of -n is the opposite
// of the first of n, so that two robots which look at each other turn to opposite sides.

template <int D>
std::array<Vec<D>, D - 1> perpendiculars(const Vec<D>& n) {
  if constexpr (D == 2) {
    return {turned(n)};
  } else {
    int least = 0;
    for (int k = 1; k < D; ++k)
      if (std::abs(n[k]) < std::abs(n[least])) least = k;
    Vec<D> axis;
    axis[least] = 1.0;
    const Vec<D> first = cross(n, axis);
    const Vec<D> unit = (1.0 / norm(first)) * first;
    return {unit, cross(n, unit)};
  }
}

}  // namespace muster
