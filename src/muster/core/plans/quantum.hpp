// The unit of what bids are compared by: robots whose processors round otherwise compare the same numbers.
#pragma once

#include <cmath>

namespace muster {

inline constexpr double kQuantum = 0x1p-20;  // of the objective's unit, metres or seconds

inline double in_quanta(double value) { return std::round(value / kQuantum) * kQuantum; }

}  // namespace muster
